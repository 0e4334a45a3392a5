// Memory that ends, or begins, at a page that may not be touched: a read or write beyond it kills the test, which
// AddressSanitizer does not promise for gathers and masked loads. WebAssembly has no such pages (guarded_pages.hpp).
#ifndef TEXTPLANE_TESTS_SUPPORT_GUARDED_HPP
#define TEXTPLANE_TESTS_SUPPORT_GUARDED_HPP

#include <cstddef>

#include "support/guarded_pages.hpp"

namespace textplane_test {

/// Pages for `size` elements of a trivial type T between two forbidden pages. The last element touches the upper one.
template <class T>
class Guarded {
 public:
  explicit Guarded(std::size_t size) : size_(size), pages_(size * sizeof(T)) {}
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  /// `size` elements before the upper forbidden page.
  T* data() const { return end() - size_; }
  /// One past the last element: the first forbidden byte.
  T* end() const { return reinterpret_cast<T*>(pages_.end()); }
  /// `size` elements behind the lower forbidden page.
  T* front() const { return reinterpret_cast<T*>(pages_.begin()); }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  GuardedPages pages_;
};

}  // namespace textplane_test

#endif  // TEXTPLANE_TESTS_SUPPORT_GUARDED_HPP
