#include "scenarios/config/write_file.hpp"

#include <fstream>
#include <system_error>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

namespace {

/// What is written first, and becomes the file when it is whole.
std::filesystem::path part_of(const std::filesystem::path& file) {
  return file.string() + ".part";
}

/// Empty when it can be written.
std::string why_unwritable(const std::filesystem::path& file) {
  std::error_code error;
  const auto there = std::filesystem::status(file, error);
  if (std::filesystem::is_directory(there)) return "it is a folder; name a file in it";
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) return "";
  const std::string folder = file.parent_path().empty() ? "." : file.parent_path().string();
  if (!std::filesystem::is_directory(folder, error))
    return "there is no folder " + folder + "; make it, or name another place on the command line";
  errno = 0;
  const bool opens = std::ofstream(part_of(file), std::ios::binary).is_open();
  const std::string reason = opens ? "" : "the folder " + folder + " takes no file: " + std::strerror(errno);
  std::filesystem::remove(part_of(file), error);
  return reason;
}

}  // namespace

void check_writable(const std::filesystem::path& file) {
  const std::string why = why_unwritable(file);
  if (!why.empty()) throw UserError(with_remedy(file.string() + ": cannot be written: " + why));
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw UserError(folder.string() + ": cannot make the output folder: " + error.message() +
                    "; choose another with --out");
}

void write_file(const std::filesystem::path& file, std::string_view text) {
  check_writable(file);
  std::error_code error;
  const auto there = std::filesystem::status(file, error);
  // What is no file, as /dev/full, can only be written into.
  const bool beside = !std::filesystem::exists(there) || std::filesystem::is_regular_file(there);
  const std::filesystem::path target = beside ? part_of(file) : file;
  errno = 0;
  std::ofstream stream(target, std::ios::binary);
  stream << text;
  stream.close();
  std::string reason = stream ? "" : std::strerror(errno);
  if (beside && reason.empty()) {
    std::filesystem::rename(target, file, error);
    if (error) reason = error.message();
  }
  if (reason.empty()) return;
  if (beside) std::filesystem::remove(target, error);
  throw UserError(with_remedy(file.string() + ": cannot be written: " + reason));
}

}  // namespace ironbird::scenarios
