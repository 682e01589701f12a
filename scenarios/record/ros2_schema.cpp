#include "scenarios/record/ros2_schema.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace ironbird::scenarios {
namespace {

std::string shortest(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

/// ROS allows no capitals in the name of a field.
std::string legal_name(std::string_view name) {
  std::string legal(name);
  for (char& c : legal) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return legal;
}

}  // namespace

std::size_t Ros2SchemaBuilder::open(std::string_view name, std::string_view type) {
  for (const Definition& known : definitions_) {
    if (known.name != name) continue;
    if (known.type == type) return kKnown;
    throw std::invalid_argument("message type " + known.name + " would stand for both " + known.type +
                                " and " + std::string(type));
  }
  definitions_.push_back({std::string(name), std::string(type), "", {}});
  return definitions_.size() - 1;
}

std::string Ros2SchemaBuilder::define_standard(std::string_view name, std::string_view body) {
  const std::size_t definition = open(name, name);
  if (definition != kKnown) definitions_[definition].body = body;
  return std::string(name);
}

void Ros2SchemaBuilder::add_line(std::size_t definition, std::string_view type, std::string_view name,
                                 const std::string& comment) {
  Definition& message = definitions_[definition];
  const std::string legal = legal_name(name);
  if (std::find(message.fields.begin(), message.fields.end(), legal) != message.fields.end()) {
    throw std::invalid_argument("field " + std::string(name) + " of " + message.name +
                                " has the name of another one but for capitals");
  }
  message.fields.push_back(legal);
  message.body.append(type).append(" ").append(legal);
  const std::string original = legal == name ? "" : std::string(name) + (comment.empty() ? ":" : ": ");
  if (!original.empty() || !comment.empty()) message.body.append("  # ").append(original).append(comment);
  message.body += '\n';
}

void Ros2SchemaBuilder::add_constant(std::size_t definition, std::string_view prefix, std::string_view name,
                                     unsigned value) {
  if (value > 255) {
    throw std::invalid_argument("enumerator " + std::string(name) + " of field " + std::string(prefix) +
                                " = " + std::to_string(value) + ", must be <= 255");
  }
  definitions_[definition].body +=
      "uint8 " + constant_case(prefix) + "_" + constant_case(name) + "=" + std::to_string(value) + "\n";
}

std::string Ros2SchemaBuilder::comment(std::string_view unit, std::string_view meaning, double lower,
                                       double upper) {
  std::string text;
  if (!unit.empty()) text.append("[").append(unit).append("] ");
  text.append(meaning);
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (lower > -kUnbounded) text += ", >= " + shortest(lower);
  if (upper < kUnbounded) text += ", <= " + shortest(upper);
  return text;
}

Ros2Schema Ros2SchemaBuilder::finish() const {
  Ros2Schema schema;
  const std::string& name = definitions_.front().name;
  const std::size_t slash = name.find('/');
  schema.name = name.substr(0, slash) + "/msg" + name.substr(slash);
  schema.text = definitions_.front().body;
  for (std::size_t i = 1; i < definitions_.size(); ++i) {
    schema.text += std::string(80, '=') + "\nMSG: " + definitions_[i].name + "\n" + definitions_[i].body;
  }
  return schema;
}

}  // namespace ironbird::scenarios
