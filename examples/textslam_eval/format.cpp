#include "textslam_eval/format.hpp"

#include <algorithm>
#include <locale>
#include <sstream>

#include "io/text_file.hpp"

namespace textslam {
namespace {

struct Field {
  std::string name;
  std::string value;  // empty: not known
};

// Six significant digits: more than the truth of any real sequence has, few enough to read.
std::string number(double value) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(6);
  out << value;
  return out.str();
}

class Fields {
 public:
  void add(const std::string& name, std::string value) { fields_.push_back({name, std::move(value)}); }
  void add(const std::string& name, const char* value) { add(name, std::string(value)); }
  void add(const std::string& name, double value, bool known) { add(name, known ? number(value) : std::string()); }
  void add(const std::string& name, std::size_t value) { add(name, std::to_string(value)); }
  void add_errors(const std::string& name, const ErrorStatistics& errors, bool known) {
    const bool any = known && errors.n > 0;
    add(name + "_rmse", errors.rmse, any);
    add_distribution(name, errors, any);
  }
  void add_distribution(const std::string& name, const ErrorStatistics& errors, bool known) {
    const bool any = known && errors.n > 0;
    add(name + "_median", errors.median, any);
    add(name + "_p90", errors.p90, any);
    add(name + "_max", errors.max, any);
  }
  std::vector<Field> take() { return std::move(fields_); }

 private:
  std::vector<Field> fields_;
};

std::vector<std::string> bin_names() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i + 1 < kAngleBins.size(); ++i) names.push_back("angle_to_" + number(kAngleBins[i]));
  names.push_back("angle_above_" + number(kAngleBins[kAngleBins.size() - 2]));
  return names;
}

std::vector<Field> fields_of(const RunEvaluation& run) {
  Fields out;
  const TrajectoryEvaluation& t = run.trajectory;
  const bool ok = textplane::is_ok(t.status), live = run.has_live && textplane::is_ok(run.live.status);
  out.add("run", run.run);
  out.add("status", textplane::to_string(t.status));
  out.add("frames", run.frames > 0 ? std::to_string(run.frames) : std::string());
  out.add("poses", run.poses);
  out.add("coverage", t.coverage, run.frames > 0);
  out.add("pairs", t.pairs);
  out.add("path_length", t.path_length, true);
  out.add("scale", t.alignment.scale, ok);
  out.add_errors("ate", t.ate, ok);
  out.add("ate_live_rmse", run.live.ate.rmse, live);
  out.add_errors("rpe_distance", t.rpe_distance.translation, ok);
  out.add_errors("rpe_distance_deg", t.rpe_distance.rotation, ok);
  out.add_errors("rpe_frame", t.rpe_frame.translation, ok);
  out.add_errors("rpe_frame_deg", t.rpe_frame.rotation, ok);

  const TextEvaluation& text = run.text;
  const auto count = [&](const char* name, int value) {
    out.add(name, text.available ? std::to_string(value) : std::string());
  };
  count("signs_visible", text.signs);
  count("signs_mapped", text.mapped);
  count("signs_clear", text.clear);
  count("signs_clear_mapped", text.clear_mapped);
  count("texts_matched", static_cast<int>(text.angle.n));
  count("texts_false", text.false_texts);
  count("words_right", run.words_right);
  out.add_distribution("angle_deg", text.angle, text.available);
  out.add_distribution("angle_over_sigma", text.angle_over_sigma, text.available);
  out.add_distribution("centre", text.centre, text.available);
  const auto histogram = angle_histogram(text);
  const std::vector<std::string> names = bin_names();
  for (std::size_t i = 0; i < names.size(); ++i) count(names[i].c_str(), histogram[i]);
  return out.take();
}

std::string quoted(const std::string& value) {
  if (value.find_first_of(",\"\n\r") == std::string::npos) return value;
  std::string out = "\"";
  for (const char c : value) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string shown_value(const Field& field) { return field.value.empty() ? "-" : field.value; }

std::string as_csv(const std::vector<std::vector<Field>>& runs) {
  std::string out;
  const auto row = [&](const std::vector<Field>& fields, std::string Field::*member) {
    for (std::size_t i = 0; i < fields.size(); ++i) out += (i > 0 ? "," : "") + quoted(fields[i].*member);
    out += '\n';
  };
  row(runs.front(), &Field::name);
  for (const auto& fields : runs) row(fields, &Field::value);
  return out;
}

// A row a number, a column a run: few runs, many numbers.
std::string as_markdown(const std::vector<std::vector<Field>>& runs) {
  const auto cell = [](const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
    return " " + out + " |";
  };
  std::string out;
  for (std::size_t i = 0; i < runs.front().size(); ++i) {
    out += "|" + cell(runs.front()[i].name);
    for (const auto& fields : runs) out += cell(shown_value(fields[i]));
    out += '\n';
    if (i > 0) continue;
    out += "| --- |";
    for (std::size_t k = 0; k < runs.size(); ++k) out += " ---: |";
    out += '\n';
  }
  return out;
}

std::string as_text(const std::vector<std::vector<Field>>& runs) {
  std::string out;
  for (const auto& fields : runs) {
    if (!out.empty()) out += '\n';
    out += fields.front().value + '\n';
    for (std::size_t i = 1; i < fields.size(); ++i)
      out += "  " + fields[i].name + std::string(26 - std::min<std::size_t>(25, fields[i].name.size()), ' ') +
             shown_value(fields[i]) + '\n';
  }
  return out;
}

}  // namespace

std::string format_evaluations(const std::vector<RunEvaluation>& runs, Format format) {
  if (runs.empty()) return "";
  std::vector<std::vector<Field>> fields;
  for (const RunEvaluation& run : runs) fields.push_back(fields_of(run));
  switch (format) {
    case Format::markdown: return as_markdown(fields);
    case Format::csv: return as_csv(fields);
    case Format::text: break;
  }
  return as_text(fields);
}

}  // namespace textslam
