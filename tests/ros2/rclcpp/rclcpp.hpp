// A stand-in for ROS 2's client library: what docs/ros2.md calls, with the same types, and nothing behind it.
#ifndef TESTS_ROS2_RCLCPP_HPP
#define TESTS_ROS2_RCLCPP_HPP

#include <memory>
#include <string>

namespace rclcpp {

template <class Message>
class Publisher {
 public:
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const Message&) {}
};

template <class Message>
class Subscription {
 public:
  using SharedPtr = std::shared_ptr<Subscription>;
};

class Node {
 public:
  explicit Node(const std::string&) {}
  template <class Message>
  typename Publisher<Message>::SharedPtr create_publisher(const std::string&, int) {
    return {};
  }
  template <class Message, class Callback>
  typename Subscription<Message>::SharedPtr create_subscription(const std::string&, int, Callback&& callback) {
    callback(std::make_shared<const Message>());
    return {};
  }
};

inline void init(int, char**) {}
inline void spin(const std::shared_ptr<Node>&) {}
inline void shutdown() {}

}  // namespace rclcpp

#endif  // TESTS_ROS2_RCLCPP_HPP
