// DetectionThread: a text detector beside tracking, at its own rate.
//
// offer() leaves an image to it. While the detector is busy, the newest key frame and the newest other frame wait; the
// key frame goes first, as new texts are hosted by it. Older offers are never detected. collect(), between two frames,
// returns what was finished since.
//
// Threads: all members are called from one thread; only the destructor waits. `detect` is called from another, for one
// image at a time.
#ifndef TEXTSLAM_DETECT_DETECTION_THREAD_HPP
#define TEXTSLAM_DETECT_DETECTION_THREAD_HPP

#include <array>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "io/detections.hpp"

namespace textslam {

class DetectionThread {
 public:
  struct Pixels {
    Image<std::uint8_t> grey;
    Image<std::uint8_t> colour = {};  ///< See load_colour(); empty where the detector does not want it.
  };
  using RawImage = std::shared_ptr<const Pixels>;
  using Detect = std::function<std::vector<Detection>(int frame, const Pixels& raw)>;

  struct Result {
    int frame = -1;  ///< Index of the frame.
    std::vector<Detection> detections;
    double ms = 0;  ///< What the detector took.
  };

  explicit DetectionThread(Detect detect);
  /// Waits for the image that is worked on; those that wait are dropped.
  ~DetectionThread();
  DetectionThread(const DetectionThread&) = delete;
  DetectionThread& operator=(const DetectionThread&) = delete;

  /// After the frame was tracked, and it is known whether it became a key frame.
  void offer(int frame, RawImage image, bool keyframe);
  /// What is finished, oldest first. Then throws what `detect` threw; the thread has ended, and offers are dropped.
  std::vector<Result> collect();

 private:
  struct Job {
    int frame = -1;
    RawImage image;  // null: nothing waits
  };

  void work();

  Detect detect_;
  std::mutex mutex_;  // of all below but thread_
  std::condition_variable changed_;
  std::array<Job, 2> waiting_;  // a key frame, another frame
  std::vector<Result> finished_;
  std::exception_ptr failure_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace textslam

#endif  // TEXTSLAM_DETECT_DETECTION_THREAD_HPP
