#include "yaml-cpp/yaml.h"

#include <string_view>

namespace YAML {

struct Node::Data {
  Kind kind = Kind::undefined;
  int line = -1;
  std::string scalar;
  std::vector<Entry> entries;
};

Node::Node(Kind kind, int line, std::string scalar) : data_(std::make_shared<Data>()) {
  data_->kind = kind;
  data_->line = line;
  data_->scalar = std::move(scalar);
}

Node::Kind Node::kind() const { return data_ ? data_->kind : Kind::undefined; }

YAML::Mark Node::Mark() const { return {data_ ? data_->line : -1}; }

const std::string& Node::Scalar() const {
  static const std::string none;
  return data_ ? data_->scalar : none;
}

std::size_t Node::size() const { return data_ ? data_->entries.size() : 0; }

Node Node::operator[](const std::string& key) const {
  if (IsMap())
    for (const Entry& entry : *this)
      if (entry.first.Scalar() == key) return entry.second;
  return {};
}

Node Node::operator[](std::size_t index) const {
  if (!IsSequence() || index >= size()) return {};
  return begin()[index];
}

const Node::Entry* Node::begin() const { return data_ ? data_->entries.data() : nullptr; }
const Node::Entry* Node::end() const { return data_ ? data_->entries.data() + size() : nullptr; }
void Node::add(const Node& value) { data_->entries.emplace_back(value); }
void Node::add(const Node& key, const Node& value) { data_->entries.emplace_back(key, value); }

namespace {

using Kind = Node::Kind;
constexpr int kDeepest = 50;

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Node document() {
    to_content();
    if (text_.substr(at_, 3) == "---") to_line_end();
    to_content();
    const Node root = block(0);
    to_content();
    if (at_ < text_.size() && text_.substr(at_, 3) != "...") refuse("a line that belongs to nothing");
    return root;
  }

 private:
  // Counts how deep nodes lie in each other.
  struct Depth {
    explicit Depth(Parser& parser) : parser_(parser) {
      if (++parser.depth_ > kDeepest) parser.refuse("too deep");
    }
    ~Depth() { --parser_.depth_; }
    Parser& parser_;
  };

