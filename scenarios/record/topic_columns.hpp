#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scenarios/record/ros2_message.hpp"

namespace ironbird::scenarios {

/// Turns CDR messages of one type into columns of numbers and texts, by the rules of LogTopic.
class TopicColumns {
 public:
  /// @param types      as parse_ros2_schema() gives them; they and the allowance must stay
  /// @param allowance  pays for the columns
  TopicColumns(const std::vector<Ros2MessageType>& types, Allowance& allowance);
  ~TopicColumns();
  TopicColumns(const TopicColumns&) = delete;
  TopicColumns& operator=(const TopicColumns&) = delete;

  /// Decodes one more message. @throws std::runtime_error when the bytes do not hold the type, or the
  /// allowance is used up
  void add(std::span<const std::uint8_t> message);

  /// Hands over the columns, filled up with NaN and empty texts where a message had nothing.
  void finish(std::vector<std::string>& fields,
              std::map<std::string, std::vector<double>, std::less<>>& numbers,
              std::map<std::string, std::vector<std::string>, std::less<>>& texts);

 private:
  struct Node;
  class Input;

  void prepare(Node& node, const Ros2Field& field);
  void prepare_element(Node& node, const Ros2Field& field);
  Node& add_child(Node& node, const std::string* name);
  Node* element(Node& node, const Ros2Field& field, std::size_t index);
  void read_field(Input& input, Node* node, const Ros2Field& field);
  void read_element(Input& input, Node* node, const Ros2Field& field);
  void skip(Input& input, const Ros2Field& field, std::size_t count);
  void pay(std::size_t bytes);
  template <class Output>
  void collect(Node& node, const std::string& path, Output& output);

  const std::vector<Ros2MessageType>& types_;
  Allowance& allowance_;
  std::unique_ptr<Node> root_;
  std::size_t count_ = 0;
  std::size_t row_size_ = 0;  ///< bytes of one message in all columns
};

}  // namespace ironbird::scenarios
