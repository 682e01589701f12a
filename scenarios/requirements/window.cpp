#include "scenarios/requirements/window.hpp"

#include <cctype>
#include <stdexcept>

#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/quantity_text.hpp"

namespace ironbird::scenarios {

namespace {

/// Times are multiples of a period turned into seconds: ends are met to within this, s.
constexpr double kTimeRoundOff = 1e-9;

bool starts_number(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) != 0 || text[0] == '.' ||
                           text[0] == '-' || text[0] == '+');
}

}  // namespace

Moment Moment::read(const std::string& text, const std::string& what) {
  if (starts_number(text)) return {read_quantity(text, "s", what), ""};
  const std::size_t plus = text.find('+');
  if (plus == std::string::npos) return {0.0, text};
  std::string event = text.substr(0, plus);
  while (!event.empty() && event.back() == ' ') event.pop_back();
  return {read_quantity(text.substr(plus + 1), "s", what), event};
}

std::optional<double> Moment::when(const Timeline& timeline) const {
  if (event.empty()) return offset;
  const std::optional<double> happened = timeline.first(event);
  if (!happened) return std::nullopt;
  return *happened + offset;
}

Window::Window(const std::string& after, const std::string& until) {
  if (!after.empty()) after_ = Moment::read(after, "after");
  if (!until.empty()) until_ = Moment::read(until, "until");
  if (until_ && until_->event.empty() && after_.event.empty() && until_->offset < after_.offset) {
    throw std::invalid_argument("until = " + until + " is before after = " + after);
  }
}

bool Window::contains(double time, const Timeline& timeline) {
  const bool news = !resolved_once_ || timeline.events().size() != events_seen_;
  if (news) {
    resolved_once_ = true;
    events_seen_ = timeline.events().size();
    if (!from_) from_ = after_.when(timeline);
    if (until_ && !to_) to_ = until_->when(timeline);
  }
  if (!from_ || time < *from_ - kTimeRoundOff) return false;
  return !to_ || time <= *to_ + kTimeRoundOff;
}

std::string Window::why_empty(double end) const {
  if (!from_) return after_.event + " never happened";
  const std::string opened = "its window opened at " + with_unit(*from_, "s");
  if (*from_ > end) return "the run ended at " + with_unit(end, "s") + ", before " + opened;
  return to_ ? opened + ", after it had closed at " + with_unit(*to_, "s") : "nothing was observed";
}

std::string Window::why_open(double end) const {
  if (!until_) return "";
  if (!to_) return until_->event + " never happened";
  if (*to_ <= end + kTimeRoundOff) return "";
  return "the run ended at " + with_unit(end, "s") + ", before its window closed at " + with_unit(*to_, "s");
}

}  // namespace ironbird::scenarios
