#include "textslam/report/calibration.hpp"

#include "io/camera_formats/camera_types.hpp"
#include "io/text_file.hpp"

namespace textslam {
namespace {

struct Parameter {
  std::string name;
  double value, sigma;
};

std::vector<Parameter> parameters_of(const SelfCalibration& c) {
  const CameraType::Names names = camera_type(c.camera.raw.name()).parameters();
  const auto values = c.camera.raw.parameters();
  std::vector<Parameter> out;
  for (std::size_t i = 0; i < names.size() && i < c.sigma.size(); ++i)
    out.push_back({names[i], values[static_cast<Eigen::Index>(i)], c.sigma[i]});
  return out;
}

std::string rounded(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

// "fx 525.02 (sd 0.04), k1 -0.2798 (sd 5e-05)": what was estimated. One focal length is two parameters.
std::string estimates(const std::vector<Parameter>& parameters) {
  std::string out;
  for (const Parameter& p : parameters)
    if (p.sigma > 0 && p.name != "fy")
      out += (out.empty() ? "" : ", ") + p.name + " " + rounded(p.value, 6) + " (sd " + rounded(p.sigma, 2) + ")";
  return out;
}

}  // namespace

void add_calibration(Fields& fields, const SelfCalibration& c, const std::optional<CameraModel>& truth) {
  Json values = Json::object(), sigmas = Json::object();
  const std::vector<Parameter> all = parameters_of(c);
  for (const Parameter& p : all) {
    values[p.name] = p.value;
    if (p.sigma > 0) sigmas[p.name] = p.sigma;
  }
  Json out{{"determined", c.determined}, {"start", c.origin}, {"start_fx", c.start.pinhole().fx}};
  if (c.determined) {
    out.update({{"model", c.camera.raw.name()},
                {"parameters", values},
                {"sigma", sigmas},
                {"frames", c.frames},
                {"observations", c.observations},
                {"reprojection_px", c.reprojection_px},
                {"passes", c.passes}});
    if (truth) {
      out["largest_error_px"] = camera_distance(*truth, c.camera);
      out["focal_error_percent"] = 100 * (c.camera.pinhole().fx / truth->pinhole().fx - 1);
    }
    fields.row("camera estimated", "%s", estimates({all.begin(), all.begin() + 4}).c_str());
    if (const std::string lens = estimates({all.begin() + 4, all.end()}); !lens.empty())
      fields.row("", "%s", lens.c_str());
    fields.row("", "begun with %s", c.origin.c_str());
    if (truth)
      fields.row("camera error", "%.2f px at most, focal length %+.2f %%", out["largest_error_px"].get<double>(),
                 out["focal_error_percent"].get<double>());
  }
  fields.add("calibration", nullptr, out);
  fields.add(nullptr, "calibration",
             c.determined ? "The camera was estimated from the images, begun with " + c.origin + ": " + estimates(all) +
                                ". What is not named was taken as it was."
                          : "The images do not tell the camera; it is " + c.origin + ".");
}

std::string camera_yaml(const CameraModel& camera, const std::optional<SelfCalibration>& calibration) {
  std::string out = format_camera(camera);
  if (!calibration) return out;
  for (const Parameter& p : parameters_of(*calibration))
    if (p.sigma > 0) out += "Camera.sigma." + p.name + ": " + shortest(p.sigma) + "\n";
  return out;
}

}  // namespace textslam
