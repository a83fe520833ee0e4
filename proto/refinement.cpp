#include "proto/refinement.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "proto/detail/find_packed.h"
#include "proto/encoding_memory.h"
#include "proto/error_translation.h"
#include "proto/findings.h"
#include "proto/problem.h"
#include "proto/text.h"
#include "proto/unreached.h"

namespace papilio::proto {
namespace {

class Stopwatch {
 public:
  /// Returns the milliseconds since the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double milliseconds = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return milliseconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Task on another thread, one at a time. Runs on the calling thread if the system provides no more threads.
class BackgroundTask {
 public:
  /// Starts the work; call after `wait`. The captures of the work are freed at its end.
  void start(std::function<void()> work) {
    const auto kept = std::make_shared<std::function<void()>>(std::move(work));
    const auto run = [this, kept] {
      const std::function<void()> only_here = std::exchange(*kept, nullptr);
      try {
        only_here();
      } catch (...) {
        has_failed_ = true;
        throw;
      }
    };
    try {
      running_ = std::async(std::launch::async, run);
    } catch (const std::system_error&) {
      run();
    }
  }
  /// Waits for the task, if any. Rethrows its exception.
  void wait() {
    if (running_.valid()) running_.get();
  }
  [[nodiscard]] bool has_failed() const { return has_failed_; }

 private:
  std::atomic<bool> has_failed_ = false;
  std::future<void> running_;  // last member: its destructor waits
};

std::string milliseconds_text(double milliseconds) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), milliseconds, std::chars_format::fixed, 3).ptr;
  return {text.data(), end};
}

}  // namespace

Refinement::Refinement(const Parameters& parameters, const Limits& limits)
    : tolerance_(parameters.options.tolerance),
      adds_normals_(parameters.normals),
      most_seconds_(limits.max_compute_seconds) {}

void Refinement::set_options(const Parameters& parameters, const Limits& limits) {
  if (parameters.compression != gltf::Compression::same)
    throw Problem(Code::bad_parameter, "output.compress is for glTF scenes; leave it out.", "output.compress");
  if (parameters.splits_instances)
    throw Problem(Code::bad_parameter, "split_instances is for glTF scenes; leave it out.", "split_instances");
  const Box box = bounding_box(coarse().mesh.positions);
  options_ = options_for(parameters, box);
  output_ = output_for(parameters, box);
  grid_error_ = box.diagonal() > 0 ? grid_distance(box, output_.position_bits) / box.diagonal() : 0;
  options_.tolerance = tolerance_beside_grid(tolerance_, grid_error_);
  detail::end_with_detail(options_, coarse().mesh);
  options_.face_limit = limits.max_output_faces;
  options_.memory_limit = limits.max_compute_bytes;
  encoding_ = coarse().attributes;
  adds_normals_ = adds_normals_ || has_detail_normals(coarse().normals);
  const auto& formats = encoding_.format.attributes;
  if (std::ranges::find(formats, AttributeKind::normal, &AttributeFormat::kind) != formats.end()) adds_normals_ = false;
  options_.output = encoding_bytes(coarse().mesh.attributes.attributes, adds_normals_, encoding_.format);
  options_.edges = adds_normals_;  // normals are split at creases, which are edges
  if (adds_normals_) {
    append_normals(encoding_.format);
    encoding_.grids.emplace_back();
  }
  translate_errors([&] { check_room(coarse().mesh, options_); });
}

Refinement::Refinement(std::string_view bytes, const Parameters& parameters, const Limits& limits)
    : Refinement(parameters, limits) {
  Stopwatch watch;
  decoded_ = decode_mesh(bytes, limits);
  set_options(parameters, limits);
  times_.decode = watch.lap();
}

Refinement::Refinement(std::shared_ptr<const SharedMesh> shared, const Parameters& parameters, const Limits& limits)
    : Refinement(parameters, limits) {
  shared_ = std::move(shared);
  set_options(parameters, limits);
}

EncodedLevel Refinement::run(const RefinementHooks& hooks) {
  return translate_errors([&] { return run_core(hooks); });
}

