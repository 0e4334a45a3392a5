#include "window/heap.hpp"

#include <malloc.h>

#include <atomic>
#include <cerrno>

// glibc's names of its own functions, for programs that replace malloc().
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);
}

namespace {

std::atomic<std::size_t> held{0}, peak{0}, held_at_start{0};

void* taken(void* p) noexcept {
  const std::size_t now = held += malloc_usable_size(p);
  std::size_t most = peak;
  while (now > most && !peak.compare_exchange_weak(most, now)) {
  }
  return p;
}
void given_back(void* p) noexcept { held -= malloc_usable_size(p); }

}  // namespace

extern "C" {
void* malloc(std::size_t n) noexcept { return taken(__libc_malloc(n)); }
void* calloc(std::size_t n, std::size_t size) noexcept { return taken(__libc_calloc(n, size)); }
void* realloc(void* p, std::size_t n) noexcept {
  const std::size_t before = malloc_usable_size(p);
  void* out = __libc_realloc(p, n);
  if (!out && n > 0) return nullptr;
  held -= before;
  return taken(out);
}
void* memalign(std::size_t alignment, std::size_t n) noexcept { return taken(__libc_memalign(alignment, n)); }
void* aligned_alloc(std::size_t alignment, std::size_t n) noexcept { return memalign(alignment, n); }
int posix_memalign(void** out, std::size_t alignment, std::size_t n) noexcept {
  void* p = memalign(alignment, n);
  if (!p) return ENOMEM;
  *out = p;
  return 0;
}
void free(void* p) noexcept {
  given_back(p);
  __libc_free(p);
}
}

namespace textplane_bench {

void start_heap_peak() {
  held_at_start = held.load();
  peak = held.load();
}
std::size_t heap_peak() { return peak - held_at_start; }

}  // namespace textplane_bench
