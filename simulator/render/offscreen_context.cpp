#include "simulator/render/offscreen_context.hpp"

#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>
#include <stdexcept>
#include <string>

namespace ironbird::simulator {
namespace {

// The window's own buffer is never drawn into: everything goes to a framebuffer object.
constexpr int kWindowSize = 8;

/// Loads the library for the whole process, for the physics engine's renderer looks there too.
void* load_library() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}) {
    if (void* library = dlopen(name, RTLD_NOW | RTLD_GLOBAL)) return library;
  }
  throw std::runtime_error(std::string("no picture: cannot load OSMesa: ") + dlerror());
}

}  // namespace

struct OffscreenContext::Handle {
  // Never unloaded: drivers of OpenGL do not survive that.
  void* library = load_library();
  decltype(&::OSMesaCreateContextExt) create = find<decltype(create)>("OSMesaCreateContextExt");
  decltype(&::OSMesaDestroyContext) destroy = find<decltype(destroy)>("OSMesaDestroyContext");
  decltype(&::OSMesaMakeCurrent) make_current = find<decltype(make_current)>("OSMesaMakeCurrent");
  decltype(&::glViewport) viewport = find<decltype(viewport)>("glViewport");
  decltype(&::glPixelStorei) pixel_store = find<decltype(pixel_store)>("glPixelStorei");
  decltype(&::glReadPixels) read_pixels = find<decltype(read_pixels)>("glReadPixels");
  OSMesaContext context = nullptr;
  std::array<unsigned char, kWindowSize * kWindowSize * 4> window{};

  template <class Function>
  Function find(const char* name) const {
    if (void* address = dlsym(library, name)) return reinterpret_cast<Function>(address);
    throw std::runtime_error(std::string("no picture: OSMesa has no ") + name);
  }
};

OffscreenContext::OffscreenContext() : handle_(std::make_unique<Handle>()) {
  handle_->context = handle_->create(OSMESA_RGBA, 24, 8, 0, nullptr);
  if (handle_->context == nullptr) {
    throw std::runtime_error("no picture: OSMesa cannot create a context");
  }
  make_current();
}

OffscreenContext::~OffscreenContext() {
  handle_->destroy(handle_->context);
}

void OffscreenContext::make_current() {
  if (!handle_->make_current(handle_->context, handle_->window.data(), GL_UNSIGNED_BYTE, kWindowSize,
                             kWindowSize)) {
    throw std::runtime_error("no picture: OSMesa cannot make its context current");
  }
}

void OffscreenContext::set_viewport(int width, int height) {
  handle_->viewport(0, 0, width, height);
}

void OffscreenContext::read_colours(int width, int height, std::uint8_t* rgba) {
  handle_->pixel_store(GL_PACK_ALIGNMENT, 4);
  handle_->read_pixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

void OffscreenContext::read_depths(int width, int height, float* depth) {
  handle_->pixel_store(GL_PACK_ALIGNMENT, 4);
  handle_->read_pixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth);
}

}  // namespace ironbird::simulator
