#include "scenarios/requirements/condition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "scenarios/requirements/quantity_text.hpp"

namespace ironbird::scenarios {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

double named_value(const std::string& word, const Signal& signal) {
  const SignalLeaf& leaf = signal.leaf();
  const bool is_truth = word == "true" || word == "false";
  if (leaf.names.empty() && is_truth)
    return word == "true" ? 1.0 : 0.0;  // of the wire, which knows only numbers
  if (leaf.names.empty()) return read_quantity(word, signal.unit(), signal.path());
  std::string known;
  for (std::size_t i = 0; i < leaf.names.size(); ++i) {
    if (leaf.names[i] == word) return leaf.numbers[i];
    known += (i == 0 ? "" : ", ") + leaf.names[i];
  }
  throw std::invalid_argument(word + " is not a value of " + signal.path() + "; there are " + known);
}

}  // namespace

Condition Condition::read(const std::string& text, const SignalTable& table) {
  constexpr std::array<std::pair<const char*, Comparison>, 6> kOperators{{{"==", Comparison::kEqual},
                                                                          {"!=", Comparison::kDifferent},
                                                                          {"<=", Comparison::kAtMost},
                                                                          {">=", Comparison::kAtLeast},
                                                                          {"<", Comparison::kBelow},
                                                                          {">", Comparison::kAbove}}};
  Condition condition;
  condition.text_ = trimmed(text);
  std::string left = condition.text_, right;
  bool compares = false;
  condition.comparison_ = Comparison::kDifferent;  // from 0, when there is nothing else to compare with
  for (const auto& [sign, comparison] : kOperators) {
    const std::size_t at = text.find(sign);
    if (at == std::string::npos) continue;
    left = trimmed(text.substr(0, at));
    right = trimmed(text.substr(at + std::string(sign).size()));
    condition.comparison_ = comparison;
    compares = true;
    break;
  }
  condition.signal_ = table.find(left);
  if (condition.signal_.size() != 1) {
    throw std::invalid_argument(left + " is a vector, name a component");
  }
  if (compares) condition.value_ = named_value(right, condition.signal_);
  condition.refuse_impossible();
  const bool is_equality =
      condition.comparison_ == Comparison::kEqual || condition.comparison_ == Comparison::kDifferent;
  condition.unit_ = is_equality ? "1" : condition.signal_.unit();
  return condition;
}

void Condition::refuse_impossible() const {
  const SignalLeaf& leaf = signal_.leaf();
  if (leaf.numbers.empty()) return;
  const auto [least, greatest] = std::minmax_element(leaf.numbers.begin(), leaf.numbers.end());
  const bool never = (comparison_ == Comparison::kAbove && value_ >= *greatest) ||
                     (comparison_ == Comparison::kBelow && value_ <= *least);
  if (!never) return;
  std::string order;
  for (const std::string& name : leaf.names) order += (order.empty() ? "" : " < ") + name;
  throw std::invalid_argument(text_ + " can never be so; the order is " + order);
}

double Condition::margin() const {
  // At equality the truth value has no width: a margin that is nothing but a sign.
  constexpr double kSign = std::numeric_limits<double>::min();
  const double above = signal_.value() - value_;
  switch (comparison_) {
    case Comparison::kEqual:
      return std::isnan(above) ? above : above == 0.0 ? 1.0 : -1.0;
    case Comparison::kDifferent:
      return std::isnan(above) ? above : above == 0.0 ? -1.0 : 1.0;
    case Comparison::kBelow:
      return above == 0.0 ? -kSign : -above;
    case Comparison::kAtMost:
      return above == 0.0 ? kSign : -above;
    case Comparison::kAbove:
      return above == 0.0 ? -kSign : above;
    case Comparison::kAtLeast:
      break;
  }
  return above == 0.0 ? kSign : above;
}

}  // namespace ironbird::scenarios
