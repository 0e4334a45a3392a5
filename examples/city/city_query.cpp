#include "city/city_query.hpp"

#include <cmath>
#include <utility>

namespace textslam {
namespace {

constexpr double kFar = 45;  // m: signs beyond it are too small to read
constexpr double kWhole = 0.97;
constexpr double kEyeHeight = 1.65;
constexpr double kDegree = M_PI / 180;

Vector3<double> centre_of(const Rectangle& r) { return r.at(0.5 * r.width, 0.5 * r.height); }

double distance(const Quad<double>& a, const Quad<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += (a.corner[k] - b.corner[k]).norm();
  return sum / 4;
}

}  // namespace

Scene shapes_near(const City& city, const Vector3<double>& eye, std::vector<int>* signs) {
  Scene scene;
  for (const Rectangle& front : city.fronts)
    if ((centre_of(front) - eye).squaredNorm() < 4 * kFar * kFar && front.normal().dot(eye - front.corner) > 0)
      scene.add_unlit(front, Image<std::uint8_t>(1, 1));
  for (std::size_t i = 0; i < city.signs.size(); ++i) {
    const CitySign& sign = city.signs[i];
    const Vector3<double> to_eye = eye - centre_of(sign.text);
    if (to_eye.squaredNorm() > kFar * kFar || sign.text.normal().dot(to_eye) <= 0) continue;
    scene.add_sign(sign.word, sign.text);
    signs->push_back(static_cast<int>(i));
  }
  return scene;
}

SE3d random_view(const City& city, const CameraModel& camera, Random& random) {
  constexpr double kLeastPixels = 11;  // px
  while (true) {
    const CitySign& sign = city.signs[static_cast<std::size_t>(random.below(static_cast<int>(city.signs.size())))];
    const double d = random.uniform(3, 15), angle = random.uniform(-55, 55) * kDegree;
    const Vector3<double> at = centre_of(sign.text);
    Vector3<double> eye = at + d * (std::cos(angle) * sign.text.normal() + std::sin(angle) * sign.text.right);
    eye[2] = kEyeHeight + random.uniform(-0.2, 0.2);
    const double turn = 8 * kDegree * random.normal(), lift = 4 * kDegree * random.normal();
    const double roll = 2 * kDegree * random.normal();
    if (sign.text.height * camera.pinhole().fy / d < kLeastPixels || !city.is_street(eye[0], eye[1], 0.5)) continue;
    const Vector3<double> z = (at - eye).normalized();
    const Vector3<double> x = z.cross(Vector3<double>::UnitZ()).normalized();
    SE3d T_w_c;
    T_w_c.R << x, z.cross(x), z;
    T_w_c.R = T_w_c.R * textplane::so3_exp<double>({lift, turn, roll});
    T_w_c.t = eye;
    return textplane::renormalised(T_w_c);
  }
}

std::string misread(const std::string& word, double letters_wrong, Random& random) {
  std::string read;
  const auto any_letter = [&] { return static_cast<char>('A' + random.below(26)); };
  for (const char letter : word) {
    const bool wrong = random.chance(letters_wrong);
    const double how = random.uniform();
    const int step = 1 + random.below(25);
    if (!wrong) {
      read += letter;
    } else if (how < 0.9) {
      read += static_cast<char>('A' + (letter - 'A' + step) % 26);
    } else if (how < 0.95) {
      read += letter;
      read += any_letter();
    }
  }
  return read.empty() ? kUnreadText : read;
}

CityQuery make_query(const City& city, const CameraModel& camera, const SE3d& T_w_c, const CityReader& reader,
                     Random random) {
  CityQuery query;
  query.T_w_c = T_w_c;
  std::vector<int> near;
  const Scene scene = shapes_near(city, T_w_c.t, &near);
  const auto views = views_of_signs(scene, camera, T_w_c);
  DetectorErrors errors = reader.detector;
  errors.words_right = 1;
  query.detections = detect(views, scene.signs(), camera, errors, Random(random.word()));
  for (Detection& d : query.detections) {
    const SignView* shown = nullptr;
    for (const SignView& view : views)
      if (distance(view.quad, d.quad) < 8 * reader.detector.corner_sigma + 2 &&
          (!shown || distance(view.quad, d.quad) < distance(shown->quad, d.quad)))
        shown = &view;
    query.signs.push_back(shown ? near[static_cast<std::size_t>(shown->sign)] : -1);
    query.whole.push_back(shown && shown->visible >= kWhole);
    query.words.push_back(shown ? city.signs[static_cast<std::size_t>(query.signs.back())].word : "");
    const bool unread = random.chance(reader.unread);
    if (is_read(d.text)) d.text = unread ? kUnreadText : misread(d.text, reader.letters_wrong, random);
  }
  return query;
}

}  // namespace textslam
