// The detector's thread: it never keeps its caller waiting, takes key frames first, and says which frame a result
// belongs to.
#include "textslam/detect/detection_thread.hpp"

#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <string>

#include "io/input_error.hpp"

namespace textslam {
namespace detection_thread_test {

using Results = std::vector<DetectionThread::Result>;

// A detector that takes as long as the test wants: each image waits for a call of release(). It finds one quad, at the
// grey level of the image.
class GatedDetector {
 public:
  DetectionThread::Detect detect() {
    return [this](int frame, const DetectionThread::Pixels& raw) {
      std::unique_lock<std::mutex> lock(mutex_);
      begun_.push_back(frame);
      changed_.notify_all();
      changed_.wait(lock, [this] { return released_ > 0; });
      --released_;
      Detection detection;
      detection.quad.corner[0].x() = raw.grey(0, 0);
      return std::vector<Detection>{detection};
    };
  }
  void release(int count) {
    const std::lock_guard<std::mutex> lock(mutex_);
    released_ += count;
    changed_.notify_all();
  }
  /// The frames begun so far, once there are as many.
  std::vector<int> begun(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [&] { return begun_.size() >= count; });
    return begun_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<int> begun_;
  int released_ = 0;
};

DetectionThread::RawImage image(int frame) {
  return std::make_shared<const DetectionThread::Pixels>(
      DetectionThread::Pixels{Image<std::uint8_t>(4, 4, static_cast<std::uint8_t>(10 + frame))});
}

Results collect(DetectionThread& thread, std::size_t count) {
  Results all;
  while (all.size() < count) {
    for (DetectionThread::Result& result : thread.collect()) all.push_back(std::move(result));
    std::this_thread::yield();
  }
  return all;
}

// No call but the destructor's waits for the detector, or this would never end: it is released after all of them.
TEST(DetectionThread, TakesKeyFramesFirstTheNewestOfEachAndNeverWaits) {
  GatedDetector detector;
  DetectionThread thread(detector.detect());
  EXPECT_TRUE(thread.collect().empty());
  thread.offer(0, image(0), false);
  EXPECT_EQ(detector.begun(1), std::vector<int>{0});
  for (int frame = 1; frame <= 60; ++frame) {
    thread.offer(frame, image(frame), frame % 10 == 5);
    EXPECT_TRUE(thread.collect().empty());
  }
  detector.release(2);
  EXPECT_EQ(detector.begun(3), (std::vector<int>{0, 55, 60}));
  thread.offer(61, image(61), true);
  thread.offer(62, image(62), false);
  detector.release(3);
  EXPECT_EQ(detector.begun(5), (std::vector<int>{0, 55, 60, 61, 62}));

  const Results results = collect(thread, 5);
  ASSERT_EQ(results.size(), 5u);
  const std::vector<int> order = {0, 55, 60, 61, 62};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(results[i].frame, order[i]);
    ASSERT_EQ(results[i].detections.size(), 1u);
    EXPECT_EQ(results[i].detections[0].quad.corner[0].x(), 10 + order[i]) << "found in another frame's image";
    EXPECT_GE(results[i].ms, 0);
  }
  EXPECT_TRUE(thread.collect().empty()) << "each is given once";
}

TEST(DetectionThread, EndsWithTheImageThatIsWorkedOn) {
  GatedDetector detector;
  std::future<void> gone;
  {
    auto thread = std::make_unique<DetectionThread>(detector.detect());
    thread->offer(0, image(0), true);
    detector.begun(1);
    thread->offer(1, image(1), true);
    thread->offer(2, image(2), false);
    gone = std::async(std::launch::async, [&thread] { thread.reset(); });
    EXPECT_EQ(gone.wait_for(std::chrono::milliseconds(20)), std::future_status::timeout) << "the detector is at work";
    detector.release(1);
    gone.get();
  }
  EXPECT_EQ(detector.begun(1), std::vector<int>{0}) << "what waited is dropped";
}

TEST(DetectionThread, EndsUnused) {
  GatedDetector detector;
  const DetectionThread thread(detector.detect());
}

TEST(DetectionThread, GivesTheDetectorsErrorAfterWhatCameBefore) {
  int calls = 0;
  DetectionThread thread([&calls](int frame, const DetectionThread::Pixels&) {
    ++calls;
    if (frame == 1) throw InputError("model.onnx", 0, "no text detector");
    return std::vector<Detection>(3);
  });
  thread.offer(0, image(0), false);
  EXPECT_EQ(collect(thread, 1)[0].detections.size(), 3u);
  thread.offer(1, image(1), false);
  std::string message;
  while (message.empty()) {
    try {
      EXPECT_TRUE(thread.collect().empty());
      std::this_thread::yield();
    } catch (const InputError& error) {
      message = error.what();
    }
  }
  EXPECT_EQ(message, "model.onnx: no text detector");
  thread.offer(2, image(2), true);
  EXPECT_THROW(thread.collect(), InputError);
  EXPECT_EQ(calls, 2) << "it is not called again";
}

}  // namespace detection_thread_test
}  // namespace textslam
