#include "scenarios/bench/script.hpp"

#include <algorithm>

namespace ironbird::scenarios {

std::size_t Script::add(const std::string& after, Time delay, Role role) {
  Item item{after, delay, role, std::nullopt, false};
  if (after.empty()) item.due = delay;
  items_.push_back(item);
  find_earliest();
  return items_.size() - 1;
}

void Script::happened(std::string_view name, Time now) {
  for (Item& item : items_) {
    if (!item.due && item.after == name) item.due = now + item.delay;
  }
  find_earliest();
}

std::optional<std::size_t> Script::next_due(Time now) {
  if (now < earliest_) return std::nullopt;
  const bool ends = ends_by(now);
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const Item& item = items_[i];
    if (item.given_out || !item.due || *item.due > now) continue;
    if (ends && item.role == Role::kBeforeTheEnd) continue;
    if (!found || *item.due < *items_[*found].due) found = i;
  }
  if (found) items_[*found].given_out = true;
  find_earliest();
  return found;
}

bool Script::ends_by(Time now) const {
  return std::any_of(items_.begin(), items_.end(), [now](const Item& item) {
    return item.role == Role::kEnd && item.due && *item.due <= now;
  });
}

void Script::find_earliest() {
  earliest_ = Time::max();
  for (const Item& item : items_) {
    if (!item.given_out && item.due) earliest_ = std::min(earliest_, *item.due);
  }
}

std::vector<Script::Left> Script::left() const {
  std::vector<Left> left;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (!items_[i].given_out) left.push_back({i, items_[i].after, items_[i].due});
  }
  return left;
}

}  // namespace ironbird::scenarios
