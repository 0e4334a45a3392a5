// BoundedSampler: of an endless series of values it keeps a bounded number, evenly spaced.
#ifndef TEXTSLAM_COMMON_BOUNDED_SAMPLER_HPP
#define TEXTSLAM_COMMON_BOUNDED_SAMPLER_HPP

#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

namespace textslam {

/// Keeps every step-th frame. The step doubles from 1 on, each time more than `most` are kept.
template <class T>
class BoundedSampler {
 public:
  explicit BoundedSampler(std::size_t most) : most_(most) {}

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

#endif  // TEXTSLAM_COMMON_BOUNDED_SAMPLER_HPP
