// A stand-in for ROS 2's generated message: the members that docs/ros2.md uses. Setters return the message, as there.
#ifndef TESTS_ROS2_POSE_STAMPED_HPP
#define TESTS_ROS2_POSE_STAMPED_HPP

#include "sensor_msgs/msg/image.hpp"

namespace geometry_msgs::msg {

struct Point {
  double x = 0, y = 0, z = 0;
  Point& set__x(double value) { return x = value, *this; }
  Point& set__y(double value) { return y = value, *this; }
  Point& set__z(double value) { return z = value, *this; }
};

struct Quaternion {
  double x = 0, y = 0, z = 0, w = 1;
  Quaternion& set__x(double value) { return x = value, *this; }
  Quaternion& set__y(double value) { return y = value, *this; }
  Quaternion& set__z(double value) { return z = value, *this; }
  Quaternion& set__w(double value) { return w = value, *this; }
};

struct Pose {
  Point position;
  Quaternion orientation;
};

struct PoseStamped {
  std_msgs::msg::Header header;
  Pose pose;
};

}  // namespace geometry_msgs::msg

#endif  // TESTS_ROS2_POSE_STAMPED_HPP
