#include "textslam/detect/detection_thread.hpp"

#include <utility>

#include "io/clock.hpp"

namespace textslam {

DetectionThread::DetectionThread(Detect detect) : detect_(std::move(detect)), thread_([this] { work(); }) {}

DetectionThread::~DetectionThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void DetectionThread::offer(int frame, RawImage image, bool keyframe) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (failure_) return;
    waiting_[keyframe ? 0 : 1] = {frame, std::move(image)};
  }
  changed_.notify_one();
}

std::vector<DetectionThread::Result> DetectionThread::collect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (finished_.empty() && failure_) std::rethrow_exception(failure_);
  return std::exchange(finished_, {});
}

void DetectionThread::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || waiting_[0].image || waiting_[1].image; });
    if (ending_) return;
    const Job job = std::exchange(waiting_[waiting_[0].image ? 0 : 1], {});
    lock.unlock();
    Result result;
    std::exception_ptr failure;
    try {
      const double start = now_ms();
      result = {job.frame, detect_(job.frame, *job.image), 0};
      result.ms = now_ms() - start;
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = failure;
    if (failure_) return;
    finished_.push_back(std::move(result));
  }
}

}  // namespace textslam
