#include "textslam_eval/evaluate_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/euroc.hpp"
#include "io/input_error.hpp"
#include "io/json_file.hpp"
#include "io/sequence.hpp"

namespace textslam {
namespace {

namespace fs = std::filesystem;

// The frames, whose stems name their files in truth/quads, from the list of any layout. The images may be gone.
std::vector<FrameRef> listed_frames(const std::string& truth) {
  EurocFiles euroc;
  if (const std::string list = find_list(truth); !list.empty()) return read_frame_list(truth, list);
  if (find_euroc(truth, &euroc)) return read_euroc_frames(euroc.list, euroc.images);
  return {};
}

// A run on a part of the sequence says how many frames it was to process.
std::size_t frame_count(const std::string& run, std::size_t listed) {
  const std::string path = run + "/metrics.json";
  if (!fs::exists(path)) return listed;
  const nlohmann::json metrics = read_json(path);
  const auto frames = metrics.is_object() ? metrics.find("frames") : metrics.end();
  if (frames == metrics.end() || !frames->is_number_unsigned()) throw InputError(path, 0, "no number of 'frames'");
  return frames->get<std::size_t>();
}

void require_folder(const std::string& folder, const char* what) {
  if (!fs::is_directory(folder))
    throw InputError(folder, 0, std::string("no such folder: ") + what + " is expected there");
}

}  // namespace

RunEvaluation evaluate_run(const std::string& run, const std::string& truth, bool with_scale) {
  require_folder(run, "the output of a run");
  const std::string folder = truth.empty() ? run + "/sequence" : truth;
  require_folder(folder, truth.empty() ? "the truth of a rendered run (or give --truth)" : "the truth");

  RunEvaluation out;
  out.run = run;
  const std::vector<FrameRef> frames = listed_frames(folder);
  out.frames = frame_count(run, frames.size());
  EvaluationOptions options;
  options.with_scale = with_scale;
  std::vector<StampedPose> reference = read_groundtruth(folder);
  if (reference.empty()) reference = read_tum(folder + "/groundtruth.txt");  // says what is missing
  const std::vector<StampedPose> poses = read_tum(run + "/trajectory.txt");
  out.poses = poses.size();
  out.trajectory = evaluate_trajectory(poses, reference, out.frames, options);
  out.has_live = fs::exists(run + "/trajectory_live.txt");
  if (out.has_live)
    out.live = evaluate_trajectory(read_tum(run + "/trajectory_live.txt"), reference, out.frames, options);

  const std::string map = run + "/text_map.json";
  if (!fs::exists(map)) return out;
  const std::vector<MappedText> texts = read_text_map(map);
  const std::vector<TrueSign> signs = read_true_signs(folder, frames, reference);
  if (!textplane::is_ok(out.trajectory.status)) return out;
  out.text = evaluate_texts(texts, signs, out.trajectory.alignment);
  for (const SignMatch& match : out.text.matches) out.words_right += match.word ? 1 : 0;
  return out;
}

std::array<int, kAngleBins.size()> angle_histogram(const TextEvaluation& text) {
  std::array<int, kAngleBins.size()> counts{};
  for (const SignMatch& match : text.matches) {
    if (match.sign < 0) continue;
    const auto bin = std::lower_bound(kAngleBins.begin(), kAngleBins.end() - 1, match.angle);
    ++counts[static_cast<std::size_t>(bin - kAngleBins.begin())];
  }
  return counts;
}

}  // namespace textslam
