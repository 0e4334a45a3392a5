// A metric map as GeoJSON: its positions against formulas of their own, and its schema.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/text_file.hpp"
#include "map_file/map_file_support.hpp"
#include "textslam_map/export_geojson.hpp"

namespace textslam {
namespace geojson_test {

using namespace map_file_support;
using Json = nlohmann::json;

constexpr double kMillimetre = 1e-3, kA = 6378137, kB = 6356752.314245179;  // WGS84

// Metres per radian across and along the meridian (Helmert), times what they are at sea level.
double across(double lat) { return kA * kA / std::hypot(kA * std::cos(lat), kB * std::sin(lat)); }
double along(double lat) {
  return std::pow(kA * kB, 2) / std::pow(std::hypot(kA * std::cos(lat), kB * std::sin(lat)), 3);
}

// East, north and up of a position, in the frame whose first two axes span the origin's meridian.
Vec3 local(const GeoPosition& o, const GeoPosition& p) {
  const double lat = p.latitude * kDegree, lat0 = o.latitude * kDegree, turn = (p.longitude - o.longitude) * kDegree;
  const double r = (across(lat) + p.altitude) * std::cos(lat), r0 = (across(lat0) + o.altitude) * std::cos(lat0);
  const double flat = kB * kB / (kA * kA);
  const double out = r * std::cos(turn) - r0;
  const double high =
      (flat * across(lat) + p.altitude) * std::sin(lat) - (flat * across(lat0) + o.altitude) * std::sin(lat0);
  return {r * std::sin(turn), -std::sin(lat0) * out + std::cos(lat0) * high,
          std::cos(lat0) * out + std::sin(lat0) * high};
}

// East, north and up of a point of the map: z turned `north` degrees to the right of north, x to the right of z.
Vec3 of_map(double north, const Vec3& p) {
  const Eigen::Rotation2Dd left(-north * kDegree);
  const Vec2 ground = left * Vec2(p.x(), p.z());
  return {ground.x(), ground.y(), -p.y()};
}

TEST(GeoReference, PositionsComeBackToTheMillimetre) {
  const GeoPosition origins[] = {{48.1374, 11.5755, 519}, {-33.8568, 151.2153, 3}, {0, -179.9999, 0},
                                 {69.6, 18.9, -20},       {89.99, 12, 5},          {-89.999, -120, 2800}};
  for (const GeoPosition& origin : origins)
    for (const double north : {0.0, 37.5, -123.0, 270.0})
      for (const Vec3& p : {Vec3(0, 0, 0), Vec3(3, -2, 5), Vec3(-120, 4, 80), Vec3(700, -60, -800)}) {
        const GeoPosition found = geo_position({origin, north}, p);
        EXPECT_LT((local(origin, found) - of_map(north, p)).norm(), 1e-6) << origin.latitude << ", " << p.transpose();
      }
}

// Near the origin a degree has the length that the radii of curvature give it.
TEST(GeoReference, MetresAreThoseOfTheGround) {
  const GeoPosition origin{52.5, 13.4, 40};
  const GeoPosition north = geo_position({origin, 0}, {0, 0, 5}), east = geo_position({origin, 90}, {0, 0, 5});
  const double lat = origin.latitude * kDegree;
  EXPECT_NEAR((north.latitude - origin.latitude) * kDegree * (along(lat) + 40), 5, 1e-5);
  EXPECT_NEAR((north.longitude - origin.longitude) * kDegree, 0, 1e-12);
  EXPECT_NEAR((east.longitude - origin.longitude) * kDegree * (across(lat) + 40) * std::cos(lat), 5, 1e-5);
  EXPECT_NEAR(geo_position({origin, 12}, {0, -2, 0}).altitude, 42, 1e-6) << "up is -y";
  EXPECT_NEAR(geo_position({origin, 0}, {0, 0, 1000}).altitude - 40, 1e6 / (2 * along(lat)), 1e-3)
      << "a kilometre on, the ground lies below the plane";
}

TEST(GeoReference, DirectionsAreClockwiseFromNorth) {
  EXPECT_NEAR(azimuth({{}, 30}, {0, 0, 1}), 30, 1e-9);
  EXPECT_NEAR(azimuth({{}, 30}, {1, 0, 0}), 120, 1e-9);
  EXPECT_NEAR(azimuth({{}, 30}, {0, 0, -1}), 210, 1e-9);
  EXPECT_NEAR(azimuth({{}, -20}, {0, 0.5, 1}), 340, 1e-9);
  EXPECT_NEAR(elevation({{}, 70}, {0, -1, 1}), 45, 1e-9);
}

TEST(GeoReference, OriginsAreParsedStrictly) {
  GeoPosition p;
  EXPECT_TRUE(parse_geo_position("-33.5,151.25", &p));
  EXPECT_EQ(p.latitude, -33.5);
  EXPECT_EQ(p.longitude, 151.25);
  EXPECT_EQ(p.altitude, 0);
  EXPECT_TRUE(parse_geo_position("48, 11, 519.5", &p));
  EXPECT_EQ(p.altitude, 519.5);
  for (const char* wrong : {"", "48", "48,", "48,11,", "48,11,5,1", "nan,11", "91,0", "0,181", "48;11", "48,11,1e9"})
    EXPECT_FALSE(parse_geo_position(wrong, &p)) << wrong;
}

class GeoJsonTest : public MapFileTest {
 protected:
  GeoJsonTest() { record.scale_sigma = 0.004; }
  Json exported() {
    save();
    export_geojson(load(), file, reference, folder.path("map.geojson"));
    return Json::parse(read_file(folder.path("map.geojson")));
  }
  Vec3 place_of(const Json& position) const {
    EXPECT_EQ(position.size(), 3u);
    return local(reference.origin, {position.at(1), position.at(0), position.at(2)});
  }
  const GeoReference reference{{48.1374, 11.5755, 519}, 37.5};
};

TEST_F(GeoJsonTest, SignsLieWhereTheyAre) {
  const Json json = exported();
  EXPECT_EQ(json.at("type"), "FeatureCollection");
  EXPECT_EQ(json.at("georeference").at("scale_sigma"), 0.004);
  ASSERT_EQ(json.at("features").size(), 4u) << "three signs and a path";
  const char* const words[] = {"EXIT", "OPEN", "TAXI"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json &sign = json.at("features").at(i), &is = sign.at("properties");
    EXPECT_EQ(sign.at("type"), "Feature");
    EXPECT_EQ(sign.at("geometry").at("type"), "Point");
    EXPECT_LT((place_of(sign.at("geometry").at("coordinates")) - of_map(37.5, boards[i].T_w_b.t)).norm(), kMillimetre);
    EXPECT_EQ(is.at("kind"), "sign");
    EXPECT_EQ(is.at("id"), i);
    EXPECT_EQ(is.at("word"), words[i]);
    EXPECT_NEAR(is.at("width"), 2 * kHalfWidth, 1e-9);
    EXPECT_NEAR(is.at("height"), 2 * kHalfHeight, 1e-9);
    EXPECT_EQ(is.at("observations"), 2);
    EXPECT_EQ(is.at("session"), 1);
    EXPECT_GT(is.at("sigma_deg"), 0.05);
    EXPECT_LT(is.at("sigma_deg"), 2);
    const Vec3 normal = of_map(37.5, -boards[i].T_w_b.R.col(2));
    EXPECT_NEAR(is.at("azimuth"), std::fmod(std::atan2(normal.x(), normal.y()) / kDegree + 360, 360), 1e-6);
    EXPECT_NEAR(is.at("elevation"), std::asin(normal.z()) / kDegree, 1e-6);
    ASSERT_EQ(is.at("outline").size(), 4u);
    const double signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 corner = boards[i].T_w_b * Vec3(signs[k][0] * kHalfWidth, signs[k][1] * kHalfHeight, 0);
      EXPECT_LT((place_of(is.at("outline").at(k)) - of_map(37.5, corner)).norm(), kMillimetre);
    }
  }
}

TEST_F(GeoJsonTest, SessionsArePathsInTheOrderOfTime) {
  map.keyframe(0).frame.timestamp = 9;  // later than the other
  const Json json = exported(), path = json.at("features").at(3);
  EXPECT_EQ(path.at("geometry").at("type"), "LineString");
  EXPECT_EQ(path.at("properties").at("kind"), "path");
  EXPECT_EQ(path.at("properties").at("session"), 1);
  EXPECT_EQ(path.at("properties").at("started"), "2026-01-31 12:00:00");
  EXPECT_EQ(path.at("properties").at("timestamps"), (std::vector<double>{2.1, 9}));
  const Json& line = path.at("geometry").at("coordinates");
  ASSERT_EQ(line.size(), 2u);
  EXPECT_LT((place_of(line.at(0)) - of_map(37.5, map.keyframe(2).T_w_c.t)).norm(), kMillimetre);
  EXPECT_LT(place_of(line.at(1)).norm(), kMillimetre) << "the origin";
}

TEST_F(GeoJsonTest, ASessionOfOneKeyFrameIsAPoint) {
  record.sessions.push_back(record.sessions[0]);
  record.sessions[1].id = 2;
  record.sessions[1].sequence = "caf\xe9";  // no UTF-8
  record.sources[2].session = 2;
  const Json json = exported();
  ASSERT_EQ(json.at("features").size(), 5u);
  const Json& path = json.at("features").at(4);
  EXPECT_EQ(path.at("geometry").at("type"), "Point");
  EXPECT_EQ(path.at("properties").at("sequence"), "caf\xef\xbf\xbd");
  EXPECT_LT((place_of(path.at("geometry").at("coordinates")) - of_map(37.5, map.keyframe(2).T_w_c.t)).norm(),
            kMillimetre);
}

TEST_F(GeoJsonTest, AMapWithoutMetresIsRefused) {
  record.scale_sigma.reset();
  save();
  try {
    export_geojson(load(), file, reference, folder.path("map.geojson"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find(file + ": its lengths are not metres"), 0u) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path("map.geojson")));
}

}  // namespace geojson_test
}  // namespace textslam
