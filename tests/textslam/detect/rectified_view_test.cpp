// What detectors of straight lines are shown of images whose lens bends them.
#include "textslam/detect/rectified_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "textslam/detect/text_detector.hpp"
#include "textslam/lens_support.hpp"

namespace textslam {
namespace rectified_view_test {

using lens_support::LensMap;

// Waves on the plane z = 1, none shorter than some 40 px.
double grey(const Vec3& ray) {
  return 128 + 50 * std::sin(9 * ray.x() / ray.z()) + 40 * std::cos(7 * ray.y() / ray.z());
}

// Where grey() is seen, three of each pixel: as it is, a half of it, and black.
Image<std::uint8_t> taken_by(const CameraView& camera, int width, int height, int channels) {
  Image<std::uint8_t> image(channels * width, height, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Vec3 ray;
      if (!textplane::is_ok(camera.unproject(Vec2(x, y), &ray))) continue;
      for (int c = 0; c < std::min(channels, 2); ++c)
        image(channels * x + c, y) = static_cast<std::uint8_t>(std::lround(grey(ray) / (c + 1)));
    }
  return image;
}

TEST(LineBend, TellsAFisheyeFromALensThatBendsLittle) {
  const Pinhole<double> pinhole{458, 457, 367, 248};
  EXPECT_EQ(line_bend(pinhole, 752, 480), 0);
  const double wide = line_bend({pinhole, &lens_support::wide_lens()}, 752, 480);
  EXPECT_GT(wide, 0.04);
  EXPECT_LT(wide, kMostBend);
  EXPECT_LT(wide, line_bend({pinhole, &lens_support::wide_lens()}, 752, 900)) << "more of what is bent";
  EXPECT_GT(line_bend({{280, 280, 319.5, 239.5}, &lens_support::fisheye()}, 640, 480), kMostBend);
  EXPECT_EQ(line_bend({{190, 190, 254, 256}, &lens_support::fisheye()}, 512, 512), 1) << "corners without a ray";
}

TEST(RectifiedView, ShowsTheMiddleAsAPinholeDoes) {
  const CameraView camera({320, 318, 318, 241}, &lens_support::fisheye());
  const RectifiedView view(camera, 640, 480);
  const Image<std::uint8_t> raw = taken_by(camera, 640, 480, 1), seen = view(raw.view());
  ASSERT_EQ(seen.width(), view.width());
  ASSERT_EQ(seen.height(), view.height());
  // 50 degrees to either side, with the resolution of the middle.
  EXPECT_NEAR(view.width(), 2 * 320 * std::tan(radians(50)), 2);
  EXPECT_LT(view.height(), view.width()) << "the image ends there";
  const double f = (view.width() - 1) / (2 * std::tan(radians(50)));
  double worst = 0;
  int compared = 0;
  for (int y = 0; y < view.height(); y += 3)
    for (int x = 0; x < view.width(); x += 3) {
      Quad<double> at;
      at.corner.fill(Vec2(x, y));
      ASSERT_TRUE(view.to_image(&at));
      const Vec3 ray = ray_of(camera, at.corner[0]);
      EXPECT_NEAR(ray.x(), x / f - std::tan(radians(50)), 2e-3) << "straight lines are straight";
      if (!(at.corner[0].y() >= 0 && at.corner[0].y() <= 479)) continue;
      worst = std::max(worst, std::abs(seen(x, y) - grey(ray)));
      ++compared;
    }
  EXPECT_GT(compared, view.width() * view.height() / 12);
  EXPECT_LT(worst, 2.5);

  const Image<std::uint8_t> colours = view(taken_by(camera, 640, 480, 3).view(), 3);
  ASSERT_EQ(colours.width(), 3 * view.width());
  for (int x = 0; x < view.width(); x += 7) {
    EXPECT_EQ(colours(3 * x, 100), seen(x, 100));
    EXPECT_NEAR(colours(3 * x + 1, 100), seen(x, 100) / 2, 2);
    EXPECT_EQ(colours(3 * x + 2, 100), 0);
  }
}

TEST(RectifiedView, QuadsGoThereAndBack) {
  const CameraView camera({250, 250, 319.5, 239.5}, &lens_support::fisheye());
  const RectifiedView view(camera, 640, 480);
  Quad<double> quad;
  quad.corner = {Vec2(20, 30), Vec2(90, 33), Vec2(88, 60), Vec2(19, 57)};
  const Quad<double> before = quad;
  ASSERT_TRUE(view.to_image(&quad));
  EXPECT_GT((quad.corner[0] - before.corner[0]).norm(), 20);
  ASSERT_TRUE(view.from_image(&quad));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((quad.corner[i] - before.corner[i]).norm(), 1e-6);
  quad.corner = {Vec2(5, 200), Vec2(60, 200), Vec2(60, 220), Vec2(5, 220)};
  EXPECT_FALSE(view.from_image(&quad)) << "seen by the lens, and not by the view";
}

TEST(RectifiedView, QuadsBeyondTheLensStayAsTheyWere) {
  const CameraView camera({230, 230, 319.5, 239.5}, &lens_support::fisheye());
  const RectifiedView view(camera, 640, 480);
  Quad<double> quad;
  quad.corner = {Vec2(10, 10), Vec2(60, 10), Vec2(60, 30), Vec2(1e5, 1e5)};
  const Quad<double> before = quad;
  EXPECT_FALSE(view.to_image(&quad));
  EXPECT_EQ(quad.corner, before.corner);
  quad.corner[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(view.to_image(&quad));
}

// Finds the box of all that is bright, and notes what it was shown.
class Brightest final : public TextDetector {
 public:
  explicit Brightest(int* width) : width_(width) {}
  std::vector<Detection> detect(const FrameRef& frame, ImageView8 image) override {
    *width_ = image.width();
    EXPECT_TRUE(frame.path.empty() || image.width() == 640) << "the file is bent";
    int left = image.width(), right = -1, top = image.height(), bottom = -1;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (image(x, y) > 128) {
          left = std::min(left, x);
          right = std::max(right, x);
          top = std::min(top, y);
          bottom = std::max(bottom, y);
        }
    Detection found;
    const double x0 = left, x1 = right, y0 = top, y1 = bottom;
    found.quad.corner = {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
    return {found};
  }

 private:
  int* width_;
};

// Reads in whatever it is shown; notes where.
class WhereAsked final : public TextReader {
 public:
  explicit WhereAsked(Quad<double>* at) : at_(at) {}
  Reading read(ImageView8, const Quad<double>& quad) override {
    *at_ = quad;
    return {"READ", 1};
  }

 private:
  Quad<double>* at_;
};

// A sign far off the axis, behind a lens that bends it: its corners come back through the lens.
TEST(MakeDetector, RectifiesWhereTheLensBendsLines) {
  for (const bool bent : {true, false}) {
    SCOPED_TRACE(bent);
    Sequence sequence;
    sequence.camera.width = 640;
    sequence.camera.height = 480;
    RadialTangential<double> lens;
    lens.intrinsics = {bent ? 250.0 : 525.0, bent ? 250.0 : 525.0, 319.5, 239.5};
    lens.k1 = -0.28;
    lens.k2 = 0.07;
    sequence.camera.raw = lens;
    const double low_x = bent ? 0.4 : 0.2, low_y = bent ? 0.4 : 0.2;
    Image<std::uint8_t> raw(640, 480, 0);
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 640; ++x) {
        Vec3 ray;
        ASSERT_TRUE(textplane::is_ok(lens.unproject({x, y}, &ray)));
        if (ray.x() > low_x && ray.x() < low_x + 0.3 && ray.y() > low_y && ray.y() < low_y + 0.1) raw(x, y) = 255;
      }
    int width = 0;
    Quad<double> asked;
    register_plugin({"brightest", [&](auto&, const Sequence&) { return std::make_unique<Brightest>(&width); },
                     [&](auto&) { return std::make_unique<WhereAsked>(&asked); }});
    DetectorOptions options;
    options.name = options.words = "brightest";
    FrameRef frame;
    frame.path = "frame.png";
    const auto found = make_detector(options, sequence)->detect(frame, raw.view());
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(width != 640, bent);
    const double x[4] = {low_x, low_x + 0.3, low_x + 0.3, low_x}, y[4] = {low_y, low_y, low_y + 0.1, low_y + 0.1};
    for (std::size_t i = 0; i < 4; ++i) {
      const double off = (found[0].quad.corner[i] - lens.project({x[i], y[i], 1})).norm();
      EXPECT_LT(off, bent ? 1.5 : 12) << "corner " << i;
    }
    EXPECT_EQ(found[0].text, "READ");
    EXPECT_EQ((asked.corner[0] - found[0].quad.corner[0]).norm() < 1e-9, !bent) << "read in what it was found in";
  }
}

}  // namespace rectified_view_test
}  // namespace textslam
