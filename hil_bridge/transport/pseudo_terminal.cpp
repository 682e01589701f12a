#include "hil_bridge/transport/pseudo_terminal.hpp"

#include <fcntl.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "hil_bridge/transport/serial_settings.hpp"
#include "hil_bridge/transport/terminal_owner.hpp"

namespace ironbird::hil_bridge::transport {

namespace fs = std::filesystem;

namespace {

constexpr int kAnyBaud = 921600;
constexpr std::size_t kGreatestName = 64;
const fs::path kTerminals = "/dev/pts";

/// What is at `link` that must stay there, and what to do; or empty.
std::string in_the_way(const std::string& link, const std::string& device) {
  std::error_code error;
  const fs::file_status there = fs::symlink_status(link, error);
  if (!fs::exists(there)) return {};
  if (!fs::is_symlink(there)) return link + ": something else is there; name a path that is free";
  const fs::path target = fs::read_symlink(link, error);
  if (target.parent_path() != kTerminals) {
    return link + ": is a link to " + target.string() +
           ", which is no pseudo-terminal; name a path that is free";
  }
  // One that is no more has given its number back, perhaps to the one that is being made here.
  if (target == device || !fs::exists(target, error)) return {};
  return link + ": is a link to " + target.string() + ", which " + owner_of_terminal(target) +
         " has; end that, name another path, or remove the link if it is an old one";
}

/// Points `link` to `device`. @return empty, or what is wrong
std::string make_link(const std::string& link, const std::string& device) {
  if (const std::string problem = in_the_way(link, device); !problem.empty()) return problem;
  std::error_code error;
  fs::remove(link, error);
  fs::create_symlink(device, link, error);
  return error ? link + ": " + error.message() + "; name a path in a folder that exists and may be written to"
               : "";
}

}  // namespace

PseudoTerminal::PseudoTerminal(std::string link) : link_(std::move(link)) {
  if (const std::string problem = try_open(); !problem.empty()) throw LinkError(problem);
}

PseudoTerminal::~PseudoTerminal() {
  remove_link();
}

void PseudoTerminal::remove_link() {
  std::error_code error;
  if (!link_.empty() && fs::read_symlink(link_, error) == device_) fs::remove(link_, error);
}

std::string PseudoTerminal::try_open() {
  FileDescriptor file(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, kGreatestName> device{};
  if (!file || grantpt(file.number()) != 0 || unlockpt(file.number()) != 0 ||
      ptsname_r(file.number(), device.data(), device.size()) != 0) {
    return std::string("no pseudo-terminal: ") + std::strerror(errno);
  }
  FileDescriptor other(::open(device.data(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!other) return std::string(device.data()) + ": " + std::strerror(errno);
  if (const std::string problem = set_raw(other.number(), kAnyBaud); !problem.empty()) {
    return std::string(device.data()) + ": " + problem;
  }
  if (!link_.empty()) {
    if (const std::string problem = make_link(link_, device.data()); !problem.empty()) return problem;
  }
  device_ = device.data();
  other_ = std::move(other);
  file_ = std::move(file);
  return {};
}

bool PseudoTerminal::reopen() {
  return is_up() || try_open().empty();
}

void PseudoTerminal::hang_up() {
  // The device's number may be another program's terminal the moment that it is free.
  remove_link();
  file_.close();
  other_.close();
}

std::size_t PseudoTerminal::read(std::span<std::uint8_t> to) {
  if (!file_ || to.empty()) return 0;
  const ssize_t count = ::read(file_.number(), to.data(), to.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

std::size_t PseudoTerminal::write(std::span<const std::uint8_t> from) {
  if (!file_ || from.empty()) return 0;
  const ssize_t count = ::write(file_.number(), from.data(), from.size());
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace ironbird::hil_bridge::transport