Result Refinement::refine_coarse(const Hooks& hooks) {
  if (!shared_) return refine(std::move(decoded_.mesh), options_, hooks);
  if (!uses_hierarchy(options_)) return refine(shared_->decoded().mesh, options_, hooks);
  return refine(*shared_->for_rules_of(options_), options_, hooks);
}

std::optional<Mesh> Refinement::with_normals(const Mesh& mesh, int level) const {
  std::optional<Mesh> dressed;
  if (adds_normals_ && !add_detail_normals(dressed.emplace(mesh), coarse().normals)) add_normals(*dressed);
  if (level == 0) return dressed;  // the coarse mesh keeps the author's normals
  for (size_t a = 0; a < mesh.attributes.attributes.size(); ++a) {
    if (!is_unit_normal(encoding_.format.attributes[a], mesh.attributes.attributes[a].components)) continue;
    if (!dressed) dressed = mesh;
    renew_normals(*dressed, a);
  }
  return dressed;
}

EncodedLevel Refinement::encode(const Mesh& mesh, int level, StageTimes times,
                                const std::function<void()>& poll) const {
  Stopwatch watch;
  EncodedLevel made;
  const std::optional<Mesh> dressed = with_normals(mesh, level);
  made.bytes = write_draco(dressed ? *dressed : mesh, coarse().box, output_, encoding_, poll);
  times.encode += watch.lap();
  made.statistics.level = level;
  made.statistics.vertices = mesh.topology.vertex_count;
  made.statistics.faces = mesh.topology.face_count();
  made.statistics.times = times;
  made.statistics.found = coarse().found;
  return made;
}

EncodedLevel Refinement::run_core(const RefinementHooks& hooks) {
  Stopwatch watch;
  StageTimes encoded;    // includes the last encoded level
  BackgroundTask aside;  // encodes a level while the next is refined
  std::mutex asking;     // serializes calls of `cancelled`
  const auto stop = [&] {
    require_time();
    const std::lock_guard lock(asking);
    if (aside.has_failed() || !hooks.cancelled) return aside.has_failed();
    const auto asked = std::chrono::steady_clock::now();
    const bool is_cancelled = hooks.cancelled();
    waited_ = waited_.load() + (std::chrono::steady_clock::now() - asked);
    return is_cancelled;
  };
  const auto poll = [&] {
    if (stop()) throw Problem(Code::cancelled, "The client closed the request.");
  };
  const bool encodes_aside = hooks.on_level && hooks.threads > 1;
  Hooks core_hooks{.cancelled = stop, .threads = encodes_aside ? hooks.threads - 1 : hooks.threads};
  if (hooks.on_level) {
    core_hooks.on_level = [&](const Level& level) {
      if (level.last) return;  // encoded below, with its stop reason
      times_.refine += watch.lap();
      aside.wait();
      times_.encode = encoded.encode;
      const auto hand_on = [&, number = level.level, times = times_](const Mesh& mesh) {
        const EncodedLevel made = encode(mesh, number, times, poll);
        encoded = made.statistics.times;
        hooks.on_level(made);
      };
      if (encodes_aside)
        aside.start([hand_on, mesh = level.mesh] { hand_on(mesh); });
      else
        hand_on(level.mesh);
      (void)watch.lap();
    };
  }
  const Result result = [&] {
    try {
      return refine_coarse(core_hooks);
    } catch (...) {
      aside.wait();  // its exception came first
      throw;
    }
  }();
  times_.refine += watch.lap();
  aside.wait();
  times_.encode = encoded.encode;
  poll();
  EncodedLevel made = encode(result.mesh, result.levels, times_, poll);
  made.statistics.stop_reason = result.stop_reason;
  made.statistics.error = result.error + grid_error_;
  if (options_.view) made.statistics.error_pixels = result.error_pixels;
  Options asked = options_;
  asked.tolerance = tolerance_;
  made.statistics.unreached = unreached_text(asked, made.statistics, {grid_error_, output_.position_bits});
  made.statistics.shape = shape_text(result.shape);
  if (hooks.on_level) hooks.on_level(made);
  return made;
}

