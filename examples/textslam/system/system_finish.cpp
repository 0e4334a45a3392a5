// System, the part that comes after the last frame.
#include "textplane/landmarks/text_merge.hpp"
#include "textslam/adjust/adjustment.hpp"
#include "textslam/map/scale_map.hpp"
#include "textslam/system/system.hpp"
#include "textslam/text/loose_planes.hpp"
#include "textslam/text/text_reading.hpp"
#include "textslam/text/text_refiner.hpp"
#include "textslam/track/observe_points.hpp"

namespace textslam {

void System::refit(FrameRecord& record) const {
  if (record.state != FrameState::tracked || record.map != map_.number || record.seen.empty()) return;
  PoseEstimate pose{middle_pose(record).inverse(), parameters_.refit_live_weight * record.information};
  const CameraView camera(map_.camera.pinhole, map_.camera.lens, record.rows.get());
  if (!refit_pose(map_, parameters_, camera, record.seen, &pose)) return;
  record.T_k_c = map_.keyframe(record.keyframe).T_w_c.inverse() * pose.T_c_w.inverse();
  record.information = pose.information;
}

void System::finish() {
  if (only_localises_) return;
  take_over(adjuster_.settle(map_));
  keep_largest();
  if (map_.keyframes.size() < 2) return;
  if (parameters_.mode == Mode::text && parameters_.loop_closure)
    textplane::merge_duplicate_texts(parameters_.text, textplane::KeyframeLookup(map_), map_.texts);
  if (parameters_.estimate_readout) estimate_readout(2e-5);
  roll_all();
  adjust_all(map_, parameters_, parameters_.final_iterations);
  roll_all();
  // Poses are good to a pixel or two now: points are found where the tracker had lost them. That closes loops, too.
  if (parameters_.loop_closure && observe_points_again(map_, parameters_) > 0)
    adjust_all(map_, parameters_, parameters_.final_iterations);
  if (parameters_.mode == Mode::loose) refresh_loose_planes(map_, parameters_);
  if (parameters_.mode == Mode::text) {
    // Observations were judged with early, rough planes. The adjusted planes are seen in more key frames, and a wider
    // base settles their slant.
    text_mapper_.observe_again();
    roll_all();
    adjust_all(map_, parameters_, parameters_.final_iterations);
    refine_texts(map_, parameters_);
  }
  for (FrameRecord& record : records_) refit(record);
  align_live_world();
}

void System::scale_by(double factor) {
  scale_map(factor, &map_);
  for (FrameRecord& record : records_) {
    record.T_w_c_live.t *= factor;
    record.T_w_m_live.t *= factor;
    if (record.map != map_.number) continue;
    record.T_k_c.t *= factor;
    record.information = rescaled(record.information, factor);
    if (!record.rows) continue;
    textplane::RowMotion rows = *record.rows;
    rows.velocity.head<3>() *= factor;
    record.rows = std::make_shared<const textplane::RowMotion>(rows);
  }
  live_world_.t *= factor;
}

void System::read_texts(TextReader& reader) { textslam::read_texts(map_, parameters_, reader); }

}  // namespace textslam
