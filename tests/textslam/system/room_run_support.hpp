// A whole run on a short room, as textslam makes it, and what it says of itself.
#ifndef TESTS_TEXTSLAM_SYSTEM_ROOM_RUN_SUPPORT_HPP
#define TESTS_TEXTSLAM_SYSTEM_ROOM_RUN_SUPPORT_HPP

#include "textslam/report/summary.hpp"
#include "textslam/system/short_room_support.hpp"

namespace textslam {

inline RunSummary run_on(const ShortRoom& room, System& system) {
  const Sequence& sequence = room.sequence();
  for (int i = 0; i < static_cast<int>(sequence.frames.size()); ++i) {
    Frame frame = room.load(i);
    frame.detections = read_detections(sequence, sequence.frames[static_cast<std::size_t>(i)]);
    system.process(frame);
  }
  system.finish();
  system.fill_in([&](int index) { return room.load(index); });
  RunSummary summary = summarise(system, sequence, sequence.frames.size());
  if (is_aligned(summary))
    summary.text = evaluate_text(system.map(), read_true_signs(sequence), summary.trajectory.alignment);
  return summary;
}

}  // namespace textslam

#endif  // TESTS_TEXTSLAM_SYSTEM_ROOM_RUN_SUPPORT_HPP