void Refinement::require_time() const {
  if (most_seconds_ > 0 &&
      std::chrono::steady_clock::now() - begin_ - waited_.load() > std::chrono::seconds(most_seconds_))
    throw Problem(Code::takes_too_long, "The computation exceeds " + std::to_string(most_seconds_) +
                                            " seconds. Request fewer levels, or send a coarser mesh.");
}

namespace {

constexpr std::array<std::pair<StopReason, std::string_view>, 4> stop_reasons{{{StopReason::converged, "converged"},
                                                                               {StopReason::levels, "levels"},
                                                                               {StopReason::budget, "budget"},
                                                                               {StopReason::limits, "limits"}}};

}  // namespace

std::string_view stop_reason_name(StopReason reason) {
  return std::ranges::find(stop_reasons, reason, &std::pair<StopReason, std::string_view>::first)->second;
}

std::optional<StopReason> stop_reason_named(std::string_view name) {
  for (const auto& [reason, known] : stop_reasons)
    if (known == name) return reason;
  return std::nullopt;
}

std::string shape_text(const ShapeReport& shape) {
  const auto count = [](uint32_t number, const std::string& what) {
    return std::to_string(number) + " " + what + (number == 1 ? "" : "s");
  };
  const std::string marked =
      shape.marked == 0 ? "" : ", " + std::to_string(shape.marked) + " marked by smoothing groups";
  const std::string creases = (shape.creases == 0 ? "" : ", " + count(shape.creases, "crease")) + marked;
  if (shape.components == 0) return "plain" + marked;
  if (shape.mechanical == 0) return "organic: " + count(shape.components, "component") + creases;
  return "mechanical: " + std::to_string(shape.mechanical) + " of " + count(shape.components, "component") + creases;
}

std::vector<std::pair<std::string, std::string>> statistics_headers(const Statistics& statistics) {
  std::vector<std::pair<std::string, std::string>> headers{
      {"Papilio-Vertices", std::to_string(statistics.vertices)},
      {"Papilio-Faces", std::to_string(statistics.faces)},
      {"Papilio-Levels", std::to_string(statistics.level)},
  };
  if (statistics.stop_reason) {
    headers.emplace_back("Papilio-Stop-Reason", stop_reason_name(*statistics.stop_reason));
    headers.emplace_back("Papilio-Error", format_rounded(statistics.error));
    if (statistics.error_pixels) headers.emplace_back("Papilio-Error-Pixels", format_rounded(*statistics.error_pixels));
  }
  if (!statistics.unreached.empty()) headers.emplace_back("Papilio-Unreached", statistics.unreached);
  if (!statistics.shape.empty()) headers.emplace_back("Papilio-Shape", statistics.shape);
  if (const std::string found = defects_text(statistics.found); !found.empty())
    headers.emplace_back("Papilio-Found", found);
  headers.emplace_back("Server-Timing", "decode;dur=" + milliseconds_text(statistics.times.decode) +
                                            ", refine;dur=" + milliseconds_text(statistics.times.refine) +
                                            ", encode;dur=" + milliseconds_text(statistics.times.encode));
  return headers;
}

std::string statistics_json(const Statistics& statistics) {
  nlohmann::ordered_json document{
      {"vertices", statistics.vertices}, {"faces", statistics.faces}, {"levels", statistics.level}};
  if (statistics.stop_reason) {
    document["stop_reason"] = stop_reason_name(*statistics.stop_reason);
    document["error"] = parse_number(format_rounded(statistics.error)).value();
    if (statistics.error_pixels)
      document["error_pixels"] = parse_number(format_rounded(*statistics.error_pixels)).value();
  }
  if (!statistics.unreached.empty()) document["unreached"] = statistics.unreached;
  if (!statistics.shape.empty()) document["shape"] = statistics.shape;
  for (const auto& [name, count] : defects(statistics.found)) document["found"][std::string(name)] = count;
  const auto rounded = [](double milliseconds) { return std::round(milliseconds * 1000) / 1000; };
  document["milliseconds"] = {{"decode", rounded(statistics.times.decode)},
                              {"refine", rounded(statistics.times.refine)},
                              {"encode", rounded(statistics.times.encode)}};
  return document.dump(2) + "\n";
}

}  // namespace papilio::proto
