// ViSP's template trackers with a homography: ZNCC inverse compositional and forward additional, SSD ESM. Ten
// iterations on the same patch and image as ours; the counter is for one pixel and iteration.
#include <visp3/core/vpImage.h>
#include <visp3/tt/vpTemplateTrackerSSDESM.h>
#include <visp3/tt/vpTemplateTrackerWarpHomography.h>
#include <visp3/tt/vpTemplateTrackerWarpHomographySL3.h>
#include <visp3/tt/vpTemplateTrackerZNCCForwardAdditional.h>
#include <visp3/tt/vpTemplateTrackerZNCCInverseCompositional.h>

#include <memory>

#include "registry.hpp"
#include "scene.hpp"
#include "textplane/photometry/warp_patch.hpp"

namespace textplane_bench {

namespace {

vpImage<unsigned char> as_visp(const tp::Image<std::uint8_t>& image) {
  vpImage<unsigned char> out(static_cast<unsigned>(image.height()), static_cast<unsigned>(image.width()));
  for (int i = 0; i < image.width() * image.height(); ++i) out.bitmap[i] = image.data()[i];
  return out;
}

vpHomography homography(vpTemplateTrackerWarpHomography& warp, const vpColVector& p) { return warp.getHomography(p); }
vpHomography homography(vpTemplateTrackerWarpHomographySL3& warp, const vpColVector& p) {
  warp.computeCoeff(p);
  return warp.getHomography();
}

// The patch with a margin of 24 px, from the host and from the target, about 1 px apart. The trackers start from the
// identity and use all of the image that they get.
template <class Tracker, class Warp>
Work visp_work(int n) {
  struct Kept {
    vpImage<unsigned char> host, target;
    Warp warp;
    Tracker tracker;
    vpColVector start;
    Scene scene = make_scene(4000, 1, 1.0);
    tp::Matrix3<double> shift = tp::Matrix3<double>::Identity();  // cut px to host px
    explicit Kept(int m) : tracker(&warp) {
      const int columns = m == 4000 ? 100 : m == 1000 ? 40 : 16, rows = m / columns, margin = 24;
      tp::Image<std::uint8_t> cut(columns + 2 * margin, rows + 2 * margin);
      for (int y = 0; y < cut.height(); ++y)
        for (int x = 0; x < cut.width(); ++x) cut(x, y) = scene.host(scene.left - margin + x, scene.top - margin + y);
      host = as_visp(cut);
      shift(0, 2) = scene.left - margin;
      shift(1, 2) = scene.top - margin;
      tp::reference::warp_patch(scene.target_view(), scene.pixel_homography(scene.T_start, scene.theta_start) * shift,
                                cut.view());
      target = as_visp(cut);
      tracker.setSampling(1, 1);
      tracker.setLambda(0.001);
      tracker.setIterationMax(10);
      tracker.setUseBrent(false);
      const double x0 = margin, y0 = margin, x1 = x0 + columns, y1 = y0 + rows;
      std::vector<vpImagePoint> corners;  // two triangles
      for (const auto& [x, y] : {std::pair(x0, y0), std::pair(x1, y0), std::pair(x0, y1), std::pair(x0, y1),
                                 std::pair(x1, y0), std::pair(x1, y1)})
        corners.emplace_back(y, x);
      tracker.initFromPoints(host, corners);
      start = tracker.getp();
      scene.columns = columns;
      scene.rows = rows;
    }
    double corner_error() {
      const vpHomography found = homography(warp, tracker.getp());
      tp::Matrix3<double> H;
      for (unsigned i = 0; i < 9; ++i) H(static_cast<int>(i / 3), static_cast<int>(i % 3)) = found[i / 3][i % 3];
      return scene.corner_error(scene.pixel_homography(scene.T_start, scene.theta_start) * shift * H * shift.inverse());
    }
  };
  const auto kept = std::make_shared<Kept>(n);
  const auto run = [kept] {
    kept->tracker.setp(kept->start);
    kept->tracker.track(kept->target);
  };
  run();
  Work work;
  work.errors["corner_error"] = kept->corner_error();
  work.items = static_cast<double>(n) * kept->tracker.getNbIteration();
  work.errors["iterations"] = kept->tracker.getNbIteration();
  work.call = [=](std::size_t) { run(); };
  return work;
}

}  // namespace

void add_visp() {
  benchmark::AddCustomContext("ViSP", std::to_string(VISP_VERSION_MAJOR) + "." + std::to_string(VISP_VERSION_MINOR) +
                                          "." + std::to_string(VISP_VERSION_PATCH));
  for (const int n : {256, 1000, 4000}) {
    const std::string size = "/visp/" + std::to_string(n);
    add("visp_zncc_inverse" + size,
        [=] { return visp_work<vpTemplateTrackerZNCCInverseCompositional, vpTemplateTrackerWarpHomography>(n); });
    add("visp_zncc_forward" + size,
        [=] { return visp_work<vpTemplateTrackerZNCCForwardAdditional, vpTemplateTrackerWarpHomography>(n); });
    add("visp_ssd_esm" + size,
        [=] { return visp_work<vpTemplateTrackerSSDESM, vpTemplateTrackerWarpHomographySL3>(n); });
  }
}

}  // namespace textplane_bench
