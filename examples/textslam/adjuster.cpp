#include "textslam/adjuster.hpp"

#include <chrono>

#include "textslam/tracker.hpp"

namespace textslam {

Adjuster::~Adjuster() {
  if (solved_.valid()) solved_.wait();
}

void Adjuster::keyframe_added(Map& map) {
  // A map so young is adjusted as a whole, at once: the frames to come rest on it.
  if (!parameters_.real_time || map.keyframes.size() < 3) return adjust_local(map, parameters_);
  if (solved_.valid()) {
    waiting_ = true;
  } else {
    begin(map);
  }
}

void Adjuster::begin(const Map& map) {
  waiting_ = false;
  adjustment_ = LocalAdjustment::prepare(map, parameters_);
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
  adjustment_.reset();
  if (waiting_) begin(map);
  return out;
}

Adjuster::Collected Adjuster::settle(Map& map) {
  Collected all;
  while (solved_.valid()) {
    solved_.wait();
    const Collected one = collect(map);
    all = {true, one.moved * all.moved, one.frame, one.ms};
  }
  return all;
}

}  // namespace textslam
