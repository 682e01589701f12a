#include "scenarios/bench/text_watch.hpp"

#include <algorithm>

namespace ironbird::scenarios {

namespace {

constexpr std::chrono::seconds kQuiet{10};

bool belongs_to_a_number(char c) {
  return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
}

}  // namespace

bool TextWatch::is_news(std::string_view text, Time now) {
  Heard fresh;
  for (const char c : text) {
    if (!belongs_to_a_number(c) && fresh.length < fresh.words.size()) fresh.words[fresh.length++] = c;
  }
  fresh.last = now;
  const auto end = heard_.begin() + static_cast<std::ptrdiff_t>(count_);
  const auto same =
      std::find_if(heard_.begin(), end, [&](const Heard& old) { return old.view() == fresh.view(); });
  if (same != end) {
    const bool forgotten = now - same->last > kQuiet;
    same->last = now;
    return forgotten;
  }
  if (count_ < heard_.size()) {
    heard_[count_++] = fresh;
    return true;
  }
  *std::min_element(heard_.begin(), heard_.end(),
                    [](const Heard& a, const Heard& b) { return a.last < b.last; }) = fresh;
  return true;
}

}  // namespace ironbird::scenarios
