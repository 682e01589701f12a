#include "scenarios/report/plot/mark_names.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace ironbird::scenarios::plot {

namespace {

constexpr double kLetter = 6.9;  // px
constexpr double kApart = 10.0;  // px: between two names of a row, at the least
constexpr std::size_t kMostRows = 4;

using Span = std::pair<double, double>;

class Rows {
 public:
  Rows(double left, double right) : left_(left), right_(right) {}

  std::optional<NamePlace> take(const MarkName& name) {
    for (std::size_t row = 0; row < kMostRows; ++row) {
      for (const bool before : {false, true}) {
        const double from = before ? name.x - name.width : name.x;
        if (!has_room(row, {from, from + name.width})) continue;
        taken_[row].emplace_back(from, from + name.width);
        return NamePlace{row, before};
      }
    }
    return std::nullopt;
  }

 private:
  bool has_room(std::size_t row, Span span) const {
    return span.first >= left_ && span.second <= right_ &&
           std::none_of(taken_[row].begin(), taken_[row].end(), [=](const Span& other) {
             return span.first < other.second + kApart && other.first < span.second + kApart;
           });
  }

  double left_;
  double right_;
  std::array<std::vector<Span>, kMostRows> taken_;
};

}  // namespace

double width_of(std::string_view name) {
  const auto letters = std::count_if(name.begin(), name.end(), [](char letter) {
    return (static_cast<unsigned char>(letter) & 0xC0) != 0x80;
  });
  return kLetter * static_cast<double>(letters);
}

MarkNames placed(const std::vector<MarkName>& names, double left, double right) {
  MarkNames out;
  out.places.resize(names.size());
  Rows rows(left, right);
  for (const bool first : {true, false}) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i].first != first || names[i].text.empty()) continue;
      out.places[i] = rows.take(names[i]);
      if (out.places[i]) out.rows = std::max(out.rows, out.places[i]->row + 1);
    }
  }
  return out;
}

}  // namespace ironbird::scenarios::plot
