// city_search: how well a place is found by its signs, in a city of any size.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "city/city_measure.hpp"
#include "cli/command_line.hpp"
#include "io/input_error.hpp"

namespace {

using namespace textslam;

struct Row {
  std::string name;
  std::vector<QueryResult> results;
};

double percent(const std::vector<QueryResult>& results, bool QueryResult::*what) {
  const auto count = std::count_if(results.begin(), results.end(), [&](const QueryResult& r) { return r.*what; });
  return results.empty() ? 0 : 100.0 * static_cast<double>(count) / static_cast<double>(results.size());
}

double of_sorted(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<std::size_t>(std::min(last, share * static_cast<double>(values.size())))];
}

void print(const Row& row) {
  std::vector<double> ms, errors;
  long wrong = 0;
  for (const QueryResult& r : row.results) {
    ms.push_back(1e3 * r.seconds);
    if (r.answered && r.first_right) errors.push_back(r.position_error);
    wrong += r.wrong ? 1 : 0;
  }
  std::printf("| %s | %zu | %.1f | %.1f | %.1f | %ld | %.1f | %.2f | %.1f | %.1f |\n", row.name.c_str(),
              row.results.size(), percent(row.results, &QueryResult::possible),
              percent(row.results, &QueryResult::first_right), percent(row.results, &QueryResult::answered), wrong,
              percent(row.results, &QueryResult::word_first), of_sorted(errors, 0.5), of_sorted(ms, 0.5),
              of_sorted(ms, 0.99));
  std::fflush(stdout);
}

int execute(int argc, char** argv) {
  CityOptions options;
  CityTrial trial;
  std::string detail;
  bool any_tilt = false;
  CLI::App app{"Finds places of a city by its signs, and prints how often it is right."};
  app.add_option("--signs", options.signs, "Signs of the city")->check(within(10, 1000000))->capture_default_str();
  app.add_option("--queries", trial.queries, "Queries of each kind")->check(within(1, 1000000))->capture_default_str();
  app.add_option("--seed", options.seed, "Of the city and of the queries")->capture_default_str();
  app.add_option("--threads", trial.threads, "That search")->check(within(1, 256))->capture_default_str();
  app.add_option("--probability", trial.search.least_probability, "From which on there is an answer")
      ->check(within(0.5, 0.9999999))
      ->capture_default_str();
  app.add_flag("--any-tilt", any_tilt, "Do not assume that the camera is held upright");
  app.add_option("--detail", detail, "File for one line a query: kind, probability, right, answered, ms");
  if (const auto code = parse_command_line(app, "city_search", argc, argv)) return *code;

  trial.seed = options.seed;
  if (!any_tilt) trial.search.upright = Upright();
  const City city = make_city(options);
  const City other = make_city({options.signs, options.seed + 1000});
  SignIndex index;
  const textplane::Status status = SignIndex::build(mapped_signs(city), {}, &index);
  if (!textplane::is_ok(status)) throw std::runtime_error(std::string("no index: ") + to_string(status));
  std::printf("%u signs, %u words, %.1f bytes a sign, %.0f %% with a word of their own\n\n", index.size(),
              index.words().size(), static_cast<double>(index.bytes()) / index.size(), 100 * index.unique_share());
  std::printf(
      "| query | queries | possible, %% | recall at one, %% | answered, %% | wrong answers | by the word alone, %% "
      "| median error, m | median, ms | 99 %%, ms |\n| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: "
      "| ---: | ---: |\n");
  std::FILE* file = detail.empty() ? nullptr : std::fopen(detail.c_str(), "w");
  if (!detail.empty() && !file) throw InputError(detail, 0, "cannot be written");
  const auto run = [&](const char* name, const City& shown, CityView view) {
    trial.view = view;
    const Row row{name, run_trial(shown, city, index, trial)};
    print(row);
    for (const QueryResult& r : row.results)
      if (file)
        std::fprintf(file, "%s,%.6f,%d,%d,%.3f\n", name, r.probability, r.first_right, r.answered, 1e3 * r.seconds);
  };
  run("three signs or more", city, CityView::three_signs);
  run("one sign, with a word of its own", city, CityView::one_sign);
  run("any view with a sign", city, CityView::any);
  run("three signs or more, of another city", other, CityView::three_signs);
  run("any view of another city", other, CityView::any);
  if (file && std::fclose(file) != 0) throw std::runtime_error(detail + ": cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return execute(argc, argv);
  } catch (const InputError& error) {
    std::fprintf(stderr, "city_search: %s\n", error.what());
    return kInputError;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "city_search: %s\n", error.what());
    return 1;
  }
}
