#pragma once

#include <sys/types.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/video/film.hpp"

namespace ironbird::scenarios {

/// Tells the OpenGL library how to work in this process: 256-bit vectors, and no threads of its own unless
/// the user chose otherwise. Before the first renderer.
void prepare_renderer_environment();

/// Processes that draw the frames of a script in turn, frame i by worker i mod n, each a few frames ahead of
/// the reader. Finished frames lie in shared memory.
class FrameWorkers {
 public:
  /// @throws std::runtime_error when a process cannot be started
  FrameWorkers(const FilmScript& script, int count);
  ~FrameWorkers();
  FrameWorkers(const FrameWorkers&) = delete;
  FrameWorkers& operator=(const FrameWorkers&) = delete;

  /// Waits for a frame; frames must be asked for in order. Valid until it is released.
  /// @throws std::runtime_error with the worker's own words when it failed
  std::span<const std::uint8_t> wait_for(std::size_t frame);

  /// Gives the memory of a frame back.
  void release(std::size_t frame);

 private:
  struct Worker {
    pid_t process = -1;
    int ready = -1;  // read end: one byte per finished frame
    int free = -1;   // write end: one byte per released frame
  };

  void start(int index);
  [[noreturn]] void work(int index, int ready, int free);
  std::span<std::uint8_t> slot(std::size_t frame) const;
  char* complaint(int index) const;

  const FilmScript& script_;
  std::size_t count_;
  std::size_t frame_size_;
  std::size_t memory_size_;
  std::uint8_t* memory_ = nullptr;
  std::vector<Worker> workers_;
};

}  // namespace ironbird::scenarios
