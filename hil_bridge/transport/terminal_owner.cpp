#include "hil_bridge/transport/terminal_owner.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <system_error>

namespace ironbird::hil_bridge::transport {

namespace fs = std::filesystem;

namespace {

bool is_number(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Is this open file the maker's end of the terminal with that number? The kernel says so beside it.
bool is_other_end(const fs::path& process, const fs::path& file, const std::string& number) {
  std::error_code error;
  if (fs::read_symlink(file, error).filename() != "ptmx") return false;
  std::ifstream about(process / "fdinfo" / file.filename());
  for (std::string name, value; about >> name >> value;) {
    if (name == "tty-index:") return value == number;
  }
  return false;
}

/// Does one of the files that this process has open hold?
template <class Holds>
bool has_file(const fs::path& process, Holds&& holds) {
  std::error_code error;
  for (fs::directory_iterator file(process / "fd", error), end; !error && file != end;
       file.increment(error)) {
    if (holds(file->path())) return true;
  }
  return false;
}

bool has_made(const fs::path& process, const std::string& number) {
  return has_file(process, [&](const fs::path& file) { return is_other_end(process, file, number); });
}

std::string name_of(const fs::path& process) {
  std::string name;
  std::getline(std::ifstream(process / "comm"), name);
  return name;
}

/// The first process for which this holds, as a message names it, or nothing.
template <class Holds>
std::string find_process(Holds&& holds) {
  std::error_code error;
  for (fs::directory_iterator process("/proc", error), end; !error && process != end;
       process.increment(error)) {
    const std::string id = process->path().filename();
    if (is_number(id) && holds(process->path())) {
      return "process " + id + " (" + name_of(process->path()) + ")";
    }
  }
  return {};
}

}  // namespace

std::string owner_of_terminal(const fs::path& terminal) {
  const std::string number = terminal.filename();
  const std::string owner = find_process([&](const fs::path& process) { return has_made(process, number); });
  return owner.empty() ? "another program" : owner;
}

std::string user_of_device(const fs::path& device) {
  // Not the name: in another container the same one means another device.
  struct stat wanted {};
  if (stat(device.c_str(), &wanted) != 0) return {};
  const auto is_device = [&](const fs::path& file) {
    struct stat there {};
    return stat(file.c_str(), &there) == 0 && there.st_dev == wanted.st_dev && there.st_ino == wanted.st_ino;
  };
  std::error_code error;
  const std::string number = fs::canonical(device, error).filename();
  const std::string self = std::to_string(getpid());
  return find_process([&](const fs::path& process) {
    return process.filename() != self && has_file(process, is_device) && !has_made(process, number);
  });
}

}  // namespace ironbird::hil_bridge::transport
