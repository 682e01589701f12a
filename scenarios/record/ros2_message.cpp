#include "scenarios/record/ros2_message.hpp"

#include <algorithm>
#include <charconv>
#include <map>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {
namespace {

const std::map<std::string_view, Ros2Kind> kBuiltIn{{"bool", Ros2Kind::kBool},
                                                    {"byte", Ros2Kind::kUint8},
                                                    {"char", Ros2Kind::kUint8},
                                                    {"int8", Ros2Kind::kInt8},
                                                    {"uint8", Ros2Kind::kUint8},
                                                    {"int16", Ros2Kind::kInt16},
                                                    {"uint16", Ros2Kind::kUint16},
                                                    {"int32", Ros2Kind::kInt32},
                                                    {"uint32", Ros2Kind::kUint32},
                                                    {"int64", Ros2Kind::kInt64},
                                                    {"uint64", Ros2Kind::kUint64},
                                                    {"float32", Ros2Kind::kFloat32},
                                                    {"float64", Ros2Kind::kFloat64},
                                                    {"string", Ros2Kind::kString},
                                                    {"time", Ros2Kind::kTime},
                                                    {"duration", Ros2Kind::kTime},
                                                    {"builtin_interfaces/Time", Ros2Kind::kTime},
                                                    {"builtin_interfaces/Duration", Ros2Kind::kTime}};

constexpr std::string_view kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// `geometry_msgs/msg/Vector3` and `geometry_msgs/Vector3` are the same.
std::string plain_name(std::string_view name) {
  std::string result(name);
  const std::size_t middle = result.find("/msg/");
  if (middle != std::string::npos) result.erase(middle, 4);
  return result;
}

std::size_t parse_count(std::string_view text, std::string_view line) {
  std::size_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    throw UserError("no length in '" + std::string(line) + "'");
  }
  return value;
}

/// A field still waiting for its type to be found.
struct RawField {
  Ros2Field field;
  std::string type;
};

void parse_brackets(std::string_view brackets, std::string_view line, Ros2Field& field) {
  const std::string_view inside = brackets.substr(1, brackets.size() - 2);
  if (inside.empty()) {
    field.is_sequence = true;
  } else if (inside.starts_with("<=")) {
    field.is_sequence = true;
    field.bound = parse_count(inside.substr(2), line);
  } else {
    field.is_array = true;
    field.length = parse_count(inside, line);
  }
}

/// The name that a comment such as `p_NB_N: [m] position` gives back to the field `p_nb_n`, or the field's
/// own.
std::string original_name(std::string_view name, std::string_view comment) {
  const std::string_view first = comment.substr(0, comment.find(':'));
  const bool same =
      std::equal(name.begin(), name.end(), first.begin(), first.end(), [](char legal, char own) {
        return legal == (own >= 'A' && own <= 'Z' ? static_cast<char>(own - 'A' + 'a') : own);
      });
  return std::string(same ? first : name);
}

/// @return false for a line that is not a field
bool parse_line(std::string_view line, bool ours, RawField& out) {
  const std::size_t hash = line.find('#');
  const std::string_view comment = hash == std::string_view::npos ? "" : trimmed(line.substr(hash + 1));
  line = trimmed(line.substr(0, hash));
  const std::size_t type_end = line.find_first_of(kBlank);
  if (line.empty() || type_end == std::string_view::npos) {
    if (line.empty()) return false;
    throw UserError("no field name in '" + std::string(line) + "'");
  }
  std::string_view type = line.substr(0, type_end);
  const std::string_view rest = trimmed(line.substr(type_end));
  const std::string_view name = rest.substr(0, rest.find_first_of(" \t="));
  const std::string_view after = trimmed(rest.substr(name.size()));
  if (after.starts_with('=')) return false;
  out.field.name = ours ? original_name(name, comment) : std::string(name);
  if (type.ends_with(']')) {
    const std::size_t bracket = type.find('[');
    if (bracket == std::string_view::npos) throw UserError("no '[' in '" + std::string(line) + "'");
    parse_brackets(type.substr(bracket), line, out.field);
    type = type.substr(0, bracket);
  }
  out.type = plain_name(type.substr(0, type.find("<=")));
  return true;
}

struct RawMessage {
  std::string name;
  std::vector<RawField> fields;
};

std::vector<RawMessage> split(std::string_view name, std::string_view text) {
  std::vector<RawMessage> messages{{plain_name(name), {}}};
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (line.starts_with("====")) continue;
    if (line.starts_with("MSG:")) {
      messages.push_back({plain_name(trimmed(line.substr(4))), {}});
      continue;
    }
    RawField field;
    const bool ours = messages.back().name.starts_with("ironbird_msgs/");
    if (parse_line(line, ours, field)) messages.back().fields.push_back(std::move(field));
  }
  return messages;
}

/// A type may be named in full, or without its package when it is in the package of the message using it.
std::size_t find_type(const std::vector<RawMessage>& messages, const RawMessage& user,
                      const std::string& type) {
  const std::string package = user.name.substr(0, user.name.find('/') + 1);
  const std::string short_header = type == "Header" ? "std_msgs/Header" : "";
  for (const std::string& wanted : {type, package + type, short_header}) {
    for (std::size_t i = 0; i < messages.size(); ++i) {
      if (messages[i].name == wanted) return i;
    }
  }
  throw UserError("type " + type + " of a field of " + user.name + " is not defined");
}

/// Refuses a type that contains itself, which would have no end.
void refuse_cycle(const std::vector<Ros2MessageType>& types, std::size_t at, std::vector<char>& open) {
  if (open[at] == 1) throw UserError("type " + types[at].name + " contains itself");
  if (open[at] == 2) return;
  open[at] = 1;
  for (const Ros2Field& field : types[at].fields) {
    if (field.kind == Ros2Kind::kMessage) refuse_cycle(types, field.message, open);
  }
  open[at] = 2;
}

}  // namespace

std::vector<Ros2MessageType> parse_ros2_schema(std::string_view name, std::string_view text) {
  std::vector<RawMessage> raw = split(name, text);
  std::vector<Ros2MessageType> types;
  for (const RawMessage& message : raw) {
    Ros2MessageType& type = types.emplace_back();
    type.name = message.name;
    for (const RawField& raw_field : message.fields) {
      Ros2Field& field = type.fields.emplace_back(raw_field.field);
      const auto built_in = kBuiltIn.find(raw_field.type);
      field.kind = built_in == kBuiltIn.end() ? Ros2Kind::kMessage : built_in->second;
      if (field.kind == Ros2Kind::kMessage) field.message = find_type(raw, message, raw_field.type);
    }
  }
  std::vector<char> open(types.size(), 0);
  refuse_cycle(types, 0, open);
  return types;
}

}  // namespace ironbird::scenarios
