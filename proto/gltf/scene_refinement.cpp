#include "proto/gltf/scene_refinement.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "proto/error_translation.h"
#include "proto/freed_memory.h"
#include "proto/gltf/document_writer.h"
#include "proto/gltf/extension_lists.h"
#include "proto/gltf/geometry_writer.h"
#include "proto/gltf/mesh_grid.h"
#include "proto/gltf/mesh_options.h"
#include "proto/gltf/refined_geometry.h"
#include "proto/problem.h"
#include "proto/unreached.h"

namespace papilio::proto::gltf {
namespace {

using Clock = std::chrono::steady_clock;

/// Upper bound of the bytes of one request's prepared meshes.
constexpr uint64_t prepared_bytes = uint64_t{256} << 20;

/// Bytes of encoded meshes after which the heap is trimmed.
constexpr uint64_t held_between_trims = 8 * worth_giving_back;

/// Refinement of one mesh of the scene.
struct MeshRun {
  std::optional<Options> options{};  ///< options; nothing if the mesh is not refined
  MeshGrid grid{};
  std::shared_ptr<const PreparedMesh> prepared{};  ///< for repeated refinement; null if the scene is shared
};

/// Returns a lower bound of the faces of a refined mesh: all of the last level if refinement is uniform.
uint64_t least_faces(const SceneMesh& mesh, const std::optional<Options>& options) {
  const bool is_uniform = options && options->scheme == Scheme::red_green && options->levels > 0 &&
                          options->max_faces == 0 && !uses_hierarchy(*options);
  return is_uniform ? mesh.coarse_faces() << (2 * options->levels) : mesh.coarse_faces();
}

void require_supported(const Parameters& parameters) {
  if (parameters.options.simplify_hidden)
    throw Problem(Code::bad_parameter, "simplify_hidden is not supported for glTF scenes; leave it out.",
                  "simplify_hidden");
}

}  // namespace

class SceneRefinement::State {
 public:
  State(std::string_view bytes, const Parameters& parameters, const Limits& limits)
      : parameters_(parameters), limits_(limits) {
    require_supported(parameters);
    own_ = decode_scene(bytes, limits, parameters.splits_instances);
    prepare();
    times_.decode = lap();
  }
  State(std::shared_ptr<const SharedScene> shared, const Parameters& parameters, const Limits& limits)
      : parameters_(parameters), limits_(limits), shared_(std::move(shared)) {
    require_supported(parameters);
    prepare();
    (void)lap();
  }

  EncodedLevel run(const RefinementHooks& hooks) {
    hooks_ = &hooks;
    divide_budget();
    if (!hooks.on_level) return make(options_.levels);
    std::optional<EncodedLevel> latest;
    for (int level = 0; level < options_.levels; ++level) {
      EncodedLevel made = make(level);
      if (made.statistics.level < level) break;
      if (latest) hooks.on_level(*latest);
      latest = as_intermediate(std::move(made));
    }
    EncodedLevel last = make(options_.levels);
    if (latest && latest->statistics.level < last.statistics.level) hooks.on_level(*latest);
    hooks.on_level(last);
    return last;
  }

  [[nodiscard]] const DecodedScene& decoded() const { return shared_ ? shared_->decoded() : own_; }

 private:
  /// Returns the milliseconds since the last call.
  double lap() {
    const Clock::time_point now = Clock::now();
    const double milliseconds = std::chrono::duration<double, std::milli>(now - last_lap_).count();
    last_lap_ = now;
    return milliseconds;
  }

  [[nodiscard]] const std::vector<SceneMesh>& meshes() const { return decoded().scene.meshes; }

  void prepare() {
    options_ = options_for(parameters_, decoded().scene.box);
    options_.memory_limit = limits_.max_compute_bytes;
    adds_normals_ = parameters_.normals || std::ranges::any_of(meshes(), [](const SceneMesh& mesh) {
                      return has_detail_normals(mesh.surface.normals);
                    });
    options_.edges = adds_normals_;
    scene_diagonal_ = decoded().scene.box.diagonal();
    for (const SceneMesh& mesh : meshes()) {
      MeshRun& run = runs_.emplace_back();
      auto& options = run.options;
      options = options_of_mesh(options_, scene_diagonal_, mesh.placed());
      run.grid = choose_mesh_grid(mesh, decoded().document.json, parameters_, options);
      if (options) options->max_faces = 0;
    }
    coarse_faces_ = decoded().coarse_faces();
    is_compressed_ = parameters_.compression == Compression::same ? uses_compression(decoded().document.json)
                                                                  : parameters_.compression != Compression::none;
    require_room();
  }

