// City query: what a camera in a street sees, what a detector and a reader make of it, and the truth.
#ifndef TEXTSLAM_CITY_QUERY_HPP
#define TEXTSLAM_CITY_QUERY_HPP

#include <optional>
#include <vector>

#include "city/city.hpp"
#include "renderer/detector_model.hpp"

namespace textslam {

/// What a detector and a reader do wrong.
struct CityReader {
  DetectorErrors detector;     ///< words_right is not used
  double letters_wrong = 0.2;  ///< nine of ten read as another letter; the others dropped, or followed by one more
  double unread = 0.3;         ///< Share of the signs that are detected and not read.
};

struct CityQuery {
  SE3d T_w_c;
  std::vector<Detection> detections;
  std::vector<int> signs;          ///< of each detection: its number in the city, or -1 for a quad without a sign
  std::vector<bool> whole;         ///< of each detection: nothing hides the sign
  std::vector<std::string> words;  ///< of each detection: what the sign says
};

/// The part of a city that a camera at `eye` may see: fronts of houses, and signs. Nothing is painted.
Scene shapes_near(const City& city, const Vector3<double>& eye, std::vector<int>* signs);

/// A camera in a street that looks at some sign.
SE3d random_view(const City& city, const CameraModel& camera, Random& random);

/// What is detected there.
CityQuery make_query(const City& city, const CameraModel& camera, const SE3d& T_w_c, const CityReader& reader,
                     Random random);

/// The word with letters misread.
std::string misread(const std::string& word, double letters_wrong, Random& random);

}  // namespace textslam

#endif  // TEXTSLAM_CITY_QUERY_HPP
