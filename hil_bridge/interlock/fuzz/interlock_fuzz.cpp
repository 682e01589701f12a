// Whatever the interlock sees and whatever is commanded, in any order and at any time: no motor command above
// zero leaves outside `Live`, and in `Live` none that is not sound. Who may turn a motor is judged by a
// witness of its own.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ci/fuzzing/harness.hpp"
#include "hil_bridge/interlock/interlock.hpp"
#include "hil_bridge/interlock/test/interlock_inputs.hpp"
#include "hil_bridge/rosflight/frame_codec.hpp"

namespace ironbird::fuzzing {

namespace {

using namespace hil_bridge;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr InterlockConfig config(InterlockProfile profile) {
  return {
      .profile = profile,
      .limits = {.thrust = 50.0, .torque = 2.0, .angle = 0.7, .rate = 3.0, .greatest_age = milliseconds(5)}};
}

/// Remembers what must have happened before a motor may turn.
class Witness {
 public:
  void see(const InterlockInputs& in) {
    const bool well = in.link_alive && in.unit_known && in.parameters_equal && in.sensors_flow &&
                      in.radio_present && in.commands_sound && in.bench_in_time && !in.kill_wanted;
    const bool armed = in.unit_armed && !in.unit_disarmed;
    const bool disarmed = in.unit_disarmed && !in.unit_armed;
    if (!well || (flew_ && in.unit_disarmed)) released_ = flew_ = false;
    if (well && disarmed && in.unit_faultless && in.estimate_usable && in.release_wanted) released_ = true;
    if (released_ && armed) flew_ = true;
    may_turn_ = well && released_ && armed;
  }
  bool may_turn() const { return may_turn_; }

