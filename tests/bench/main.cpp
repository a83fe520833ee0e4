#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/heap.h"
#include "tests/bench/pairs.h"
#include "tests/bench/report.h"

// papilio-bench [NAME] [--json FILE] [--only MODEL]...: the report NAME, or the rows whose names contain NAME; Google
// Benchmark measures the times in random order. --only chooses models of the report detail.

namespace papilio::bench {
namespace {

constexpr int repetitions = 9;

std::vector<Pair>& pairs() {
  static std::vector<Pair> all;
  return all;
}

std::vector<Report>& reports() {
  static std::vector<Report> all;
  return all;
}

struct Spread {
  double median = 0, low = 0, high = 0;
};

Spread spread_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {values[values.size() / 2], values.front(), values.back()};
}

/// Collects the time of each repetition by benchmark name.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[run.run_name.function_name].push_back(run.real_accumulated_time / static_cast<double>(run.iterations));
    std::cerr << '.' << std::flush;
  }
  /// Returns the nanoseconds divided by the divisor.
  [[nodiscard]] Spread of(const Pair& pair, const std::string& side) const {
    std::vector<double> values = times_.at(pair.name + side);
    for (double& value : values) value *= 1e9 / pair.divisor;
    return spread_of(values);
  }

 private:
  std::map<std::string, std::vector<double>> times_;
};

void run_side(const std::string& name, const std::function<double()>& work) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [work](benchmark::State& state) {
                                 for ([[maybe_unused]] auto iteration : state) state.SetIterationTime(work());
                               })
      ->UseManualTime()
      ->Repetitions(repetitions)
      ->MinTime(0.1);
}

int write_json(const nlohmann::ordered_json& rows, const std::string& file) {
  if (file.empty()) return 0;
  std::ofstream out(file);
  out << rows.dump(2) << '\n';
  out.close();
  if (!out) std::cerr << "papilio-bench: " << file << " cannot be written\n";
  return out ? 0 : 1;
}

int run_report(const Report& report, const std::string& json_file) {
  auto rows = nlohmann::ordered_json::array();
  for (const ReportRow& row : report.print()) {
    // Not finite when ours is 0: written as null.
    const double ratio = row.peer / row.ours;
    rows.push_back({{"name", row.name}, {"ours", row.ours}, {"peer", row.peer}, {"ratio", ratio}, {"unit", row.unit}});
  }
  return write_json(rows, json_file);
}

int list_names(const std::string& filter) {
  std::cerr << "no row has \"" << filter << "\" in its name; there are:\n";
  for (const Pair& pair : pairs()) std::cerr << "  " << pair.name << '\n';
  std::cerr << "and these reports:\n";
  for (const Report& report : reports()) std::cerr << "  " << report.name << '\n';
  return 2;
}

int run_pairs(const std::string& filter, const std::string& json_file) {
  std::vector<Pair> chosen;
  std::ranges::copy_if(pairs(), std::back_inserter(chosen),
                       [&](const Pair& pair) { return pair.name.find(filter) != std::string::npos; });
  if (chosen.empty()) return list_names(filter);
  for (const Pair& pair : chosen) {
    run_side(pair.name + "/ours", pair.ours);
    run_side(pair.name + "/peer", pair.peer);
  }
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);

  std::printf("\n%-44s %9s %19s %9s %19s %7s  %s\n", "median of 9, in turns", "ours", "(least .. most)", "peer",
              "(least .. most)", "ratio", "unit");
  auto rows = nlohmann::ordered_json::array();
  for (const Pair& pair : chosen) {
    const Spread ours = collector.of(pair, "/ours");
    const Spread peer = collector.of(pair, "/peer");
    const double ratio = peer.median / ours.median;
    std::printf("%-44s %9.2f (%7.2f ..%8.2f) %9.2f (%7.2f ..%8.2f) %6.2fx  %s\n", pair.name.c_str(), ours.median,
                ours.low, ours.high, peer.median, peer.low, peer.high, ratio, pair.unit.c_str());
    rows.push_back({{"name", pair.name},
                    {"ours", ours.median},
                    {"peer", peer.median},
                    {"ratio", ratio},
                    {"unit", pair.unit},
                    {"ours_spread", {ours.low, ours.high}},
                    {"peer_spread", {peer.low, peer.high}}});
  }
  return write_json(rows, json_file);
}

struct Arguments {
  std::string name, json_file;
  std::vector<std::string> only;
};

Arguments parse(int argc, char** argv) {
  Arguments found;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--json" && i + 1 < argc)
      found.json_file = argv[++i];
    else if (argument == "--only" && i + 1 < argc)
      found.only.emplace_back(argv[++i]);
    else
      found.name = argument;
  }
  return found;
}

int run(const Arguments& arguments) {
  const auto& [name, json_file, only] = arguments;
  add_table1();
  add_quality();
  add_picture();
  add_memory();
  add_wasm();
  add_detail(only);
  const auto report = std::ranges::find(reports(), name, &Report::name);
  if (report != reports().end()) return run_report(*report, json_file);
  add_uniform();
  add_adaptive();
  add_limits();
  add_threads();
  add_draco();
  add_service();
  add_view_change();
  add_http();
  add_scene();
  return run_pairs(name, json_file);
}

}  // namespace

void add(Pair pair) { pairs().push_back(std::move(pair)); }

void add(Report report) { reports().push_back(std::move(report)); }

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace papilio::bench

int main(int argc, char** argv) {
  papilio::server::set_up_heap(1);  // both sides use the server's heap
  std::vector<std::string> library_arguments{argv[0], "--benchmark_enable_random_interleaving=true"};
  std::vector<char*> pointers;
  for (std::string& argument : library_arguments) pointers.push_back(argument.data());
  int count = static_cast<int>(pointers.size());
  benchmark::Initialize(&count, pointers.data());
  try {
    return papilio::bench::run(papilio::bench::parse(argc, argv));
  } catch (const std::exception& error) {
    std::cerr << "papilio-bench: " << error.what() << '\n';
    return 1;
  }
}
