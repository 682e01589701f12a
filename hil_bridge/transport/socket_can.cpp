#include "hil_bridge/transport/socket_can.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "hil_bridge/transport/can_error_frame.hpp"
#include "hil_bridge/transport/can_link.hpp"
#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge::transport {

namespace {

constexpr std::size_t kSocketEventQueue = 256;

Time read_clock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + Time(now.tv_nsec);
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("CAN interface " + what);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "this machine has none" : "there are: " + list;
}

std::string turn_on(const std::string& name, const CanLink& link, const SocketCanParams& params) {
  if (link.kind != "can") return "ip link set " + name + " up";
  const int bit_rate = params.bit_rate != 0 ? params.bit_rate : 1000000;
  return "ip link set " + name + " up type can bitrate " + std::to_string(bit_rate) +
         (params.fd ? " dbitrate 4000000 fd on" : "");
}

void require_interface(const SocketCanParams& params) {
  const std::string& name = params.interface;
  const std::optional<CanLink> link = read_can_link(name);
  if (!link) refuse(name + ": not found; " + list_of(can_interfaces()) + ". Is the adapter plugged in?");
  if (!link->can) refuse(name + ": carries no CAN; " + list_of(can_interfaces()));
  if (!link->up) refuse(name + ": is down. Switch it on: " + turn_on(name, *link, params));
  if (params.fd && !link->fd) {
    refuse(name + ": does not carry CAN FD. Ask for classic frames, or set it up: ip link set " + name +
           " down; " +
           (link->kind == "can" ? turn_on(name, *link, params) : "ip link set " + name + " mtu 72 up"));
  }
  if (params.bit_rate != 0 && link->bit_rate != 0 &&
      link->bit_rate != static_cast<std::uint32_t>(params.bit_rate)) {
    refuse(name + ": runs at " + std::to_string(link->bit_rate) + " bit/s, asked for are " +
           std::to_string(params.bit_rate) + ". Set it: ip link set " + name + " down; " +
           turn_on(name, *link, params));
  }
}

int open_socket(const std::string& name) {
  const int descriptor = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor >= 0) return descriptor;
  if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT) {
    refuse(name +
           ": this kernel knows no CAN. Load it: modprobe can_raw; if there is no such module, install the "
           "distribution's standard kernel");
  }
  refuse(name + ": cannot open a CAN socket: " + std::strerror(errno));
}

template <class T>
bool set_option(int descriptor, int level, int option, const T& value) {
  return setsockopt(descriptor, level, option, &value, sizeof value) == 0;
}

canfd_frame kernel_frame(const CanFrame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.identifier | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.len = frame.size;
  raw.flags = frame.bit_rate_switch ? CANFD_BRS : 0;
  std::copy_n(frame.data.begin(), frame.size, raw.data);
  return raw;
}

CanFrame own_frame(const canfd_frame& raw, bool fd) {
  CanFrame frame;
  frame.error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = !frame.error && (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.identifier = raw.can_id & (frame.extended || frame.error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.fd = fd;
  frame.bit_rate_switch = fd && (raw.flags & CANFD_BRS) != 0;
  frame.size = std::min<std::uint8_t>(raw.len, fd ? CANFD_MAX_DLEN : CAN_MAX_DLEN);
  std::copy_n(raw.data, frame.size, frame.data.begin());
  return frame;
}

}  // namespace

/// One datagram of the socket, with what the kernel says about it.
struct SocketCan::Arrival {
  CanFrame frame;
  Time wall_clock{};
  std::uint32_t overflow = 0;
};

SocketCan::SocketCan(const SocketCanParams& params, Time epoch)
    : params_(params), epoch_(epoch), events_(kSocketEventQueue) {
  simulator::check_bounds(params_, "socket_can");
  filters_.reserve(kMostFilters);
  try {
    open();
  } catch (...) {
    if (descriptor_ >= 0) close(descriptor_);
    throw;
  }
}

SocketCan::~SocketCan() {
  if (descriptor_ >= 0) close(descriptor_);
}

/// Opens, sets and binds the socket.
void SocketCan::open() {
  const std::string& name = params_.interface;
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  descriptor_ = open_socket(name);
  require_interface(params_);
  const std::optional<CanLink> link = read_can_link(name);
  if (!link) refuse(name + ": was unplugged while it was opened");
  const int on = 1;
  const can_err_mask_t all_errors = CAN_ERR_MASK;
  if ((params_.fd && !set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, on)) ||
      !set_option(descriptor_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, all_errors) ||
      !set_option(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, on) ||
      !set_option(descriptor_, SOL_SOCKET, SO_RXQ_OVFL, on) ||
      (params_.receive_buffer > 0 &&
       !set_option(descriptor_, SOL_SOCKET, SO_RCVBUF, params_.receive_buffer))) {
    refuse(name + ": the kernel refuses an option of the socket: " + std::strerror(errno));
  }
  apply_filters();
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = link->index;
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    refuse(name + ": cannot be bound: " + std::strerror(errno));
  }
  index_ = link->index;
  state_ = link->state;
  overflow_ = 0;
  gone_ = false;
}

