// Corners followed through a sequence without a map: what estimates that come before the map rest on.
#ifndef TEXTSLAM_CALIBRATE_FRAME_PAIRS_HPP
#define TEXTSLAM_CALIBRATE_FRAME_PAIRS_HPP

#include <cstddef>
#include <functional>
#include <vector>

#include "io/sequence.hpp"
#include "textslam/calibrate/turn_readout.hpp"
#include "textslam/common/parameters.hpp"

namespace textslam {

/// The corners that neighbouring frames share, by the sequence's camera: of the frames with these indices, in order,
/// the first `most`. `progress` is called with the frames done and how many there are. Ends before a frame that cannot
/// be read, which is for the run to report, and when the program is told to.
std::vector<FramePair> follow_frames(const Sequence& sequence, const std::vector<std::size_t>& frames, std::size_t most,
                                     const Parameters& parameters,
                                     const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_FRAME_PAIRS_HPP
