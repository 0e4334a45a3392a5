#include "textslam/map_session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/camera_formats/formats.hpp"
#include "io/clock.hpp"
#include "io/input_error.hpp"
#include "io/output_file.hpp"
#include "textplane/config.hpp"
#include "textslam/report/localisation.hpp"

namespace textslam {
namespace {

const char* to_string(Mode mode) { return mode == Mode::text ? "text" : mode == Mode::points ? "points" : "loose"; }

std::string joined(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  return line;
}

// Whether the sequence of a camera file may have a part in a map.
bool goes_with(const CameraModel& given, const MapRecord& record) {
  return is_same_camera(given, record.camera) || (record.given_camera && is_same_camera(given, *record.given_camera));
}

}  // namespace

bool has_map(const System& system) { return system.map().keyframe_ids().size() >= 2; }

bool is_same_camera(const CameraModel& a, const CameraModel& b) {
  constexpr double kTolerance = 1e-9;  // numbers that went through a text
  const std::vector<double> of_a = parameters_of(a), of_b = parameters_of(b);
  return a.width == b.width && a.height == b.height && std::string(a.raw.name()) == b.raw.name() &&
         std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                    [&](double x, double y) { return std::abs(x - y) <= kTolerance * (1 + std::abs(x)); });
}

MapSession::MapSession(MapSessionOptions options, Sequence* sequence)
    : options_(std::move(options)), started_(utc_now()) {
  if (sequence->camera_origin == CameraOrigin::file) given_ = sequence->camera;
  if (options_.map.empty()) return;
  earlier_ = load_map(options_.map, options_.parameters);
  const CameraModel& camera = earlier_->record.camera;
  if (camera.width != sequence->camera.width || camera.height != sequence->camera.height)
    throw InputError(options_.map, 0,
                     "its images are " + std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                         ", those of the sequence are not");
  if (given_ && !goes_with(*given_, earlier_->record))
    throw InputError(
        options_.map, 0,
        "its camera is not that of the sequence's camera file: a map has one camera, with the same numbers "
        "in all sessions");
  if (given_ && !is_same_camera(*given_, camera))
    sequence->notes.push_back(options_.map +
                              ": its camera is better than that of the camera file, as its first session found");
  sequence->camera = camera;
  sequence->camera.knows_readout = true;
  sequence->approximate_fov = 0;
}

void MapSession::begin(System* system) {
  if (!earlier_) return;
  // The record stays; only the map is the system's from here on.
  if (options_.localise)
    system->localise_in(std::move(earlier_->map));
  else
    system->go_on_in(std::move(earlier_->map));
}

std::string MapSession::image(int index) const {
  const auto& sources = earlier_->record.sources;
  const auto source = sources.find(earlier_keyframe_id(index, static_cast<std::size_t>(sources.rbegin()->first) + 1));
  return source == sources.end() ? "" : source->second.image;
}

MapRecord MapSession::record_of(const System& system, const CameraModel& camera, bool in_earlier,
                                const std::function<std::string(int)>& image) const {
  MapRecord record;
  if (in_earlier) record = earlier_->record;
  record.camera = camera;
  if (!in_earlier && given_ && !is_same_camera(*given_, camera)) record.given_camera = given_;
  record.camera.shutter.readout = system.map().shutter.readout;
  SavedSession session;
  session.id = record.sessions.empty() ? 1 : record.sessions.back().id + 1;
  session.started = started_;
  session.sequence = options_.sequence;
  session.command = joined(options_.command);
  session.mode = to_string(options_.parameters.mode);
  session.version = TEXTPLANE_VERSION_STRING;
  session.frames = static_cast<int>(system.records().size());
  for (const FrameRecord& r : system.records()) session.tracked += r.state == FrameState::tracked ? 1 : 0;
  record.sessions.push_back(session);
  for (const int id : system.map().keyframe_ids()) {
    const int frame = system.map().keyframe(id).frame.index;
    if (frame >= 0) record.sources[id] = {session.id, image(frame)};
  }
  return record;
}

std::string MapSession::save(const System& system, const CameraModel& camera, const MapSaving& saving) const {
  const bool in_earlier = earlier_ && system.is_in_earlier();
  const std::string none = options_.map + ": no frame was found in this map, which stays as it is";
  if (options_.localise) {
    write_file(saving.folder + "/localisation.csv", localisation_table(system));
    return in_earlier ? "" : none;
  }
  std::string path = saving.path.empty() ? options_.map : saving.path;
  if (path.empty() || !has_map(system)) return "";
  const bool apart = earlier_ && !in_earlier;
  if (apart) path = saving.folder + "/unjoined_map.db";
  MapRecord record = record_of(system, camera, in_earlier, saving.image);
  if (path != options_.map) record.revision = 0;
  if (saving.metric) record.scale_sigma = saving.metric->sigma;
  try {
    save_map(path, system.map(), record);
  } catch (const std::exception& error) {
    const std::string instead = saving.folder + "/map.db";
    record.revision = 0;
    save_map(instead, system.map(), record);
    throw std::runtime_error(std::string(error.what()) + "; the map of this run is in " + instead);
  }
  return apart ? none + "; what this run made is in " + path : "";
}

}  // namespace textslam