  /// Throws `Problem` if the faces of all meshes are bound to exceed a limit.
  void require_room() {
    if (options_.max_faces > 0 && coarse_faces_ > options_.max_faces)
      throw Problem(Code::result_too_large, "The scene has " + std::to_string(coarse_faces_) +
                                                " faces, more than max_faces, which is " +
                                                std::to_string(options_.max_faces) + ". Raise max_faces.");
    uint64_t least = decoded().scene.unchanged_faces;
    for (size_t m = 0; m < runs_.size(); ++m) {
      auto& options = runs_[m].options;
      if (options) {
        options->face_limit = limits_.max_output_faces;
        options->output = output_bytes(meshes()[m], decoded().document.json["meshes"][meshes()[m].number]["primitives"],
                                       parameters_.compression);
        translate_errors([&] { check_room(meshes()[m].surface.mesh, *options); });
      }
      least += least_faces(meshes()[m], options);
    }
    if (least > limits_.max_output_faces)
      throw Problem(Code::result_too_large, "The refined scene would have at least " + std::to_string(least) +
                                                " faces; the limit is " + std::to_string(limits_.max_output_faces) +
                                                ". Request fewer levels, or send a coarser scene.");
  }

  void poll() {
    if (limits_.max_compute_seconds > 0 &&
        Clock::now() - begin_ - waited_ > std::chrono::seconds(limits_.max_compute_seconds))
      throw Problem(Code::takes_too_long, "The computation exceeds " + std::to_string(limits_.max_compute_seconds) +
                                              " seconds. Request fewer levels, or send a coarser scene.");
    if (!hooks_->cancelled) return;
    const auto asked = Clock::now();
    const bool is_cancelled = hooks_->cancelled();
    waited_ += Clock::now() - asked;
    if (is_cancelled) throw Problem(Code::cancelled, "The client closed the request.");
  }

  Hooks core_hooks() {
    return {.on_level = {},
            .cancelled =
                [this] {
                  poll();
                  return false;
                },
            .threads = hooks_->threads};
  }

  /// Refines a mesh, from its prepared mesh if it is refined several times.
  Result refine_mesh(size_t m, const Options& options) {
    const Mesh& coarse = meshes()[m].surface.mesh;
    const bool is_repeated = shared_ || hooks_->on_level || options_.max_faces > 0;
    if (!is_repeated || !uses_hierarchy(options)) return papilio::refine(coarse, options, core_hooks());
    if (shared_) return papilio::refine(*shared_->for_rules_of(m, options), options, core_hooks());
    if (!runs_[m].prepared) {
      const double share = static_cast<double>(meshes()[m].coarse_faces()) / static_cast<double>(coarse_faces_);
      runs_[m].prepared = std::make_shared<const PreparedMesh>(
          coarse, options, static_cast<uint64_t>(share * static_cast<double>(prepared_bytes)));
    }
    return papilio::refine(*runs_[m].prepared, options, core_hooks());
  }

  /// Returns the options of a mesh at a tolerance of the scene.
  [[nodiscard]] Options at_tolerance(size_t m, double tolerance) const {
    Options options = *runs_[m].options;
    if (tolerance > 0)
      options.tolerance = std::clamp(tolerance / (meshes()[m].scale() * meshes()[m].diagonal), options.tolerance, 1.0);
    return options;
  }

  /// Returns the faces of all meshes at a tolerance of the scene; beyond the budget, any number above it.
  uint64_t faces_at(double tolerance, std::vector<uint64_t>& faces) {
    uint64_t sum = decoded().scene.unchanged_faces;
    for (size_t m = 0; m < runs_.size(); ++m) {
      faces[m] = meshes()[m].coarse_faces();
      if (runs_[m].options) {
        Options options = at_tolerance(m, tolerance);
        options.max_faces = options_.max_faces;
        options.measure_error = false;
        const Result result = translate_errors([&] { return refine_mesh(m, options); });
        faces[m] =
            result.stop_reason == StopReason::budget ? options_.max_faces + 1 : result.mesh.topology.face_count();
      }
      sum += faces[m];
    }
    return sum;
  }

