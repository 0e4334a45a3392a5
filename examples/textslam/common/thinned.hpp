// Thinned: values of frames that come one after another without end, of which a bounded, evenly spaced part is kept.
#ifndef TEXTSLAM_COMMON_THINNED_HPP
#define TEXTSLAM_COMMON_THINNED_HPP

#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

namespace textslam {

/// Keeps each step-th frame; the step is 1 at first, and doubles when there are more than `most`. So from the frame on that
/// has made `most` full, there are always at least half as many.
template <class T>
class Thinned {
 public:
  explicit Thinned(std::size_t most) : most_(most) {}

  /// Of the next frame, counted from 0.
  void add(T value) {
    const int frame = next_++;
    if (frame % step_ != 0) return;
    kept_.emplace(frame, std::move(value));
    if (kept_.size() <= most_) return;
    step_ *= 2;
    for (auto entry = kept_.begin(); entry != kept_.end();)
      entry = entry->first % step_ == 0 ? std::next(entry) : kept_.erase(entry);
  }
  /// Of a frame that was added; null where it is not kept.
  T* find(int frame) {
    const auto entry = kept_.find(frame);
    return entry == kept_.end() ? nullptr : &entry->second;
  }
  /// By frame.
  const std::map<int, T>& kept() const { return kept_; }

 private:
  std::size_t most_;
  int step_ = 1, next_ = 0;
  std::map<int, T> kept_;
};

}  // namespace textslam

#endif  // TEXTSLAM_COMMON_THINNED_HPP
