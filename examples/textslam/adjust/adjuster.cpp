#include "textslam/adjust/adjuster.hpp"

#include <chrono>
#include <utility>

#include "io/clock.hpp"

namespace textslam {

Adjuster::~Adjuster() {
  if (solved_.valid()) solved_.wait();
}

void Adjuster::keyframe_added(Map& map) {
  // A map so young is adjusted at once: the frames to come rest on it.
  if (is_too_young(map)) return adjust_all(map, parameters_, parameters_.window_iterations);
  if (parameters_.real_time) {
    if (solved_.valid()) {
      waiting_ = true;
    } else {
      begin(map, prepare(map));
    }
  } else if (const auto adjustment = prepare(map)) {
    adjustment->solve();
    adjustment->apply(map);
  }
}

bool Adjuster::map_corrected(Map& map) {
  auto adjustment = parameters_.real_time && !is_too_young(map) ? StagedAdjustment::of_all(map, parameters_) : nullptr;
  if (!adjustment) {
    adjust_all(map, parameters_, parameters_.final_iterations);
    return true;
  }
  begin(map, std::move(adjustment));
  correcting_ = true;
  return false;
}

bool Adjuster::has_grown(const Map& map) {
  if (map.number != whole_map_) whole_keyframes_ = 0;
  const std::size_t keyframes = map.keyframe_ids().size();
  if (keyframes > static_cast<std::size_t>(parameters_.whole_most_frames) ||
      static_cast<double>(keyframes) < parameters_.whole_growth * static_cast<double>(whole_keyframes_))
    return false;
  whole_map_ = map.number;
  whole_keyframes_ = keyframes;
  return true;
}

std::unique_ptr<StagedAdjustment> Adjuster::prepare(const Map& map) {
  return has_grown(map) ? StagedAdjustment::of_all(map, parameters_)
                        : StagedAdjustment::around_newest(map, parameters_);
}

void Adjuster::begin(const Map& map, std::unique_ptr<StagedAdjustment> adjustment) {
  waiting_ = false;
  adjustment_ = std::move(adjustment);
  if (!adjustment_) return;
  frame_ = map.keyframes.back().frame.index;
  solved_ = std::async(std::launch::async, [this] {
    const double start = now_ms();
    adjustment_->solve();
    return now_ms() - start;
  });
}

Adjuster::Collected Adjuster::collect(Map& map) {
  Collected out;
  if (!solved_.valid() || solved_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return out;
  out.ms = solved_.get();
  out.frame = frame_;
  out.moved = adjustment_->apply(map);
  out.changed = true;
  out.corrected = std::exchange(correcting_, false);
  adjustment_.reset();
  if (waiting_) begin(map, prepare(map));
  return out;
}

Adjuster::Collected Adjuster::settle(Map& map) {
  Collected all;
  while (solved_.valid()) {
    solved_.wait();
    const Collected one = collect(map);
    all = {true, all.corrected || one.corrected, one.moved * all.moved, one.frame, one.ms};
  }
  return all;
}

}  // namespace textslam
