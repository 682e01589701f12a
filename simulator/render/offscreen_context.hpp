#pragma once

#include <memory>
#include <vector>

namespace ironbird::simulator {

/// A software OpenGL context without a window, current in the thread that made it until it is destroyed. One
/// per thread.
class OffscreenContext {
 public:
  /// @throws std::runtime_error when the context cannot be made
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Makes this the context that OpenGL calls go to.
  void make_current();

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace ironbird::simulator
