#include "simulator/render/offscreen_context.hpp"

#include <GL/osmesa.h>

#include <array>
#include <stdexcept>

namespace ironbird::simulator {
namespace {

// The window's own buffer is never drawn into: everything goes to a framebuffer object.
constexpr int kWindowSize = 8;

}  // namespace

struct OffscreenContext::Handle {
  OSMesaContext context = nullptr;
  std::array<unsigned char, kWindowSize * kWindowSize * 4> window{};
};

OffscreenContext::OffscreenContext() : handle_(std::make_unique<Handle>()) {
  handle_->context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  if (handle_->context == nullptr) {
    throw std::runtime_error("no picture: OSMesa cannot create a context");
  }
  make_current();
}

OffscreenContext::~OffscreenContext() {
  OSMesaDestroyContext(handle_->context);
}

void OffscreenContext::make_current() {
  if (!OSMesaMakeCurrent(handle_->context, handle_->window.data(), GL_UNSIGNED_BYTE, kWindowSize,
                         kWindowSize)) {
    throw std::runtime_error("no picture: OSMesa cannot make its context current");
  }
}

}  // namespace ironbird::simulator
