#include "scenarios/video/frame_workers.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "scenarios/config/user_error.hpp"
#include "scenarios/video/yuv.hpp"

namespace ironbird::scenarios {
namespace {

constexpr std::size_t kSlots = 3;             // frames a worker may be ahead
constexpr std::size_t kComplaintSize = 1000;  // bytes for a worker's last words

bool read_byte(int descriptor) {
  char byte = 0;
  ssize_t count = 0;
  do {
    count = ::read(descriptor, &byte, 1);
  } while (count < 0 && errno == EINTR);
  return count == 1;
}

void close_end(int& descriptor) {
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  descriptor = -1;
}

}  // namespace

FrameWorkers::FrameWorkers(const FilmScript& script, int count)
    : script_(script),
      count_(static_cast<std::size_t>(count)),
      frame_size_(yuv420_size(script.renderer.width, script.renderer.height)),
      memory_size_(count_ * (kSlots * frame_size_ + kComplaintSize)) {
  void* memory = ::mmap(nullptr, memory_size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {
    throw UserError(std::string("film: no memory for frames: ") + std::strerror(errno));
  }
  memory_ = static_cast<std::uint8_t*>(memory);
  workers_.resize(count_);
  for (int i = 0; i < count; ++i) {
    start(i);
  }
}

FrameWorkers::~FrameWorkers() {
  for (Worker& worker : workers_) {
    close_end(worker.free);
    close_end(worker.ready);
    if (worker.process > 0) {
      ::kill(worker.process, SIGKILL);
      ::waitpid(worker.process, nullptr, 0);
    }
  }
  ::munmap(memory_, memory_size_);
}

void FrameWorkers::start(int index) {
  std::array<int, 2> ready{};
  std::array<int, 2> free{};
  if (::pipe2(ready.data(), O_CLOEXEC) != 0 || ::pipe2(free.data(), O_CLOEXEC) != 0) {
    throw UserError(std::string("film: no pipe: ") + std::strerror(errno));
  }
  const pid_t process = ::fork();
  if (process < 0) {
    throw UserError(std::string("film: no process: ") + std::strerror(errno));
  }
  if (process == 0) {
    ::close(ready[0]);
    ::close(free[1]);
    work(index, ready[1], free[0]);
  }
  ::close(ready[1]);
  ::close(free[0]);
  workers_[static_cast<std::size_t>(index)] = {process, ready[0], free[1]};
}

void FrameWorkers::work(int index, int ready, int free) {
  ::signal(SIGPIPE, SIG_DFL);  // the reader has gone: so do we
  // The ends of workers started before us belong to the reader; kept open they would hide its death.
  for (Worker& other : workers_) {
    close_end(other.ready);
    close_end(other.free);
  }
  int result = 0;
  try {
    prepare_renderer_environment();
    simulator::SceneRenderer renderer(script_.renderer);
    const auto first = static_cast<std::size_t>(index);
    for (std::size_t i = first; i < script_.frames.size(); i += count_) {
      const FilmFrame& frame = script_.frames[i];
      const simulator::Image image = renderer.render(frame.truth, frame.camera, overlays_at(script_, i));
      if ((i - first) / count_ >= kSlots && !read_byte(free)) {
        break;
      }
      to_yuv420(image, slot(i));
      if (::write(ready, "", 1) != 1) {
        break;
      }
    }
  } catch (const std::exception& error) {
    std::strncpy(complaint(index), error.what(), kComplaintSize - 1);
    result = 1;
  }
  ::_exit(result);
}

std::span<std::uint8_t> FrameWorkers::slot(std::size_t frame) const {
  const std::size_t worker = frame % count_;
  const std::size_t place = frame / count_ % kSlots;
  return {memory_ + (worker * kSlots + place) * frame_size_, frame_size_};
}

char* FrameWorkers::complaint(int index) const {
  return reinterpret_cast<char*>(memory_ + count_ * kSlots * frame_size_) +
         static_cast<std::size_t>(index) * kComplaintSize;
}

std::span<const std::uint8_t> FrameWorkers::wait_for(std::size_t frame) {
  const std::size_t worker = frame % count_;
  if (!read_byte(workers_[worker].ready)) {
    const std::string what = "film: frame " + std::to_string(frame) + ": ";
    const std::string words = complaint(static_cast<int>(worker));
    if (words.empty()) throw std::runtime_error(what + "the process that draws it died");
    throw UserError(what + words);
  }
  return slot(frame);
}

void FrameWorkers::release(std::size_t frame) {
  // A worker that has drawn its last frame no longer listens; one byte always fits into the pipe.
  if (frame + kSlots * count_ < script_.frames.size()) {
    static_cast<void>(!::write(workers_[frame % count_].free, "", 1));
  }
}

}  // namespace ironbird::scenarios
