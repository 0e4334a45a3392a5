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
/// the first `most`. `go_on` is called after each frame with the pairs so far and the number of frames there are, and
/// says whether to. Ends before a frame that cannot be read, which is for the run to report, and when the program is
/// told to.
std::vector<FramePair> follow_frames(const Sequence& sequence, const std::vector<std::size_t>& frames, std::size_t most,
                                     const Parameters& parameters,
                                     const std::function<bool(const std::vector<FramePair>&, std::size_t)>& go_on);

}  // namespace textslam

#endif  // TEXTSLAM_CALIBRATE_FRAME_PAIRS_HPP