void SocketCan::apply_filters() const {
  std::array<can_filter, kMostFilters> raw{};
  std::size_t count = 0;
  for (const FrameFilter& filter : filters_) {
    raw[count++] = {filter.identifier | (filter.extended ? CAN_EFF_FLAG : 0U), filter.mask | CAN_EFF_FLAG};
  }
  // A filter of zeros lets everything through.
  if (count == 0) count = 1;
  setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(),
             static_cast<socklen_t>(count * sizeof(can_filter)));
}

void SocketCan::set_filters(std::span<const FrameFilter> filters) {
  filters_.assign(filters.begin(),
                  filters.begin() + static_cast<std::ptrdiff_t>(std::min(filters.size(), kMostFilters)));
  apply_filters();
}

bool SocketCan::send(const CanFrame& frame) {
  bool taken = can::is_sendable(frame) && (params_.fd || !frame.fd) && state_ != BusState::kDown;
  if (taken) {
    const canfd_frame raw = kernel_frame(frame);
    const std::size_t size = frame.fd ? CANFD_MTU : CAN_MTU;
    taken = write(descriptor_, &raw, size) == static_cast<ssize_t>(size);
    if (!taken) lost_interface(errno);
  }
  ++(taken ? counters_.sent : counters_.refused);
  return taken;
}

std::optional<ReceivedFrame> SocketCan::receive() {
  Arrival arrival;
  while (fetch(arrival)) {
    const Time stamp = stamp_of(arrival.wall_clock);
    if (arrival.overflow != overflow_) {
      const std::uint32_t lost = arrival.overflow - overflow_;
      overflow_ = arrival.overflow;
      counters_.lost += lost;
      report(BusEventKind::kLost, lost);
    }
    if (!arrival.frame.error) {
      ++counters_.received;
      return ReceivedFrame{arrival.frame, stamp};
    }
    take_error(arrival.frame, stamp);
  }
  if (state_ == BusState::kDown) look_for_interface();
  return std::nullopt;
}

bool SocketCan::fetch(Arrival& arrival) {
  canfd_frame raw{};
  iovec room{&raw, sizeof raw};
  alignas(cmsghdr) std::array<char, 256> control;
  msghdr message{};
  message.msg_iov = &room;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(descriptor_, &message, MSG_DONTWAIT);
  if (size < 0) lost_interface(errno);
  if (size != CAN_MTU && size != CANFD_MTU) return false;
  arrival.frame = own_frame(raw, size == CANFD_MTU);
  arrival.overflow = overflow_;
  arrival.wall_clock = read_clock(CLOCK_REALTIME);
  for (cmsghdr* one = CMSG_FIRSTHDR(&message); one != nullptr; one = CMSG_NXTHDR(&message, one)) {
    if (one->cmsg_level != SOL_SOCKET) continue;
    if (one->cmsg_type == SO_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(one), sizeof stamp);
      arrival.wall_clock = std::chrono::seconds(stamp.tv_sec) + Time(stamp.tv_nsec);
    } else if (one->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&arrival.overflow, CMSG_DATA(one), sizeof arrival.overflow);
    }
  }
  return true;
}

/// The wall clock may be set at any time, the monotonic one only goes on: what counts is the frame's age.
/// Stamps do not go backwards when the wall clock does.
Time SocketCan::stamp_of(Time wall_clock) {
  const Time age = std::max(read_clock(CLOCK_REALTIME) - wall_clock, Time(0));
  last_stamp_ = std::max(read_clock(CLOCK_MONOTONIC) - age - epoch_, last_stamp_ + Time(1));
  return last_stamp_;
}

void SocketCan::take_error(const CanFrame& frame, Time stamp) {
  for (const BusEvent& event : events_of(frame, stamp).view()) {
    state_ = state_after(event.kind).value_or(state_);
    if (!events_.push(event)) ++counters_.events_lost;
  }
}

void SocketCan::report(BusEventKind kind, std::uint32_t count) {
  const BusEvent event = {kind, read_clock(CLOCK_MONOTONIC) - epoch_, count};
  if (!events_.push(event)) ++counters_.events_lost;
}

/// Draws the consequences of a system call's failure. That there is nothing to fetch, or no room, is none.
void SocketCan::lost_interface(int error) {
  const bool unplugged = error == ENODEV || error == ENXIO;
  if (!unplugged && error != ENETDOWN) return;
  if (unplugged && !gone_) report(BusEventKind::kGone);
  if (!unplugged && state_ != BusState::kDown) report(BusEventKind::kDown);
  gone_ = gone_ || unplugged;
  state_ = BusState::kDown;
}

void SocketCan::look_for_interface() {
  const auto index = static_cast<int>(if_nametoindex(params_.interface.c_str()));
  if (index != index_ && !gone_) lost_interface(ENODEV);
  if (index == 0) return;
  const std::optional<CanLink> link = read_can_link(params_.interface);
  if (!link || !link->up) return;
  try {
    // A socket bound to what was unplugged stays deaf.
    if (gone_) open();
    state_ = link->state;
    report(BusEventKind::kUp);
  } catch (const std::invalid_argument&) {
    // Not fit for use yet; the next call looks again.
    state_ = BusState::kDown;
  }
}

}  // namespace ironbird::hil_bridge::transport
