#include "io/evaluate_detections.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "io/input_error.hpp"
#include "io/paths.hpp"
#include "io/text_file.hpp"

namespace textslam {

namespace fs = std::filesystem;

std::vector<TrueText> read_true_texts(const Sequence& sequence, const FrameRef& frame) {
  std::vector<TrueText> truth;
  const fs::path rendered = fs::path(sequence.folder) / "truth" / "quads" / (frame.stem + ".txt");
  if (!sequence.folder.empty() && is_there(rendered)) {
    for (const Detection& sign : read_icdar(rendered.string())) {
      // Its text is `word,sign,visible`.
      double visible = 0;
      if (!parse_number(sign.text.substr(sign.text.rfind(',') + 1), &visible))
        throw InputError(rendered.string(), 0, "expected 'text,sign,visible' after the quads");
      const auto& c = sign.quad.corner;
      const double height = std::min((c[3] - c[0]).norm(), (c[2] - c[1]).norm());
      truth.push_back({sign.quad, visible >= 0.99 && height >= kMinHeight});
    }
    return truth;
  }
  const fs::path icdar = fs::path(frame.path).parent_path() / truth_name(frame.stem);
  if (!is_there(icdar))
    throw InputError(frame.path, 0, "has no truth: neither truth/quads/" + frame.stem + ".txt nor " + icdar.string());
  for (const Detection& word : read_icdar(icdar.string())) truth.push_back({word.quad, is_read(word.text)});
  return truth;
}

void count_detections(const std::vector<TrueText>& truth, const std::vector<Detection>& found,
                      DetectionCounts* counts) {
  struct Pair {
    double overlap;
    std::size_t text, box;
  };
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < truth.size(); ++t)
    for (std::size_t b = 0; b < found.size(); ++b) {
      const double overlap = textplane::iou(truth[t].quad, found[b].quad);
      if (truth[t].counts && overlap >= kMinOverlap) pairs.push_back({overlap, t, b});
    }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.overlap > b.overlap; });
  std::vector<char> text_taken(truth.size(), 0), box_taken(found.size(), 0);
  for (const Pair& pair : pairs) {
    if (text_taken[pair.text] != 0 || box_taken[pair.box] != 0) continue;
    text_taken[pair.text] = box_taken[pair.box] = 1;
    ++counts->found;
  }
  ++counts->frames;
  for (const TrueText& text : truth) counts->texts += text.counts ? 1 : 0;
  for (std::size_t b = 0; b < found.size(); ++b) {
    const Quad<double>& box = found[b].quad;
    const bool passed_over =
        box_taken[b] == 0 && std::any_of(truth.begin(), truth.end(), [&](const TrueText& text) {
          return !text.counts && std::abs(textplane::area(textplane::intersection(box, text.quad))) >
                                     0.5 * std::abs(textplane::area(box));
        });
    counts->boxes += passed_over ? 0 : 1;
  }
}

std::string format_counts(const DetectionCounts& counts) {
  char line[160];
  std::snprintf(line, sizeof line, "%d frames, %d texts, %d found, %d boxes: recall %.3f, precision %.3f",
                counts.frames, counts.texts, counts.found, counts.boxes, counts.recall(), counts.precision());
  return line;
}

}  // namespace textslam
