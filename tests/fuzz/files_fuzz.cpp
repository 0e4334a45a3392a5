// Files that the example programs read: any bytes give a result or an InputError whose message is one line and begins
// with the file's name. The first byte says what the rest is taken for. And the library's reader of lines: any bytes
// give a detection that is finite, or a status, and a fault that lies within the line.
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "fuzz.hpp"
#include "io/detections.hpp"
#include "io/euroc.hpp"
#include "io/evaluate_signs.hpp"
#include "io/image_codecs.hpp"
#include "io/image_file.hpp"
#include "io/input_error.hpp"
#include "io/json_file.hpp"
#include "io/sequence.hpp"
#include "io/text_file.hpp"
#include "io/trajectory.hpp"
#include "textplane/landmarks/icdar.hpp"

namespace textplane_fuzz {
namespace {

// A file in memory, with a name to open it by.
class MemoryFile {
 public:
  explicit MemoryFile(const std::vector<std::uint8_t>& bytes) : descriptor_(memfd_create("fuzz", 0)) {
    TEXTPLANE_FUZZ_REQUIRE(descriptor_ >= 0);
    TEXTPLANE_FUZZ_REQUIRE(write(descriptor_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void parse_line(const std::vector<std::uint8_t>& bytes) {
  const std::string line(bytes.begin(), bytes.end());
  for (const tp::IcdarForm form : {tp::IcdarForm::word, tp::IcdarForm::score_word}) {
    tp::TextDetection seen({}, "before", 7);
    tp::IcdarFault fault;
    if (tp::is_ok(tp::parse_icdar_line(line, &seen, form, &fault))) {
      TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(seen.quad) && tp::is_finite(seen.score) && !seen.word.empty());
      continue;
    }
    TEXTPLANE_FUZZ_REQUIRE(seen.word == "before" && seen.score == 7 && seen.quad.corner[0].isZero(0));
    TEXTPLANE_FUZZ_REQUIRE(fault.field >= 0 && fault.field < 9 && line.find(fault.text) != std::string::npos);
  }
}

void read_as(int what, const std::string& path) {
  using namespace textslam;
  switch (what) {
    case 0:
      for (const Detection& d : read_icdar(path)) TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(d.quad));
      break;
    case 1:
      for (const StampedPose& pose : read_tum(path)) TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(pose.T_w_c));
      break;
    case 2: TEXTPLANE_FUZZ_REQUIRE(read_camera(path).raw.valid()); break;
    case 3: read_text_map(path); break;
    case 4: read_json(path); break;
    case 5: {
      const int orientation = image_orientation(path);
      TEXTPLANE_FUZZ_REQUIRE(orientation >= 1 && orientation <= 8);
      const Image<std::uint8_t> image = load_grey(path);
      TEXTPLANE_FUZZ_REQUIRE(image.width() > 0 && image.height() > 0);
      break;
    }
    case 7: {
      const CameraFile file = read_camera_file(path);
      TEXTPLANE_FUZZ_REQUIRE(file.model.raw.valid() && tp::all_finite(file.T_b_c));
      for (const CameraFormat format : {CameraFormat::settings, CameraFormat::sensor, CameraFormat::camchain,
                                        CameraFormat::opencv, CameraFormat::colmap})
        format_camera(file.model, format);
      break;
    }
    case 8:
      for (const FrameRef& frame : read_euroc_frames(path, "images")) TEXTPLANE_FUZZ_REQUIRE(frame.line > 0);
      break;
    case 9:
      for (const StampedPose& pose : read_euroc_truth(path, {})) TEXTPLANE_FUZZ_REQUIRE(tp::all_finite(pose.T_w_c));
      break;
    default: read_lines(path);
  }
}

}  // namespace
}  // namespace textplane_fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace textplane_fuzz;
  Input in(data, size);
  const int what = in.byte() % 11;
  const std::vector<std::uint8_t> bytes = in.rest();
  if (what == 10) return parse_line(bytes), 0;
  const MemoryFile file(bytes);
  try {
    read_as(what, file.path());
  } catch (const textslam::InputError& error) {
    const std::string message = error.what();
    TEXTPLANE_FUZZ_REQUIRE(message.compare(0, file.path().size(), file.path()) == 0);
    TEXTPLANE_FUZZ_REQUIRE(message.find('\n') == std::string::npos);
  }
  return 0;
}
