#include "city/city_measure.hpp"

#include <algorithm>
#include <atomic>
#include <ctime>
#include <thread>

namespace textslam {
namespace {

constexpr double kNear = 10;          // m
constexpr double kSurePose = 0.9999;  // share of a pose that no other one may replace

// CPU time: other programs may take the cores.
double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

bool is_wanted(const City& city, const CityQuery& query, CityView view) {
  int whole = 0, signs = 0;
  std::size_t last = 0;
  for (std::size_t i = 0; i < query.signs.size(); ++i) {
    if (query.signs[i] >= 0) ++signs;
    if (!query.whole[i]) continue;
    ++whole;
    last = i;
  }
  switch (view) {
    case CityView::three_signs: return whole >= 3;
    case CityView::one_sign:
      return whole == 1 && signs == 1 && is_read(query.detections[last].text) &&
             city.signs[static_cast<std::size_t>(query.signs[last])].unique;
    case CityView::any: return whole >= 1;
  }
  return false;
}

CityQuery wanted_query(const City& city, const CameraModel& camera, const CityTrial& trial, int number) {
  Random random(hash(trial.seed, 950 + static_cast<std::uint64_t>(trial.view), static_cast<std::uint64_t>(number)));
  while (true) {
    const SE3d T_w_c = random_view(city, camera, random);
    CityQuery query = make_query(city, camera, T_w_c, trial.reader, Random(random.word()));
    if (is_wanted(city, query, trial.view)) return query;
  }
}

bool is_right(const SignIndex& index, const CityQuery& query, const FoundPlace& place) {
  int right = 0;
  for (const SignSighting& s : place.sightings)
    right += index.id(s.sign) == query.signs[static_cast<std::size_t>(s.detection)] ? 1 : 0;
  return 2 * right > static_cast<int>(place.sightings.size());
}

// Something is read, and not all signs are of one chain: its shops look the same.
bool is_possible(const City& city, const CityQuery& query) {
  bool read = false, alike = true;
  int chain = -1;
  for (std::size_t i = 0; i < query.signs.size(); ++i) {
    if (query.signs[i] < 0) continue;
    const CitySign& sign = city.signs[static_cast<std::size_t>(query.signs[i])];
    read = read || is_read(query.detections[i].text);
    alike = alike && sign.chain >= 0 && (chain < 0 || sign.chain == chain);
    chain = sign.chain;
  }
  return read && !alike;
}

bool likeliest_is(const SignIndex& index, const CityQuery& query, WordScratch* scratch) {
  for (std::size_t i = 0; i < query.detections.size(); ++i) {
    if (query.signs[i] < 0 || !is_read(query.detections[i].text)) continue;
    const auto similar = index.words().similar(symbols_of(query.detections[i].text), 1, 1, scratch);
    return !similar.empty() && index.words().word(similar.front().word) == symbols_of(query.words[i]);
  }
  return false;
}

}  // namespace

std::vector<MappedSign> mapped_signs(const City& city) {
  std::vector<MappedSign> signs;
  for (const CitySign& sign : city.signs) {
    const Rectangle& r = sign.text;
    signs.push_back({static_cast<std::int64_t>(signs.size()),
                     sign.word,
                     {r.at(0, 0), r.at(r.width, 0), r.at(r.width, r.height), r.at(0, r.height)}});
  }
  return signs;
}

CameraModel city_camera() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.raw = Pinhole<double>(525, 525, 319.5, 239.5);
  camera.shutter = all_at_once(480);
  return camera;
}

std::vector<QueryResult> run_trial(const City& shown, const City& indexed, const SignIndex& index,
                                   const CityTrial& trial) {
  const CameraModel camera = city_camera();
  std::vector<QueryResult> results(static_cast<std::size_t>(trial.queries));
  std::atomic<int> next{0};
  const auto work = [&] {
    PlaceSearch search(index, trial.search);
    WordScratch scratch;
    for (int i = next++; i < trial.queries; i = next++) {
      const CityQuery query = wanted_query(shown, camera, trial, i);
      QueryResult& result = results[static_cast<std::size_t>(i)];
      const double start = thread_seconds();
      const PlaceAnswer answer = search.find(query.detections, camera);
      result.seconds = thread_seconds() - start;
      result.answered = answer.status == textplane::Status::ok;
      if (!answer.places.empty()) {
        const FoundPlace& first = answer.places.front();
        result.first_right = shown.seed == indexed.seed && is_right(index, query, first);
        result.probability = first.probability;
        result.position_error = (first.T_c_w.inverse().t - query.T_w_c.t).norm();
        const bool far = first.pose_share > kSurePose && result.position_error > kNear;
        result.wrong = result.answered && (!result.first_right || far);
      }
      result.possible = is_possible(shown, query);
      result.word_first = likeliest_is(index, query, &scratch);
    }
  };
  std::vector<std::thread> threads;
  for (int t = 0; t < std::max(1, trial.threads); ++t) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  return results;
}

}  // namespace textslam
