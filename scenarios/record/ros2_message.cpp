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

std::vector<RawMessage> split(std::string_view name, std::string_view text, Allowance& allowance) {
  constexpr std::size_t kField = sizeof(RawField) + sizeof(Ros2Field);
  constexpr std::size_t kMessage = sizeof(RawMessage) + sizeof(Ros2MessageType);
  const auto pay = [&](std::size_t bytes) {
    if (!allowance.take(bytes)) throw UserError("the schema comes to " + allowance.refusal());
  };
  std::vector<RawMessage> messages{{plain_name(name), {}}};
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    pay(kField);
    if (line.starts_with("====")) continue;
    if (line.starts_with("MSG:")) {
      pay(kMessage);
      messages.push_back({plain_name(trimmed(line.substr(4))), {}});
      continue;
    }
    RawField field;
    const bool ours = messages.back().name.starts_with("ironbird_msgs/");
    if (parse_line(line, ours, field)) messages.back().fields.push_back(std::move(field));
  }
  return messages;
}

/// Finds message types by name; of two definitions the first counts.
class TypeIndex {
 public:
  explicit TypeIndex(const std::vector<RawMessage>& messages) {
    for (std::size_t i = 0; i < messages.size(); ++i) index_.emplace(messages[i].name, i);
  }

  /// A type may be named in full, or without its package when it is in the package of the message using it.
  std::size_t find(const RawMessage& user, const std::string& type) const {
    const std::string package = user.name.substr(0, user.name.find('/') + 1);
    const std::string header = type == "Header" ? "std_msgs/Header" : type;
    for (const std::string& wanted : {type, package + type, header}) {
      if (const auto found = index_.find(wanted); found != index_.end()) return found->second;
    }
    throw UserError("type " + type + " of a field of " + user.name + " is not defined");
  }

 private:
  std::map<std::string_view, std::size_t> index_;
};

/// Least bytes of a number, time or text.
std::size_t built_in_size(Ros2Kind kind) {
  switch (kind) {
    case Ros2Kind::kInt16:
    case Ros2Kind::kUint16:
      return 2;
    case Ros2Kind::kInt32:
    case Ros2Kind::kUint32:
    case Ros2Kind::kFloat32:
    case Ros2Kind::kString:  // its length
      return 4;
    case Ros2Kind::kInt64:
    case Ros2Kind::kUint64:
    case Ros2Kind::kFloat64:
    case Ros2Kind::kTime:
      return 8;
    default:
      return 1;
  }
}

/// More bytes than any message has.
constexpr std::size_t kEndless = std::numeric_limits<std::size_t>::max() / 2;

/// Least bytes of a whole field.
std::size_t field_size(const Ros2Field& field) {
  if (field.is_sequence) return sizeof(std::uint32_t);
  if (!field.is_array || field.element_size == 0) return field.element_size;
  return field.length > kEndless / field.element_size ? kEndless : field.length * field.element_size;
}

/// Finds how much of each type there is on the wire at least, of inner types first. Refuses a type that
/// contains itself, which would have no end, and nesting that only a hostile schema has.
class Measurer {
 public:
  explicit Measurer(std::vector<Ros2MessageType>& types) : types_(types), height_(types.size(), kUnknown) {}

  /// @param outside  how many types this one lies in
  /// @return how many types lie in one another, this one included
  int measure(std::size_t at, int outside = 0) {
    Ros2MessageType& type = types_[at];
    if (height_[at] == kOpen) throw UserError("type " + type.name + " contains itself");
    refuse_depth(outside);
    if (height_[at] == kUnknown) {
      height_[at] = kOpen;
      int height = 1;
      for (Ros2Field& field : type.fields) {
        if (field.kind == Ros2Kind::kMessage)
          height = std::max(height, 1 + measure(field.message, outside + 1));
        field.element_size =
            field.kind == Ros2Kind::kMessage ? types_[field.message].least_size : built_in_size(field.kind);
        type.least_size = std::min(type.least_size + field_size(field), kEndless);
      }
      std::erase_if(type.fields, [](const Ros2Field& field) { return field_size(field) == 0; });
      height_[at] = height;
    }
    refuse_depth(outside + height_[at] - 1);
    return height_[at];
  }

 private:
  static constexpr int kUnknown = 0;
  static constexpr int kOpen = -1;

  static void refuse_depth(int outside) {
    constexpr int kDeepest = 64;
    if (outside >= kDeepest)
      throw UserError("types are nested more than " + std::to_string(kDeepest) + " deep");
  }

  std::vector<Ros2MessageType>& types_;
  std::vector<int> height_;
};

}  // namespace

std::vector<Ros2MessageType> parse_ros2_schema(std::string_view name, std::string_view text,
                                               Allowance& allowance) {
  const std::vector<RawMessage> raw = split(name, text, allowance);
  const TypeIndex index(raw);
  std::vector<Ros2MessageType> types;
  for (const RawMessage& message : raw) {
    Ros2MessageType& type = types.emplace_back();
    type.name = message.name;
    for (const RawField& raw_field : message.fields) {
      Ros2Field& field = type.fields.emplace_back(raw_field.field);
      const auto built_in = kBuiltIn.find(raw_field.type);
      field.kind = built_in == kBuiltIn.end() ? Ros2Kind::kMessage : built_in->second;
      if (field.kind == Ros2Kind::kMessage) field.message = index.find(message, raw_field.type);
    }
  }
  Measurer(types).measure(0);
  return types;
}

}  // namespace ironbird::scenarios
