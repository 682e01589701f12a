// The talk beside the flying, with somebody who says anything at any time: the connection asks, and changes
// nothing in the unit that it was not asked to change; it never talks more than a line can carry; what it
// believes fits together; and bench time of the unit's stamps never runs backwards.

#include <algorithm>
#include <array>

#include "ci/fuzzing/harness.hpp"
#include "hil_bridge/interlock/gate.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"
#include "hil_bridge/serial_fcu/connection.hpp"

namespace ironbird::fuzzing {

namespace {

using namespace hil_bridge;

/// What one advance may send: sign of life, version, time, eight requests, eight sets, one write.
constexpr int kMostAtOnce = 20;

/// Any message, with any bits in its fields.
rosflight::Message any_message(Choices& choices) {
  const rosflight::MessageInfo& info = rosflight::kDialect[choices.byte() % rosflight::kDialect.size()];
  std::array<std::uint8_t, rosflight::kGreatestFrame> frame{};
  const auto payload = choices.take(info.length);
  std::copy(payload.begin(), payload.end(), frame.begin() + rosflight::kFrameHeader);
  return rosflight::decode_frame(std::span(frame).first(rosflight::kFrameOverhead + info.length), info)
      .message;
}

/// A parameter as a unit of this firmware says it, so that downloads come to an end.
rosflight::ParamValue likely_value(Choices& choices) {
  const auto index = static_cast<std::uint16_t>(choices.below(rosflight::kParameterCount));
  return {.param_value = {choices.byte()},
          .param_count = rosflight::kParameterCount,
          .param_index = index,
          .param_id = rosflight::field_of<16>("P" + std::to_string(index)),
          .param_type = index % 2U == 0U ? kIntegerParameter : kRealParameter};
}

class Talk {
 public:
  Talk(Choices& choices, std::uint8_t options)
      : choices_(choices),
        config_{.system = options, .synchronise = (options & 1U) != 0, .download = (options & 2U) != 0},
        connection_(config_) {
    connection_.begin(now_);
  }

  void step() {
    switch (const std::uint8_t what = choices_.byte(); what % 16U) {
      case 0:
        begin();
        break;
      case 1:
        set();
        break;
      case 2:
        writes_wanted_ = true;
        connection_.parameters().write_to_flash();
        break;
      case 3:
        now_ += std::chrono::milliseconds(choices_.number<std::uint32_t>() >> (what / 16U));
        break;
      case 4:
        // All of a list: the rest of the talk happens with a unit that is known.
        if (lists_-- <= 0) break;
        for (int k = 0; k < rosflight::kParameterCount; ++k) connection_.take(listed(k), now_);
        break;
      case 5:
      case 6:
        connection_.take(likely_value(choices_), now_);
        break;
      case 7:
      case 8:
      case 9:
        now_ += std::chrono::milliseconds(1 + what / 16U);
        advance();
        break;
      case 10:
        answer_time();
        break;
      case 11:
        stamp();
        break;
      default:
        connection_.take(any_message(choices_), now_);
    }
    expect_sense();
  }

  void expect_listed() const {
    const auto listed = static_cast<int>(connection_.parameters().known().size());
    require(listed == connection_.parameters().progress().known, "what is known can be listed");
  }

 private:
  static rosflight::ParamValue listed(int index) {
    return {.param_value = {0},
            .param_count = rosflight::kParameterCount,
            .param_index = static_cast<std::uint16_t>(index),
            .param_id = rosflight::field_of<16>("P" + std::to_string(index)),
            .param_type = index % 2 == 0 ? kIntegerParameter : kRealParameter};
  }

  void begin() {
    connection_.begin(now_);
    sets_wanted_ = writes_wanted_ = false;
    stamped_.reset();
  }

  void set() {
    ParameterRecord wanted;
    wanted.name = "P" + std::to_string(choices_.below(rosflight::kParameterCount));
    wanted.type = choices_.flag() ? kIntegerParameter : kRealParameter;
    wanted.bits = choices_.number<std::uint32_t>();
    sets_wanted_ = connection_.parameters().set(wanted).empty() || sets_wanted_;
  }

  void advance() {
    int sent = 0;
    connection_.advance(now_, [&](const rosflight::Message& message) {
      ++sent;
      const Effect effect = effect_of(message);
      require(effect == Effect::kAsks || effect == Effect::kChanges, "a talk moves nothing");
      if (effect == Effect::kAsks) return;
      if (const auto* set = std::get_if<rosflight::ParamSet>(&message)) {
        require(sets_wanted_ && set->target_system == config_.system, "only what was wanted is set");
      } else {
        const auto* command = std::get_if<rosflight::RosflightCmd>(&message);
        require(command != nullptr && command->command == rosflight::kWriteParameters && writes_wanted_,
                "flash is written when that was wanted");
      }
    });
    require(sent <= kMostAtOnce, "no more is sent than a line can carry");
  }

  /// A reply to a time request of ours, with a clock near or far.
  void answer_time() {
    const auto far = choices_.number<std::uint64_t>();
    const auto late = choices_.number<std::uint16_t>();
    const Time asked = now_;
    now_ += std::chrono::microseconds(late);
    const auto tc1 = choices_.flag() ? static_cast<std::int64_t>(far)
                                     : asked.count() + static_cast<std::int64_t>(far % 10'000'000U);
    connection_.take(rosflight::Timesync{.tc1 = tc1, .ts1 = asked.count()}, now_);
  }

  /// Stamps of the unit never run backwards, unless it booted.
  void stamp() {
    const int boots = connection_.reboots();
    const bool valid = connection_.time_sync().valid || !config_.synchronise;
    if (!stamped_ || stamped_->boots != boots || stamped_->valid != valid)
      stamped_ = Stamped{boots, valid, unit_clock_, Time::min()};
    unit_clock_ += std::chrono::microseconds(choices_.number<std::uint16_t>());
    const Time bench = connection_.to_bench(unit_clock_, now_);
    require(bench >= stamped_->bench, "bench time of the unit's stamps never runs backwards");
    stamped_->bench = bench;
  }

  void expect_sense() const {
    const ParameterProgress& progress = connection_.parameters().progress();
    require(progress.known <= progress.count, "no more is known than there is");
    require(progress.complete == (progress.known > 0 && progress.known == progress.count),
            "all is known when all is known");
    const ConnectionState state = connection_.state();
    require((state == ConnectionState::kRefused) == !connection_.refusal().empty(), "a refusal says why");
    if (state == ConnectionState::kReady) {
      require(!connection_.version().empty(), "who is ready has said its version");
      require(progress.count == 0 || progress.count == rosflight::kParameterCount,
              "who is ready has our parameters");
    }
    require(!(connection_.armed(now_) && connection_.disarmed(now_)), "a unit is armed or disarmed");
  }

  struct Stamped {
    int boots;
    bool valid;
    Time unit;
    Time bench;
  };

  Choices& choices_;
  ConnectionConfig config_;
  Connection connection_;
  Time now_{};
  Time unit_clock_{};
  std::optional<Stamped> stamped_;
  int lists_ = 2;  // each takes as long as hundreds of other steps
  bool sets_wanted_ = false;
  bool writes_wanted_ = false;
};

}  // namespace

void check(std::span<const std::uint8_t> input) {
  Choices choices(input);
  const std::uint8_t options = choices.byte();
  Talk talk(choices, options);
  while (choices.any_left()) talk.step();
  talk.expect_listed();
}

}  // namespace ironbird::fuzzing
