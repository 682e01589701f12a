#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace ironbird::hil_bridge::transport {

/// First in, first out, with all its memory made at the beginning. Refuses what does not fit.
template <class T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : items_(capacity) {}

  bool push(const T& item) {
    if (size_ == items_.size()) return false;
    items_[(first_ + size_++) % items_.size()] = item;
    return true;
  }
  std::optional<T> pop() {
    if (size_ == 0) return std::nullopt;
    const std::size_t place = first_;
    first_ = (first_ + 1) % items_.size();
    --size_;
    return items_[place];
  }
  /// The oldest one; there has to be one.
  const T& front() const { return items_[first_]; }
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }

 private:
  std::vector<T> items_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace ironbird::hil_bridge::transport
