// Memory that ends, or begins, at a page that may not be touched: a read or write beyond it kills the test, which
// AddressSanitizer does not promise for gathers and masked loads.
#ifndef TEXTPLANE_TESTS_SUPPORT_GUARDED_HPP
#define TEXTPLANE_TESTS_SUPPORT_GUARDED_HPP

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <new>

namespace textplane_test {

/// Pages for `size` elements of a trivial type T between two forbidden pages. The last element touches the upper one.
template <class T>
class Guarded {
 public:
  explicit Guarded(std::size_t size) : size_(size) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t inside = (size * sizeof(T) + page - 1) / page * page;
    bytes_ = inside + 2 * page;
    void* const memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    base_ = static_cast<unsigned char*>(memory);
    if (mprotect(base_, page, PROT_NONE) != 0 || mprotect(base_ + page + inside, page, PROT_NONE) != 0) {
      munmap(base_, bytes_);
      throw std::bad_alloc();
    }
    first_ = reinterpret_cast<T*>(base_ + page);
    end_ = reinterpret_cast<T*>(base_ + page + inside);
  }
  ~Guarded() { munmap(base_, bytes_); }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  /// `size` elements before the upper forbidden page.
  T* data() const { return end_ - size_; }
  /// One past the last element: the first forbidden byte.
  T* end() const { return end_; }
  /// `size` elements behind the lower forbidden page.
  T* front() const { return first_; }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_, bytes_ = 0;
  unsigned char* base_ = nullptr;
  T* first_ = nullptr;
  T* end_ = nullptr;
};

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_GUARDED_HPP
