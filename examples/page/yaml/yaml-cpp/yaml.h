// The part of yaml-cpp that io/camera_formats uses, under its names, for a build that cannot have the library.
//
// Camera files are read: mappings and lists, by indentation or in brackets, quoted and plain scalars of one line, tags
// (passed over), comments, one document. Anything else of YAML is an Exception.
#ifndef TEXTSLAM_PAGE_YAML_H
#define TEXTSLAM_PAGE_YAML_H

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace YAML {

struct Mark {
  int line = -1;  ///< From 0.
  bool is_null() const { return line < 0; }
};

class Exception : public std::runtime_error {
 public:
  Exception(const Mark& at, const std::string& message) : std::runtime_error(message), mark(at), msg(message) {}
  Mark mark;
  std::string msg;
};

class Node {
 public:
  enum class Kind { undefined, null, scalar, sequence, map };
  struct Entry;  ///< Of a list a node, of a mapping a pair of nodes.

  Node() = default;
  Node(Kind kind, int line, std::string scalar = {});

  explicit operator bool() const { return kind() != Kind::undefined; }
  bool operator!() const { return kind() == Kind::undefined; }
  bool IsNull() const { return kind() == Kind::null; }
  bool IsScalar() const { return kind() == Kind::scalar; }
  bool IsSequence() const { return kind() == Kind::sequence; }
  bool IsMap() const { return kind() == Kind::map; }
  YAML::Mark Mark() const;
  const std::string& Scalar() const;
  std::size_t size() const;
  /// Undefined where there is none.
  Node operator[](const std::string& key) const;
  Node operator[](const char* key) const { return (*this)[std::string(key)]; }
  Node operator[](std::size_t index) const;
  Node operator[](int index) const { return (*this)[static_cast<std::size_t>(index)]; }
  const Entry* begin() const;
  const Entry* end() const;
  void add(const Node& value);
  void add(const Node& key, const Node& value);

 private:
  struct Data;
  Kind kind() const;
  std::shared_ptr<Data> data_;
};

struct Node::Entry : Node {
  explicit Entry(const Node& node) : Node(node) {}
  Entry(const Node& key, const Node& value) : first(key), second(value) {}
  Node first, second;
};

/// The document. Throws Exception.
Node Load(const std::string& text);

}  // namespace YAML

#endif  // TEXTSLAM_PAGE_YAML_H
