#include "scenarios/fcu/unit_view.hpp"

namespace ironbird::scenarios {

void UnitView::take(const hil_bridge::Arrival& arrival) {
  const std::size_t place = arrival.message.index();
  latest_[place] = arrival;
  ++counts_[place];
  const auto* text = std::get_if<hil_bridge::rosflight::Statustext>(&arrival.message);
  if (text == nullptr) return;
  texts_.push_back({arrival.when, text->severity, std::string(hil_bridge::rosflight::text_of(text->text))});
  if (texts_.size() > kTexts) texts_.pop_front();
}

}  // namespace ironbird::scenarios
