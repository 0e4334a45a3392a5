// The frames of a run, one by one, and what the detector says of them.
#ifndef TEXTSLAM_RUN_FRAMES_HPP
#define TEXTSLAM_RUN_FRAMES_HPP

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "textslam/common/bounded_sampler.hpp"
#include "textslam/detect/detection_thread.hpp"
#include "textslam/detect/text_detector.hpp"
#include "textslam/run.hpp"
#include "textslam/system/system.hpp"

namespace textslam {

/// Loads and detects. Frames are numbered in the order in which they were taken. Another thread may call detect().
class FrameSource {
 public:
  using Pixels = DetectionThread::Pixels;
  using RawImage = DetectionThread::RawImage;

  /// The sequence outlives it.
  FrameSource(const Sequence& sequence, const RunOptions& options);

  /// Takes the frame `at` of the sequence as the next one. Throws InputError where it cannot be read.
  RawImage take(std::size_t at);
  /// The frames that were taken come again, from the first one.
  void rewind() { next_ = 0; }
  double timestamp(int index) const { return sequence_.frames[at(index)].timestamp; }
  /// The frame of the sequence that was taken last; -1: none.
  int last() const { return taken_.empty() ? -1 : static_cast<int>(taken_.back()); }
  std::string name(int index) const { return frame_name(sequence_, at(index)); }
  std::vector<Detection> detect(int index, const Pixels& raw);
  Frame frame(int index, Image<std::uint8_t> image) const;
  Frame frame(int index) const { return frame(index, load_frame(sequence_, at(index))); }
  void read_texts(System& system) const;

 private:
  std::size_t at(int index) const;

  const Sequence& sequence_;
  Parameters parameters_;
  mutable std::mutex mutex_;        // of taken_
  std::vector<std::size_t> taken_;  // frames of the sequence
  std::size_t next_ = 0;            // of them
  std::shared_ptr<TextDetector> detector_;
  std::unique_ptr<TextReader> reader_;
};

/// Detection before each frame or, in real time, on a thread beside tracking. Files are always read before the frame.
class Detections {
 public:
  using Pixels = FrameSource::Pixels;
  using RawImage = FrameSource::RawImage;

  Detections(FrameSource& source, const RunOptions& options);

  /// Before the frame is processed. Returns the ms it took. A frame that comes again in step gets what was said of it.
  double before(Frame& frame, const Pixels& raw, System& system);
  void after(int index, const RawImage& raw, const Map& map);
  void end() { thread_.reset(); }
  /// Boxes of all frames.
  std::size_t count() const { return count_; }
  /// By the index of the frame, of as many as a report can show.
  const std::map<int, std::vector<Detection>>& of_frames() const { return of_frames_.kept(); }

 private:
  struct Said {
    std::vector<Detection> boxes;
    double ms;
  };

  void remember(int frame, const std::vector<Detection>& detections);

  FrameSource& source_;
  bool in_step_ = false;
  int frames_ = 0;          // that came, each once
  std::vector<Said> said_;  // of each of these in step
  std::size_t count_ = 0;
  BoundedSampler<std::vector<Detection>> of_frames_;
  std::unique_ptr<DetectionThread> thread_;
};

}  // namespace textslam

#endif  // TEXTSLAM_RUN_FRAMES_HPP
