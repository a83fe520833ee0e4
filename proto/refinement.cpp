#include "proto/refinement.h"

#include <chrono>
#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "proto/draco_reader.h"
#include "proto/problem.h"

namespace papilio::proto {
namespace {

class Stopwatch {
 public:
  /// Milliseconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double milliseconds = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return milliseconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::string milliseconds_text(double milliseconds) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::fixed << std::setprecision(3) << milliseconds;
  return text.str();
}

/// Runs `work` and puts the core's refusals, and memory that is not there, into the words of the wire.
template <class Work>
auto in_words_of_the_wire(Work work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Problem(error);
  } catch (const std::bad_alloc&) {
    throw Problem(Code::result_too_large, "There is not enough memory for this result. Ask for fewer levels.");
  }
}

}  // namespace

Refinement::Refinement(std::string_view draco, const Parameters& parameters, const Limits& limits)
    : options_(parameters.options), output_(parameters.output) {
  Stopwatch watch;
  options_.face_limit = limits.max_output_faces;
  in_words_of_the_wire([&] {
    FormattedMesh input = read_draco(draco, limits);
    coarse_ = build_mesh(input);
    attributes_ = attribute_encoding(coarse_, std::move(input.format));
  });
  box_ = quantization_box(coarse_.positions);
  in_words_of_the_wire([&] { check_room(coarse_.topology.face_count(), options_); });
  times_.decode = watch.lap();
}

EncodedLevel Refinement::run(const RefinementHooks& hooks) {
  return in_words_of_the_wire([&] { return run_core(hooks); });
}

EncodedLevel Refinement::run_core(const RefinementHooks& hooks) {
  Stopwatch watch;
  EncodedLevel made;
  const auto encode = [&](const Mesh& mesh, int level) {
    times_.refine += watch.lap();
    made.draco = write_draco(mesh, box_, output_, attributes_);
    times_.encode += watch.lap();
    made.statistics.level = level;
    made.statistics.vertices = mesh.topology.vertex_count;
    made.statistics.faces = mesh.topology.face_count();
    made.statistics.times = times_;
  };

  Hooks core_hooks{.cancelled = hooks.cancelled};
  if (hooks.on_level) {
    core_hooks.on_level = [&](const Level& level) {
      if (level.last) return;  // it is sent with the reason why it is the last
      encode(level.mesh, level.level);
      hooks.on_level(made);
    };
  }
  const auto poll = [&] {
    if (hooks.cancelled && hooks.cancelled()) throw Problem(Code::cancelled, "The client went away.");
  };
  const Result result = refine(std::move(coarse_), options_, core_hooks);
  poll();
  made.statistics.stop_reason = result.stop_reason;
  encode(result.mesh, result.levels);
  poll();  // Draco's encoder cannot be stopped; who left meanwhile is not given an answer
  if (hooks.on_level) hooks.on_level(made);
  return made;
}

std::string_view stop_reason_name(StopReason reason) {
  return reason == StopReason::converged ? "converged" : "levels";
}

std::optional<StopReason> stop_reason_named(std::string_view name) {
  for (StopReason reason : {StopReason::converged, StopReason::levels})
    if (name == stop_reason_name(reason)) return reason;
  return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> statistics_headers(const Statistics& statistics) {
  std::vector<std::pair<std::string, std::string>> headers{
      {"Papilio-Vertices", std::to_string(statistics.vertices)},
      {"Papilio-Faces", std::to_string(statistics.faces)},
      {"Papilio-Levels", std::to_string(statistics.level)},
  };
  if (statistics.stop_reason) headers.emplace_back("Papilio-Stop-Reason", stop_reason_name(*statistics.stop_reason));
  headers.emplace_back("Server-Timing", "decode;dur=" + milliseconds_text(statistics.times.decode) +
                                            ", refine;dur=" + milliseconds_text(statistics.times.refine) +
                                            ", encode;dur=" + milliseconds_text(statistics.times.encode));
  return headers;
}

std::string statistics_json(const Statistics& statistics) {
  nlohmann::ordered_json document{
      {"vertices", statistics.vertices}, {"faces", statistics.faces}, {"levels", statistics.level}};
  if (statistics.stop_reason) document["stop_reason"] = stop_reason_name(*statistics.stop_reason);
  const auto rounded = [](double milliseconds) { return std::round(milliseconds * 1000) / 1000; };
  document["milliseconds"] = {{"decode", rounded(statistics.times.decode)},
                              {"refine", rounded(statistics.times.refine)},
                              {"encode", rounded(statistics.times.encode)}};
  return document.dump(2) + "\n";
}

}  // namespace papilio::proto