  [[noreturn]] void refuse(const std::string& message) const { throw Exception({line_}, message); }
  // A line end beyond the end of the text.
  char here(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\n'; }
  bool ends(std::size_t ahead = 0) const { return here(ahead) == '\n' || here(ahead) == '\r'; }
  bool blank(std::size_t ahead = 0) const { return here(ahead) == ' ' || here(ahead) == '\t' || ends(ahead); }
  void step() {
    if (here() == '\n') {
      ++line_;
      begin_ = at_ + 1;
    }
    ++at_;
  }
  int column() const { return static_cast<int>(at_ - begin_); }
  void to_line_end() {
    while (at_ < text_.size() && here() != '\n') step();
  }
  // Over blanks and line ends, and comments.
  void to_content() {
    while (at_ < text_.size() && (blank() || here() == '#')) {
      if (here() == '#')
        to_line_end();
      else
        step();
    }
  }
  // Over blanks of this line; true where it has nothing more.
  bool line_is_over() {
    while (at_ < text_.size() && !ends() && blank()) step();
    return at_ >= text_.size() || ends() || here() == '#';
  }
  void end_line() {
    if (!line_is_over()) refuse("more than a value");
    to_line_end();
  }
  void pass_tag() {
    if (here() == '!')
      while (!blank()) step();
  }

  // What begins in this column or to the right of it; null where nothing does.
  Node block(int least) {
    const Depth depth(*this);
    to_content();
    if (at_ >= text_.size() || column() < least) return {Kind::null, line_};
    if (here() == '-' && blank(1)) return list(column());
    if (here() == '{' || here() == '[') {
      const Node out = flow();
      end_line();
      return out;
    }
    return mapping(column());
  }

  Node list(int indent) {
    Node out(Kind::sequence, line_);
    for (to_content(); at_ < text_.size() && column() == indent && here() == '-' && blank(1); to_content()) {
      step();
      out.add(line_is_over() ? block(indent + 1) : value(false));
    }
    return out;
  }

  Node mapping(int indent) {
    Node out(Kind::map, line_);
    for (to_content(); at_ < text_.size() && column() == indent && text_.substr(at_, 3) != "..."; to_content()) {
      const Node key = scalar(":");
      if (here() != ':') refuse("a key without ':'");
      step();
      line_is_over();
      pass_tag();
      if (!line_is_over()) {
        out.add(key, value(true));
        continue;
      }
      const int line = line_;
      to_content();
      const bool listed = at_ < text_.size() && column() == indent && here() == '-' && blank(1);
      out.add(key, listed || column() > indent ? block(indent) : Node(Kind::null, line));
    }
    if (at_ < text_.size() && column() > indent) refuse("a line that is indented more than the one before it");
    return out;
  }

  // On this line, after a dash or a key.
  Node value(bool of_key) {
    if (!of_key && here() != '{' && here() != '[') {
      const std::size_t end = text_.find('\n', at_), colon = text_.substr(0, end).find(": ", at_);
      if (colon != std::string_view::npos && here() != '"' && here() != '\'') return mapping(column());
    }
    const Node out = here() == '{' || here() == '[' ? flow() : scalar("");
    end_line();
    return out;
  }

  // In brackets, over lines.
  Node flow() {
    const Depth depth(*this);
    const bool is_map = here() == '{';
    const char close = is_map ? '}' : ']';
    Node out(is_map ? Kind::map : Kind::sequence, line_);
    step();
    for (to_content(); here() != close || at_ >= text_.size(); to_content()) {
      if (at_ >= text_.size()) refuse("a bracket that nothing closes");
      Node key;
      if (is_map) {
        key = scalar(":,}");
        to_content();
        if (here() != ':') refuse("a key without ':'");
        step();
        to_content();
        pass_tag();
        to_content();
      }
      const Node entry = here() == '{' || here() == '[' ? flow() : scalar(",]}");
      if (is_map)
        out.add(key, entry);
      else
        out.add(entry);
      to_content();
      if (here() == ',' && at_ < text_.size())
        step();
      else if (here() != close)
        refuse("',' is missing in a list");
    }
    step();
    return out;
  }

  // Quoted, or plain up to one of the characters `stop`, a comment or the end of the line.
  Node scalar(std::string_view stop) {
    const int line = line_;
    std::string out;
    if (here() == '"' || here() == '\'') {
      const char quote = here();
      for (step(); here() != quote || (quote == '\'' && here(1) == quote); step()) {
        if (at_ >= text_.size()) refuse("a quote that nothing closes");
        if (here() == quote || (quote == '"' && here() == '\\')) step();
        out += here();
      }
      step();
      while (!ends() && blank()) step();
      return {Kind::scalar, line, out};
    }
    if (here() == '&' || here() == '*' || here() == '|' || here() == '>') refuse("this part of YAML is not read here");
    while (!ends() && at_ < text_.size()) {
      const bool stops = stop.find(here()) != std::string_view::npos && (here() != ':' || blank(1));
      if (stops || (here() == '#' && !out.empty() && (out.back() == ' ' || out.back() == '\t'))) break;
      out += here();
      step();
    }
    while (!out.empty() && (out.back() == ' ' || out.back() == '\t')) out.pop_back();
    if (out.empty() || out == "~" || out == "null") return {Kind::null, line};
    return {Kind::scalar, line, out};
  }

  std::string_view text_;
  std::size_t at_ = 0, begin_ = 0;  // begin_: of the line
  int line_ = 0, depth_ = 0;
};

}  // namespace

Node Load(const std::string& text) { return Parser(text).document(); }

}  // namespace YAML
