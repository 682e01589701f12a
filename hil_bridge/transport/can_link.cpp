#include "hil_bridge/transport/can_link.hpp"

#include <linux/can.h>
#include <linux/can/netlink.h>

#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <utility>

namespace ironbird::hil_bridge::transport {

namespace {

constexpr std::size_t kAnswerRoom = 32768;

template <class T>
T value_of(const rtattr* attribute) {
  T value{};
  std::memcpy(&value, RTA_DATA(attribute),
              std::min(sizeof value, static_cast<std::size_t>(RTA_PAYLOAD(attribute))));
  return value;
}

/// Calls `visit(type, attribute)` for each attribute in a stretch of bytes.
template <class Visit>
void for_each(const rtattr* first, int length, Visit visit) {
  for (const rtattr* one = first; RTA_OK(one, length); one = RTA_NEXT(one, length)) {
    visit(one->rta_type & NLA_TYPE_MASK, one);
  }
}
template <class Visit>
void for_each_in(const rtattr* nest, Visit visit) {
  for_each(static_cast<const rtattr*>(RTA_DATA(nest)), static_cast<int>(RTA_PAYLOAD(nest)), visit);
}

BusState state_of(std::uint32_t kernels) {
  constexpr BusState kStates[] = {BusState::kActive, BusState::kWarning, BusState::kPassive,
                                  BusState::kOff,    BusState::kDown,    BusState::kDown};
  return kernels < std::size(kStates) ? kStates[kernels] : BusState::kActive;
}

void read_controller(const rtattr* data, CanLink& link) {
  for_each_in(data, [&](int type, const rtattr* attribute) {
    if (type == IFLA_CAN_BITTIMING) link.bit_rate = value_of<can_bittiming>(attribute).bitrate;
    if (type == IFLA_CAN_STATE) link.state = state_of(value_of<std::uint32_t>(attribute));
    if (type == IFLA_CAN_BERR_COUNTER) {
      const auto counter = value_of<can_berr_counter>(attribute);
      link.send_errors = counter.txerr;
      link.receive_errors = counter.rxerr;
    }
  });
}

void read_kind(const rtattr* nest, CanLink& link) {
  const rtattr* data = nullptr;
  for_each_in(nest, [&](int type, const rtattr* attribute) {
    if (type == IFLA_INFO_KIND) link.kind = static_cast<const char*>(RTA_DATA(attribute));
    if (type == IFLA_INFO_DATA) data = attribute;
  });
  // The attributes mean this only for controllers.
  if (data != nullptr && link.kind == "can") read_controller(data, link);
}

CanLink link_of(const nlmsghdr* message) {
  const auto* info = static_cast<const ifinfomsg*>(NLMSG_DATA(message));
  CanLink link;
  link.index = info->ifi_index;
  link.can = info->ifi_type == ARPHRD_CAN;
  link.up = (info->ifi_flags & IFF_UP) != 0;
  for_each(IFLA_RTA(info), static_cast<int>(IFLA_PAYLOAD(message)), [&](int type, const rtattr* attribute) {
    if (type == IFLA_MTU) link.fd = link.can && value_of<std::uint32_t>(attribute) >= CANFD_MTU;
    if (type == IFLA_LINKINFO) read_kind(attribute, link);
  });
  return link;
}

struct Request {
  nlmsghdr head{};
  ifinfomsg info{};
};

}  // namespace

std::optional<CanLink> read_can_link(const std::string& name) {
  const unsigned index = if_nametoindex(name.c_str());
  if (index == 0) return std::nullopt;
  const int descriptor = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (descriptor < 0) return std::nullopt;
  Request request;
  request.head.nlmsg_len = sizeof request;
  request.head.nlmsg_type = RTM_GETLINK;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.info.ifi_index = static_cast<int>(index);
  alignas(nlmsghdr) std::array<char, kAnswerRoom> answer;
  std::optional<CanLink> link;
  if (send(descriptor, &request, sizeof request, 0) == sizeof request) {
    const ssize_t size = recv(descriptor, answer.data(), answer.size(), 0);
    const auto* message = reinterpret_cast<const nlmsghdr*>(answer.data());
    if (size > 0 && NLMSG_OK(message, static_cast<unsigned>(size)) && message->nlmsg_type == RTM_NEWLINK) {
      link = link_of(message);
    }
  }
  close(descriptor);
  return link;
}

std::vector<std::string> can_interfaces() {
  std::vector<std::string> names;
  struct if_nameindex* all = if_nameindex();
  for (const struct if_nameindex* one = all; one != nullptr && one->if_index != 0; ++one) {
    const std::optional<CanLink> link = read_can_link(one->if_name);
    if (link && link->can) names.emplace_back(one->if_name);
  }
  if_freenameindex(all);
  return names;
}

}  // namespace ironbird::hil_bridge::transport
