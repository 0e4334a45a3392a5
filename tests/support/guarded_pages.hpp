// Zeroed pages of memory between two that may not be touched. WebAssembly cannot forbid pages. There the two hold bytes
// of all ones, NaN as floats: a write into them fails the test at the end, a read shows where the result depends on it.
#ifndef TEXTPLANE_TESTS_SUPPORT_GUARDED_PAGES_HPP
#define TEXTPLANE_TESTS_SUPPORT_GUARDED_PAGES_HPP

#if defined(__wasm__)

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace textplane_test {

class GuardedPages {
 public:
  /// Whole pages for `bytes` bytes.
  explicit GuardedPages(std::size_t bytes) : inside_((bytes + kPage - 1) / kPage * kPage) {
    base_ = static_cast<unsigned char*>(std::aligned_alloc(kPage, inside_ + 2 * kPage));
    if (base_ == nullptr) std::abort();
    std::fill(base_, begin(), kForbidden);
    std::fill(begin(), end(), static_cast<unsigned char>(0));
    std::fill(end(), end() + kPage, kForbidden);
  }
  ~GuardedPages() {
    const auto whole = [](unsigned char byte) { return byte == kForbidden; };
    EXPECT_TRUE(std::all_of(base_, begin(), whole)) << "a write below the memory";
    EXPECT_TRUE(std::all_of(end(), end() + kPage, whole)) << "a write beyond the memory";
    std::free(base_);
  }
  GuardedPages(const GuardedPages&) = delete;
  GuardedPages& operator=(const GuardedPages&) = delete;

  unsigned char* begin() const { return base_ + kPage; }
  unsigned char* end() const { return begin() + inside_; }

 private:
  static constexpr std::size_t kPage = 4096;
  static constexpr unsigned char kForbidden = 255;
  std::size_t inside_;
  unsigned char* base_;
};

}  // namespace textplane_test

#else

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#undef near
#undef far
#else
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <cstddef>
#include <new>

namespace textplane_test {

/// Pages of the operating system: zeroed, and one that may not be touched.
#if defined(_WIN32)
inline std::size_t page_size() {
  SYSTEM_INFO info;
  GetSystemInfo(&info);
  return info.dwPageSize;
}
inline void* take_pages(std::size_t bytes) {
  return VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
}
inline bool forbid_page(void* page) {
  DWORD former = 0;
  return VirtualProtect(page, page_size(), PAGE_NOACCESS, &former) != 0;
}
inline void give_pages(void* pages, std::size_t) { VirtualFree(pages, 0, MEM_RELEASE); }
#else
inline std::size_t page_size() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }
inline void* take_pages(std::size_t bytes) {
  void* const pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return pages == MAP_FAILED ? nullptr : pages;
}
inline bool forbid_page(void* page) { return mprotect(page, page_size(), PROT_NONE) == 0; }
inline void give_pages(void* pages, std::size_t bytes) { munmap(pages, bytes); }
#endif

class GuardedPages {
 public:
  /// Whole pages for `bytes` bytes.
  explicit GuardedPages(std::size_t bytes) : page_(page_size()) {
    inside_ = (bytes + page_ - 1) / page_ * page_;
    base_ = static_cast<unsigned char*>(take_pages(inside_ + 2 * page_));
    if (base_ == nullptr) throw std::bad_alloc();
    if (!forbid_page(base_) || !forbid_page(end())) {
      give_pages(base_, inside_ + 2 * page_);
      throw std::bad_alloc();
    }
  }
  ~GuardedPages() { give_pages(base_, inside_ + 2 * page_); }
  GuardedPages(const GuardedPages&) = delete;
  GuardedPages& operator=(const GuardedPages&) = delete;

  unsigned char* begin() const { return base_ + page_; }
  unsigned char* end() const { return begin() + inside_; }

 private:
  std::size_t page_, inside_ = 0;
  unsigned char* base_ = nullptr;
};

}  // namespace textplane_test

#endif

#endif  // TEXTPLANE_TESTS_SUPPORT_GUARDED_PAGES_HPP
