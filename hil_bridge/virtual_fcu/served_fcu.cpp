#include "hil_bridge/virtual_fcu/served_fcu.hpp"

#include <array>
#include <bit>
#include <span>

namespace ironbird::hil_bridge {

namespace {

constexpr std::uint8_t kFirmware = 250;
constexpr std::uint8_t kParameterComponent = 0;  // hard-coded in the firmware
constexpr std::size_t kQueueRoom = 256 * 50;     // bytes: a board's queue of 256 packets, of the usual length

}  // namespace

ServedFcu::ServedFcu(Fcu& unit, transport::ByteStream& line, std::uint8_t system)
    : unit_(unit), line_(line), system_(system) {
  outgoing_.reserve(kQueueRoom + rosflight::kGreatestFrame);
}

void ServedFcu::take() {
  std::array<std::uint8_t, transport::kReadRoom> bytes;
  while (const std::size_t count = line_.read(bytes)) {
    bytes_taken_ += count;
    for (const std::uint8_t byte : std::span(bytes).first(count)) {
      if (const auto frame = decoder_.push(byte)) {
        ++frames_taken_;
        requester_ = frame->sender.system;
        unit_.send(frame->message);
      }
    }
  }
}

void ServedFcu::give() {
  said_.clear();
  unit_.receive(said_);
  for (const Arrival& arrival : said_) {
    if (const auto* value = std::get_if<rosflight::ParamValue>(&arrival.message)) {
      const bool own_number = rosflight::text_of(value->param_id) == "SYS_ID";
      if (own_number)
        system_ = static_cast<std::uint8_t>(std::bit_cast<std::int32_t>(value->param_value.bits));
    }
    const rosflight::FrameBytes frame =
        rosflight::encode_frame(arrival.message, sequence_++, sender_of(arrival));
    if (outgoing_.size() + frame.size > kQueueRoom) {
      ++dropped_;
      continue;
    }
    outgoing_.insert(outgoing_.end(), frame.bytes.begin(),
                     frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.size));
  }
  if (!line_.is_up()) outgoing_.clear();
  if (outgoing_.empty()) return;
  const std::size_t count = line_.write(outgoing_);
  bytes_given_ += count;
  outgoing_.erase(outgoing_.begin(), outgoing_.begin() + static_cast<std::ptrdiff_t>(count));
}

rosflight::Address ServedFcu::sender_of(const Arrival& arrival) const {
  if (std::holds_alternative<rosflight::ParamValue>(arrival.message)) return {system_, kParameterComponent};
  if (arrival.odd_system) return {*arrival.odd_system, kFirmware};
  const auto* acknowledged = std::get_if<rosflight::RosflightCmdAck>(&arrival.message);
  const bool unknown = acknowledged != nullptr && acknowledged->command > rosflight::kSendAllConfigInfos;
  return {unknown ? requester_ : system_, kFirmware};
}

}  // namespace ironbird::hil_bridge
