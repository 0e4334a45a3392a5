#include "peers/dlib.hpp"

// The tracker's header does not include the first two, which it needs.
// clang-format off
#include <dlib/array2d.h>
#include <dlib/image_transforms/fhog.h>
#include <dlib/image_processing/correlation_tracker.h>
#include <dlib/revision.h>
// clang-format on

#include <algorithm>

namespace textplane_bench {

namespace {

using Pixels = dlib::array2d<unsigned char>;

void copy(const DlibImage& image, Pixels* to) {
  to->set_size(image.height, image.width);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* row = image.pixels + static_cast<std::ptrdiff_t>(y) * image.width;
    std::copy(row, row + image.width, &(*to)[y][0]);
  }
}

dlib::drectangle as_dlib(const DlibBox& box) { return {box.left, box.top, box.right, box.bottom}; }

}  // namespace

struct DlibTracker::Kept {
  dlib::correlation_tracker tracker;
  Pixels image;
};

DlibTracker::DlibTracker(const DlibImage& image, const DlibBox& box) : kept_(std::make_unique<Kept>()) {
  copy(image, &kept_->image);
  kept_->tracker.start_track(kept_->image, as_dlib(box));
}

DlibTracker::~DlibTracker() = default;

DlibBox DlibTracker::update(const DlibImage& image, const DlibBox& guess) {
  copy(image, &kept_->image);
  kept_->tracker.update(kept_->image, as_dlib(guess));
  const dlib::drectangle found = kept_->tracker.get_position();
  return {found.left(), found.top(), found.right(), found.bottom()};
}

#define TEXTPLANE_BENCH_TEXT(x) #x
#define TEXTPLANE_BENCH_VERSION(a, b, c) TEXTPLANE_BENCH_TEXT(a) "." TEXTPLANE_BENCH_TEXT(b) "." TEXTPLANE_BENCH_TEXT(c)

const char* dlib_version() {
  return TEXTPLANE_BENCH_VERSION(DLIB_MAJOR_VERSION, DLIB_MINOR_VERSION, DLIB_PATCH_VERSION);
}

}  // namespace textplane_bench