 private:
  bool released_ = false;
  bool flew_ = false;
  bool may_turn_ = false;
};

/// Three of four times all is as it should be but for what the choice names: else the state machine would
/// never leave its beginning.
InterlockInputs any_inputs(Choices& choices) {
  const auto bits = choices.number<std::uint16_t>();
  InterlockInputs in = test::sound();
  const bool any = bits % 4U == 0U;
  if (!any) {
    in.unit_armed = (bits & 4U) != 0;
    in.unit_disarmed = !in.unit_armed;
    in.release_wanted = (bits & 8U) != 0;
    in.reset_wanted = (bits & 16U) != 0;
    return in;
  }
  for (std::size_t k = 0; k < test::kSwitches.size(); ++k)
    in.*test::kSwitches[k] = (bits >> (k + 2U) & 1U) != 0;
  return in;
}

/// Numbers that are likely to be near a limit, or any bits at all.
float any_float(Choices& choices) {
  constexpr float kLikely[] = {0.0F,    -0.0F, 0.1F, -0.1F, -20.0F, -50.0F,
                               -50.01F, 2.0F,  3.0F, 0.7F,  1.0F,   1.01F};
  const std::uint8_t which = choices.byte();
  if (which < 240) return kLikely[which % std::size(kLikely)];
  const auto bits = choices.number<std::uint32_t>();
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

bool asks_for_nothing(const rosflight::OffboardControl& command) {
  return std::all_of(command.u.begin(), command.u.end(), [](float value) { return value == 0.0F; });
}

/// What safety wants of a command, said once more.
bool is_sound(const rosflight::OffboardControl& command, const CommandLimits& limits) {
  const auto& u = command.u;
  constexpr double kRounding = 1.0001;
  const bool finite = std::all_of(u.begin(), u.end(), [](float value) { return std::isfinite(value); });
  const bool free =
      u[0] == 0.0F && u[1] == 0.0F && std::all_of(u.begin() + 6, u.end(), [](float v) { return v == 0.0F; });
  const double lift = command.mode == 0 ? -static_cast<double>(u[2]) : static_cast<double>(u[2]);
  const double most_lift = command.mode == 0 ? limits.thrust : 1.0;
  const double most_turn = std::max({limits.torque, limits.angle, limits.rate});
  const bool bounded = std::all_of(u.begin() + 3, u.begin() + 6, [&](float value) {
    return std::abs(static_cast<double>(value)) <= most_turn * kRounding;
  });
  return finite && free && command.mode <= 2 && lift >= 0.0 && lift <= most_lift * kRounding && bounded;
}

/// Any message, with any bits in its fields.
rosflight::Message any_message(Choices& choices) {
  const rosflight::MessageInfo& info = rosflight::kDialect[choices.byte() % rosflight::kDialect.size()];
  std::array<std::uint8_t, rosflight::kGreatestFrame> frame{};
  const auto payload = choices.take(info.length);
  std::copy(payload.begin(), payload.end(), frame.begin() + rosflight::kFrameHeader);
  return rosflight::decode_frame(std::span(frame).first(rosflight::kFrameOverhead + info.length), info)
      .message;
}

class Guarded {
 public:
  Guarded(Choices& choices, InterlockProfile profile)
      : choices_(choices), config_(config(profile)), interlock_(config_) {}

  void step() {
    const std::uint8_t what = choices_.byte();
    now_ += what < 8 ? Time(milliseconds(choices_.byte())) : Time(microseconds(2500));
    if (what % 8U < 4U) {
      in_ = any_inputs(choices_);
      interlock_.step(in_, now_);
      witness_.see(in_);
    } else if (what % 8U < 7U) {
      command();
    } else {
      pass();
    }
  }

 private:
  void command() {
    StampedCommand wanted;
    for (std::size_t k = 2; k < 6; ++k) wanted.command.u[k] = any_float(choices_);
    const std::uint8_t rare = choices_.byte();
    if (rare < 16) wanted.command.u[rare % wanted.command.u.size()] = any_float(choices_);
    wanted.command.mode = static_cast<std::uint8_t>(rare % 4U);
    wanted.number = rare % 32U == 31U ? number_ : ++number_;
    wanted.answers = now_ - Time(microseconds(choices_.number<std::uint16_t>() % 8192U)) +
                     Time(microseconds(rare % 64U == 63U ? 9000 : 0));
    const auto passed = interlock_.command(wanted, now_);
    if (!passed || asks_for_nothing(*passed)) return;
    require(interlock_.status().state == InterlockState::kLive,
            "no motor command above zero leaves outside Live");
    require(witness_.may_turn(), "a motor turns after a release, armed, with all well");
    require(is_sound(*passed, config_.limits), "no unsound motor command leaves");
    require(wanted.answers <= now_ && now_ - wanted.answers <= config_.limits.greatest_age,
            "no stale motor command leaves");
    require(wanted.number > passed_, "no motor command leaves twice");
    passed_ = wanted.number;
  }

  void pass() {
    const rosflight::Message message = any_message(choices_);
    const auto passed = interlock_.pass(message, now_);
    if (!passed) return;
    const Effect effect = effect_of(*passed);
    require(effect != Effect::kMoves, "nothing that moves leaves without a stamp");
    const InterlockState state = interlock_.status().state;
    require(
        effect != Effect::kChanges || (in_.unit_disarmed && !in_.unit_armed &&
                                       state != InterlockState::kReleased && state != InterlockState::kLive),
        "a unit is changed while it is disarmed and not released");
  }

  Choices& choices_;
  InterlockConfig config_;
  Interlock interlock_;
  Witness witness_;
  InterlockInputs in_;
  Time now_{};
  std::uint64_t number_ = 0;
  std::uint64_t passed_ = 0;
};

}  // namespace

void check(std::span<const std::uint8_t> input) {
  Choices choices(input);
  Guarded guarded(choices, choices.flag() ? InterlockProfile::kBench : InterlockProfile::kFlight);
  while (choices.any_left()) guarded.step();
}

}  // namespace ironbird::fuzzing
