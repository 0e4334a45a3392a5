#include "textslam/report/report.hpp"

#include <stdexcept>

#include "textplane/config.hpp"
#include "textplane/simd/dispatch.hpp"
#include "textslam/report/report_data.hpp"
#include "textslam/report/report_template.hpp"
#include "textslam/report/text_map.hpp"
#include "textslam/report/timing.hpp"

namespace textslam {

Json camera_json(const CameraModel& camera, double approximate_fov) {
  Json out{{"width", camera.width},
           {"height", camera.height},
           {"fx", short_number(camera.pinhole().fx)},
           {"fy", short_number(camera.pinhole().fy)},
           {"cx", short_number(camera.pinhole().cx)},
           {"cy", short_number(camera.pinhole().cy)}};
  if (approximate_fov > 0) out["approximate_fov_deg"] = short_number(approximate_fov);
  return out;
}

namespace {

Json data_json(const ReportInput& in) {
  return {{"version", TEXTPLANE_VERSION_STRING},
          {"summary", describe(in.summary).page},
          {"camera", camera_json(in.sequence.camera, in.sequence.approximate_fov)},
          {"min_zncc", in.parameters.text.min_zncc},
          {"cull_zncc", in.parameters.text.cull_zncc},
          {"same_word", in.parameters.text.same_word},
          {"start", in.system.records().empty() ? Json(nullptr) : Json(in.system.records().front().timestamp)},
          {"texts", page_texts(in.system.map(), in.summary.text.matches)},
          {"world", world_json(in.system, in.sequence, in.summary, in.signs)},
          {"series", series_json(in.system, in.sequence, in.summary)},
          {"frames", frames_json(in.system, in.parameters, in.detections, in.image)},
          {"parameters", parameters_json(in.parameters)}};
}

Json run_json(const ReportInput& in) {
  return {{"command", in.command},
          {"sequence", in.sequence.video ? in.sequence.images_file : in.sequence.folder},
          {"first", in.first},
          {"last", in.last},
          {"every", in.every},
          {"target", textplane::simd::to_string(textplane::simd::active_target())},
          {"frame_ms", short_number(in.summary.median_ms)},
          {"detect_ms", short_number(in.summary.median_detect_ms)},
          {"timing", page_timing(in.system)}};
}

void fill(std::string& page, const std::string& mark, const std::string& text) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) throw std::logic_error("the report's template has no " + mark);
  page.replace(at, mark.size(), text);
}

}  // namespace

std::string report_page(const Json& data, const Json& run) {
  std::string page(report_template());
  // From the back: what is filled in may hold the other mark.
  fill(page, "@DATA@", script_text(data));
  fill(page, "@RUN@", script_text(run));
  return page;
}

std::string report_html(const ReportInput& input) { return report_page(data_json(input), run_json(input)); }

}  // namespace textslam
