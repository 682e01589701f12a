#include "scenarios/record/topic_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "scenarios/config/user_error.hpp"
#include "scenarios/record/byte_cursor.hpp"

namespace ironbird::scenarios {
namespace {

/// Elements of a sequence beyond this many become no columns: such a sequence is a picture, not a signal.
constexpr std::size_t kMostColumns = 4096;
constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

}  // namespace

/// A place in the message that holds numbers, texts, named members or numbered elements.
struct TopicColumns::Node {
  const std::string* name = nullptr;  ///< null for a numbered element
  std::size_t path_size = 0;          ///< letters of its column's name
  std::vector<double> numbers;
  std::vector<std::string> texts;
  bool is_text = false;
  bool is_leaf = false;
  bool is_numbered = false;
  std::vector<Node> children;
};

/// Reads aligned numbers of either byte order.
class TopicColumns::Input {
 public:
  explicit Input(std::span<const std::uint8_t> message) {
    if (message.size() < 4) throw UserError("is shorter than its header");
    const std::uint8_t encoding = message[1];
    if (message[0] != 0 || (encoding != 0 && encoding != 1 && encoding != 6 && encoding != 7)) {
      throw UserError("has an unknown encoding");
    }
    swapped_ = encoding == 0 || encoding == 6;
    most_alignment_ = encoding >= 6 ? 4 : 8;
    bytes_ = message.subspan(4);
  }

  template <class Number>
  Number get() {
    align(sizeof(Number));
    std::array<std::uint8_t, sizeof(Number)> raw;
    std::memcpy(raw.data(), take(sizeof(Number)).data(), sizeof(Number));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    Number value;
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }

  /// Leaves out numbers of so many bytes each.
  void skip(std::size_t count, std::size_t size) {
    align(size);
    take(count * size);
  }

  std::size_t left() const { return bytes_.size() - std::min(at_, bytes_.size()); }

  std::string text() {
    const auto bytes = take(get<std::uint32_t>());
    std::string value(bytes.begin(), bytes.end());
    if (!value.empty() && value.back() == '\0') value.pop_back();
    return value;
  }

  /// Time as seconds: the double next to the decimal, so that 30 ms are 0.03.
  double time() {
    const auto whole = get<std::int32_t>();
    const auto nanoseconds = get<std::uint32_t>();
    return static_cast<double>(std::int64_t{whole} * 1000000000 + std::int64_t{nanoseconds}) / 1e9;
  }

 private:
  void align(std::size_t size) {
    const std::size_t alignment = std::min(size, most_alignment_);
    at_ = (at_ + alignment - 1) / alignment * alignment;
  }

