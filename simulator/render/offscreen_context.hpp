#pragma once

#include <cstdint>
#include <memory>

namespace ironbird::simulator {

/// A software OpenGL context without a window, current in the thread that made it until it is destroyed. One
/// per thread.
///
/// The library behind it is large, so it is loaded when the first context is made and not with the program: a
/// run without pictures starts three times as fast without it.
class OffscreenContext {
 public:
  /// @throws std::runtime_error when the library cannot be loaded or the context cannot be made
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Makes this the context that OpenGL calls go to.
  void make_current();

  /// Sets what the next drawing fills, in pixels from the lower left corner.
  void set_viewport(int width, int height);

  /// Copies the lower left part of the picture, bottom row first. @param rgba  4 width height bytes
  void read_colours(int width, int height, std::uint8_t* rgba);
  /// Copies its depths, 0 near to 1 far. @param depth  width height numbers
  void read_depths(int width, int height, float* depth);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace ironbird::simulator