  /// Divides `max_faces` among the meshes: each gets the faces that it has at a common tolerance. The rest is left in
  /// `budget_left_` for the meshes in their order.
  void divide_budget() {
    if (options_.max_faces == 0) return;
    std::vector<uint64_t> faces(runs_.size());
    std::vector<uint64_t> best(runs_.size());
    uint64_t best_sum = coarse_faces_;
    for (size_t m = 0; m < best.size(); ++m) best[m] = meshes()[m].coarse_faces();
    if (std::ranges::count_if(runs_, [](const MeshRun& run) { return run.options.has_value(); }) > 1)
      (void)tolerance_within_budget(options_.max_faces, scene_diagonal_, [&](double tolerance) {
        const uint64_t sum = faces_at(tolerance, faces);
        if (sum <= options_.max_faces && sum >= best_sum) std::tie(best, best_sum) = std::pair(faces, sum);
        return sum;
      });
    budget_left_ = options_.max_faces - best_sum;
    for (size_t m = 0; m < best.size(); ++m)
      if (runs_[m].options) runs_[m].options->max_faces = best[m];
  }

  /// Scene under construction.
  struct Making {
    Statistics statistics{};
    std::vector<EncodedGeometry> replaced{};
    uint64_t budget_left = 0;       ///< unused faces of `max_faces`
    uint64_t remaining_coarse = 0;  ///< faces of meshes that are not refined yet
    uint64_t held_bytes = 0;        ///< bytes of encoded meshes
    uint64_t held_at_trim = 0;      ///< `held_bytes` when the heap was last trimmed
    ShapeReport shape{};
    GridShare grid{};  ///< of the mesh in which it is largest
  };

  /// Refines each mesh to at most `levels` levels, and writes the scene.
  EncodedLevel make(int levels) {
    Making making{.budget_left = budget_left_, .remaining_coarse = coarse_faces_ - decoded().scene.unchanged_faces};
    making.statistics.faces = decoded().scene.unchanged_faces;
    making.statistics.stop_reason = StopReason::converged;
    making.statistics.found = decoded().found();
    if (options_.view) making.statistics.error_pixels = 0;
    for (size_t m = 0; m < runs_.size(); ++m) add_mesh(m, levels, making);
    times_.refine += lap();
    make_room(making.held_bytes);
    EncodedLevel made{write(std::move(making.replaced)), std::move(making.statistics)};
    times_.encode += lap();
    made.statistics.times = times_;
    made.statistics.unreached = unreached_text(options_, made.statistics, making.grid);
    made.statistics.shape = shape_text(making.shape);
    return made;
  }

  /// Returns a level without the statistics of the last level.
  static EncodedLevel as_intermediate(EncodedLevel level) {
    level.statistics.stop_reason = std::nullopt;
    level.statistics.error_pixels = std::nullopt;
    level.statistics.unreached.clear();
    level.statistics.shape.clear();
    return level;
  }

  void add_mesh(size_t m, int levels, Making& making) {
    poll();
    const SceneMesh& mesh = meshes()[m];
    making.remaining_coarse -= mesh.coarse_faces();
    if (!runs_[m].options) {
      making.statistics.vertices += mesh.surface.mesh.topology.vertex_count;
      making.statistics.faces += mesh.coarse_faces();
      if (parameters_.compression != Compression::same) encode(unrefined_geometry(mesh), runs_[m].grid.output, making);
      return;
    }
    Result result = translate_errors([&] { return refine_mesh(m, options_within(m, levels, making)); });
    make_room(parting_bytes(mesh, result.mesh, is_compressed_));
    if (options_.max_faces > 0) making.budget_left -= result.mesh.topology.face_count();
    const bool is_new = result.levels > 0 || adds_normals_ || parameters_.compression != Compression::same;
    count_result(mesh, result, is_new ? runs_[m].grid : MeshGrid{}, making);
    if (!is_new) {
      if (is_made_once()) release(m);
      return;
    }
    NewGeometry refined = refined_geometry(mesh, std::move(result), adds_normals_, [this] { poll(); });
    if (is_made_once()) release(m);
    encode(std::move(refined), runs_[m].grid.output, making);
  }

  void encode(NewGeometry mesh, const OutputOptions& output, Making& making) {
    times_.refine += lap();
    making.replaced.push_back(
        encode_geometry(decoded().document, std::move(mesh), {parameters_.compression, output, [this] { poll(); }}));
    making.held_bytes += making.replaced.back().bytes();
    if (making.held_bytes - making.held_at_trim >= held_between_trims) {
      trim_heap();  // frees the gaps between held bytes
      making.held_at_trim = making.held_bytes;
    }
    times_.encode += lap();
  }

  /// Returns whether the scene is written only once, and not needed afterwards.
  [[nodiscard]] bool is_made_once() const { return !shared_ && !hooks_->on_level; }

