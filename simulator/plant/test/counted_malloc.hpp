#pragma once

#include <atomic>
#include <cstddef>

// Counts every request for memory in a program, ours and the engines'. It takes the place of the C library's
// functions: for one source of a program of its own, and not with a sanitizer, which brings its own.

namespace {
std::atomic<long> calls_of_malloc{0};
}

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void* malloc(std::size_t size) {
  ++calls_of_malloc;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++calls_of_malloc;
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  ++calls_of_malloc;
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  ++calls_of_malloc;
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
}