  std::span<const std::uint8_t> take(std::size_t count) {
    if (at_ > bytes_.size() || count > bytes_.size() - at_) throw UserError("ends too early");
    const auto taken = bytes_.subspan(at_, count);
    at_ += count;
    return taken;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::size_t most_alignment_ = 8;
  bool swapped_ = false;
};

namespace {

template <class Input>
double read_number(Input& input, Ros2Kind kind) {
  switch (kind) {
    case Ros2Kind::kBool:
      return input.template get<std::uint8_t>() != 0 ? 1.0 : 0.0;
    case Ros2Kind::kInt8:
      return input.template get<std::int8_t>();
    case Ros2Kind::kUint8:
      return input.template get<std::uint8_t>();
    case Ros2Kind::kInt16:
      return input.template get<std::int16_t>();
    case Ros2Kind::kUint16:
      return input.template get<std::uint16_t>();
    case Ros2Kind::kInt32:
      return input.template get<std::int32_t>();
    case Ros2Kind::kUint32:
      return input.template get<std::uint32_t>();
    case Ros2Kind::kInt64:
      return static_cast<double>(input.template get<std::int64_t>());
    case Ros2Kind::kUint64:
      return static_cast<double>(input.template get<std::uint64_t>());
    case Ros2Kind::kFloat32:
      return input.template get<float>();
    case Ros2Kind::kFloat64:
      return input.template get<double>();
    case Ros2Kind::kTime:
      return input.time();
    case Ros2Kind::kString:
    case Ros2Kind::kMessage:
      break;
  }
  return kAbsent;
}

}  // namespace

TopicColumns::TopicColumns(const std::vector<Ros2MessageType>& types, Allowance& allowance)
    : types_(types), allowance_(allowance), root_(std::make_unique<Node>()) {
  Ros2Field whole;
  whole.kind = Ros2Kind::kMessage;
  prepare_element(*root_, whole);
}

TopicColumns::~TopicColumns() = default;

void TopicColumns::pay(std::size_t bytes) {
  if (!allowance_.take(bytes)) throw UserError("the columns come to " + allowance_.refusal());
}

TopicColumns::Node& TopicColumns::add_child(Node& node, const std::string* name) {
  constexpr std::size_t kStep = 6;  // `[1234]`; a dot and a name
  const std::size_t path_size = node.path_size + (name == nullptr ? kStep : name->size() + 1);
  pay(sizeof(Node) + 2 * path_size);  // in the list of names and in the map
  Node& child = node.children.emplace_back();
  child.name = name;
  child.path_size = path_size;
  return child;
}

void TopicColumns::prepare(Node& node, const Ros2Field& field) {
  if ((!field.is_sequence && !field.is_array) || field.is_optional()) return prepare_element(node, field);
  node.is_numbered = true;
  if (!field.is_array) return;
  for (std::size_t i = 0; i < std::min(field.length, kMostColumns); ++i) element(node, field, i);
}

void TopicColumns::prepare_element(Node& node, const Ros2Field& field) {
  if (field.kind != Ros2Kind::kMessage) {
    node.is_leaf = true;
    node.is_text = field.kind == Ros2Kind::kString;
    const std::size_t cell = node.is_text ? sizeof(std::string) : sizeof(double);
    pay(count_ * cell);
    row_size_ += cell;
    return;
  }
  for (const Ros2Field& member : types_[field.message].fields) prepare(add_child(node, &member.name), member);
}

void TopicColumns::add(std::span<const std::uint8_t> message) {
  Input input(message);
  Ros2Field whole;
  whole.kind = Ros2Kind::kMessage;
  read_element(input, root_.get(), whole);
  pay(row_size_);
  ++count_;
}

/// The place of an element, made now if there was none.
TopicColumns::Node* TopicColumns::element(Node& node, const Ros2Field& field, std::size_t index) {
  if (index == node.children.size()) prepare_element(add_child(node, nullptr), field);
  return &node.children[index];
}

/// @param node  null: read and forget
void TopicColumns::read_field(Input& input, Node* node, const Ros2Field& field) {
  if (!field.is_sequence && !field.is_array) return read_element(input, node, field);
  const std::size_t length = field.is_array ? field.length : input.get<std::uint32_t>();
  if (field.is_optional()) {
    if (length > 1) throw UserError("has " + std::to_string(length) + " elements in " + field.name);
    if (length == 1) read_element(input, node, field);
    return;
  }
  if (field.element_size == 0) return;  // however many of nothing
  if (length > input.left() / field.element_size) throw UserError("ends too early");
  const std::size_t columns = node == nullptr ? 0 : std::min(length, kMostColumns);
  for (std::size_t i = 0; i < columns; ++i) read_element(input, element(*node, field, i), field);
  skip(input, field, length - columns);
}

void TopicColumns::skip(Input& input, const Ros2Field& field, std::size_t count) {
  if (count == 0) return;
  if (field.kind == Ros2Kind::kTime) return input.skip(2 * count, sizeof(std::int32_t));
  if (field.kind != Ros2Kind::kMessage && field.kind != Ros2Kind::kString)
    return input.skip(count, field.element_size);
  for (std::size_t i = 0; i < count; ++i) read_element(input, nullptr, field);
}

void TopicColumns::read_element(Input& input, Node* node, const Ros2Field& field) {
  if (field.kind == Ros2Kind::kMessage) {
    const std::vector<Ros2Field>& members = types_[field.message].fields;
    for (std::size_t i = 0; i < members.size(); ++i)
      read_field(input, node == nullptr ? nullptr : &node->children[i], members[i]);
  } else if (field.kind == Ros2Kind::kString) {
    std::string text = input.text();
    if (node == nullptr) return;
    node->texts.resize(count_);
    node->texts.push_back(std::move(text));
  } else {
    const double number = read_number(input, field.kind);
    if (node == nullptr) return;
    node->numbers.resize(count_, kAbsent);
    node->numbers.push_back(number);
  }
}

template <class Output>
void TopicColumns::collect(Node& node, const std::string& path, Output& output) {
  if (node.is_leaf) return output(node, path);
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    Node& child = node.children[i];
    const std::string step =
        node.is_numbered ? "[" + std::to_string(i) + "]" : (path.empty() ? "" : ".") + *child.name;
    collect(child, path + step, output);
  }
}

void TopicColumns::finish(std::vector<std::string>& fields,
                          std::map<std::string, std::vector<double>, std::less<>>& numbers,
                          std::map<std::string, std::vector<std::string>, std::less<>>& texts) {
  const auto output = [&](Node& leaf, const std::string& path) {
    if (leaf.is_text) {
      leaf.texts.resize(count_);
      texts[path] = std::move(leaf.texts);
      return;
    }
    leaf.numbers.resize(count_, kAbsent);
    fields.push_back(path);
    numbers[path] = std::move(leaf.numbers);
  };
  collect(*root_, "", output);
}

}  // namespace ironbird::scenarios