  /// Returns the options of a mesh within the budget that earlier meshes have left.
  [[nodiscard]] Options options_within(size_t m, int levels, Making& making) const {
    Options options = *runs_[m].options;
    options.levels = std::min(options.levels, levels);
    if (options_.max_faces > 0) {
      options.max_faces += making.budget_left;
      making.budget_left = options.max_faces;
    }
    options.face_limit = limits_.max_output_faces -
                         std::min(limits_.max_output_faces, making.statistics.faces + making.remaining_coarse);
    if (options.memory_limit > 0) options.memory_limit -= std::min(options.memory_limit - 1, making.held_bytes);
    return options;
  }

  void count_result(const SceneMesh& mesh, const Result& result, const MeshGrid& grid, Making& making) const {
    Statistics& statistics = making.statistics;
    statistics.level = std::max(statistics.level, result.levels);
    statistics.vertices += result.mesh.topology.vertex_count;
    statistics.faces += result.mesh.topology.face_count();
    statistics.stop_reason = std::max(*statistics.stop_reason, result.stop_reason);
    if (scene_diagonal_ > 0) {
      const double share = mesh.diagonal * mesh.scale() / scene_diagonal_;
      statistics.error = std::max(statistics.error, (result.error + grid.error) * share);
      if (grid.error * share > making.grid.error) making.grid = {grid.error * share, grid.output.position_bits};
    }
    if (statistics.error_pixels) statistics.error_pixels = std::max(*statistics.error_pixels, result.error_pixels);
    making.shape.components += result.shape.components;
    making.shape.mechanical += result.shape.mechanical;
    making.shape.creases += result.shape.creases;
  }

  /// Frees a mesh that is no longer needed.
  void release(size_t m) {
    runs_[m].prepared.reset();
    own_.scene.meshes[m].geometry = {};
    own_.scene.meshes[m].surface = {};
  }

  std::string write(std::vector<EncodedGeometry> replaced) {
    Document document = decoded().document;
    BufferPieces pieces;
    if (!replaced.empty() || parameters_.compression != Compression::same)
      pieces = write_geometry(document, std::move(replaced), parameters_.compression);
    else if (decoded().is_packed)
      pieces = remove_detail(document);  // level 0 is the base
    else
      pieces = unchanged_pieces(document);
    poll();
    return write_document(document, std::move(pieces), FileKind::glb).document;
  }

  Clock::time_point begin_ = Clock::now(), last_lap_ = begin_;
  Clock::duration waited_{};  ///< time in `RefinementHooks::cancelled`
  Parameters parameters_;
  Limits limits_;
  std::shared_ptr<const SharedScene> shared_;  ///< shared scene; null if `own_` is used
  DecodedScene own_;
  std::vector<MeshRun> runs_;  ///< in the order of SceneMeshes::meshes
  Options options_;            ///< options of the scene
  double scene_diagonal_ = 0;
  uint64_t coarse_faces_ = 0;
  bool adds_normals_ = false;   ///< whether meshes without normals get them
  bool is_compressed_ = false;  ///< whether any new geometry may be compressed
  uint64_t budget_left_ = 0;    ///< faces of `max_faces` left at the common tolerance
  StageTimes times_;
  const RefinementHooks* hooks_ = nullptr;
};

SceneRefinement::SceneRefinement(std::string_view bytes, const Parameters& parameters, const Limits& limits)
    : state_(std::make_unique<State>(bytes, parameters, limits)) {}

SceneRefinement::SceneRefinement(std::shared_ptr<const std::string> bytes, const Parameters& parameters,
                                 const Limits& limits)
    : bytes_(std::move(bytes)), state_(std::make_unique<State>(*bytes_, parameters, limits)) {}

SceneRefinement::SceneRefinement(std::shared_ptr<const SharedScene> shared, const Parameters& parameters,
                                 const Limits& limits)
    : state_(std::make_unique<State>(std::move(shared), parameters, limits)) {}

SceneRefinement::~SceneRefinement() = default;

uint64_t SceneRefinement::coarse_faces() const { return state_->decoded().coarse_faces(); }

uint64_t SceneRefinement::coarse_vertices() const { return state_->decoded().coarse_vertices(); }

BuildReport SceneRefinement::found() const { return state_->decoded().found(); }

EncodedLevel SceneRefinement::run(const RefinementHooks& hooks) {
  return translate_errors([&] { return state_->run(hooks); });
}

}  // namespace papilio::proto::gltf
