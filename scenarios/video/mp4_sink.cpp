#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"

#include "scenarios/video/video_sink.hpp"

extern char** environ;

namespace ironbird::scenarios {
namespace {

// Writes everything, without a signal when the reader has gone. @return false when it has
bool write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  sigset_t pipe_signal;
  sigset_t before;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  bool whole = true;
  while (whole && !bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      whole = false;
    }
  }
  if (!whole) {
    const timespec now{};
    sigtimedwait(&pipe_signal, nullptr, &now);
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return whole;
}

std::string cannot_start(const std::string& program, int error) {
  return "films need the program '" + program + "', which " +
         (error == ENOENT ? "was not found" : std::string("cannot be started: ") + std::strerror(error)) +
         "; install it";
}

class Mp4Sink final : public VideoSink {
 public:
  Mp4Sink(const std::filesystem::path& file, const VideoFormat& format, const std::string& preset,
          const std::string& program)
      : program_(program), file_(file), part_(file.string() + ".part") {
    check_writable(file_);  // a folder that takes no file would look like a program that cannot be started
    start(arguments(format, preset));
  }

  ~Mp4Sink() override {
    if (input_ >= 0) {
      ::close(input_);
    }
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
    if (complaints_ >= 0) {
      ::close(complaints_);
    }
  }

  void write(std::span<const std::uint8_t> yuv) override {
    if (!write_all(input_, yuv)) {
      wait();
      fail();
    }
  }

  void finish() override {
    ::close(input_);
    input_ = -1;
    if (wait() != 0) {
      fail();
    }
    std::error_code error;
    std::filesystem::rename(part_, file_, error);
    if (error) fail();
  }

 private:
  /// What is in the pipe, and what the file is made of.
  std::vector<std::string> arguments(const VideoFormat& format, const std::string& preset) const {
    const std::string size = std::to_string(format.width) + "x" + std::to_string(format.height);
    const std::string colours = " -color_range tv -colorspace bt709 -color_primaries bt709 -color_trc bt709";
    std::istringstream line("-nostdin -hide_banner -loglevel error -y -f rawvideo -pix_fmt yuv420p -s " +
                            size + " -framerate " + std::to_string(format.frame_rate) + colours +
                            " -i pipe:0 -an -c:v libx264 -preset " + preset +
                            " -crf 21 -threads 1 -pix_fmt yuv420p" + colours +
                            " -fflags +bitexact -flags:v +bitexact -movflags +faststart -f mp4");
    std::vector<std::string> words{program_};
    for (std::string word; line >> word;) words.push_back(word);
    words.push_back(part_.string());
    return words;
  }

  void start(std::vector<std::string> words) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
      throw UserError(std::string("film: no pipe: ") + std::strerror(errno));
    }
    input_ = ends[1];
    // Not beside the film: what there is to complain about is often that the disk is full.
    complaints_ = ::memfd_create("complaints", MFD_CLOEXEC);
    std::vector<char*> pointers;
    for (std::string& word : words) {
      pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], 0);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    if (complaints_ >= 0) {
      posix_spawn_file_actions_adddup2(&actions, complaints_, 2);
    } else {
      posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    }
    const int error =
        ::posix_spawnp(&process_, program_.c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    if (error != 0) {
      process_ = -1;
      ::close(input_);
      ::close(complaints_);
      throw UserError(file_.string() + ": " + cannot_start(program_, error) +
                      ", or name a .y4m file, which needs none");
    }
  }

  int wait() {
    int status = -1;
    if (process_ > 0) {
      ::waitpid(process_, &status, 0);
    }
    process_ = -1;
    return status;
  }

  [[noreturn]] void fail() {
    std::string line = "it gave no reason";
    std::array<char, 400> text{};
    const ssize_t count = ::pread(complaints_, text.data(), text.size(), 0);
    if (count > 0) {
      line.assign(text.data(), static_cast<std::size_t>(count));
      line.erase(std::min(line.find_first_of("\r\n"), line.size()));
    }
    const std::string message = file_.string() + ": '" + program_ + "' failed: " + line;
    const std::string helped = with_remedy(message);
    throw UserError(helped != message ? helped
                                      : message + "; see whether `" + program_ +
                                            " -version` works, or name a .y4m file, which needs none");
  }

  std::string program_;
  std::filesystem::path file_;
  std::filesystem::path part_;
  pid_t process_ = -1;
  int input_ = -1;
  int complaints_ = -1;  // what the program says, in memory
};

}  // namespace

void check_encoder(const std::string& program) {
  const char* path = std::getenv("PATH");
  const std::string_view folders = path != nullptr ? path : "/bin:/usr/bin";  // as posix_spawnp() has it
  int error = ENOENT;
  for (std::size_t begin = 0, end = 0; end != folders.npos; begin = end + 1) {
    end = folders.find(':', begin);
    const std::string folder(folders.substr(begin, end - begin));
    const std::string file = (folder.empty() ? "." : folder) + "/" + program;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) continue;
    if (::access(file.c_str(), X_OK) == 0) return;
    error = EACCES;
  }
  throw UserError("--video: " + cannot_start(program, error) + ", or leave the option away");
}

std::unique_ptr<VideoSink> make_mp4_sink(const std::filesystem::path& file, const VideoFormat& format,
                                         const std::string& preset, const std::string& program) {
  return std::make_unique<Mp4Sink>(file, format, preset, program);
}

}  // namespace ironbird::scenarios
