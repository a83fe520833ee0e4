#include "proto/gltf/scene_refinement.h"

#include <algorithm>
#include <chrono>
#include <tuple>
#include <utility>
#include <vector>

#include "proto/error_translation.h"
#include "proto/gltf/document_writer.h"
#include "proto/gltf/geometry_writer.h"
#include "proto/gltf/interpolation.h"
#include "proto/gltf/scene_mesh.h"
#include "proto/problem.h"
#include "proto/unreached.h"

namespace papilio::proto::gltf {
namespace {

using Clock = std::chrono::steady_clock;

/// Bytes that a prepared mesh may hold while a budget is divided.
constexpr uint64_t prepared_bytes = uint64_t{256} << 20;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

void add(BuildReport& sum, const BuildReport& more) {
  for (auto member : {&BuildReport::welded_points, &BuildReport::isolated_points, &BuildReport::degenerate_faces,
                      &BuildReport::repeated_faces, &BuildReport::boundary_edges, &BuildReport::non_manifold_edges,
                      &BuildReport::misoriented_edges, &BuildReport::pinched_vertices})
    sum.*member += more.*member;
}

/// Order in which a reason to stop tells more than another.
int rank_of(StopReason reason) {
  switch (reason) {
    case StopReason::converged:
      return 0;
    case StopReason::levels:
      return 1;
    case StopReason::budget:
      return 2;
    case StopReason::limits:
      break;
  }
  return 3;
}

uint64_t bytes_of_vertex(const VertexSet& set) {
  uint64_t bytes = 0;
  for (const VertexStream& stream : set.attributes) bytes += stream.elements.format.bytes();
  for (const auto& target : set.targets)
    for (const VertexStream& stream : target) bytes += stream.elements.format.bytes();
  return bytes;
}

/// Returns an upper bound of the memory for parting a refined mesh into primitives and writing them.
OutputBytes output_bytes(const SceneMesh& mesh) {
  constexpr uint64_t bytes_of_parting = 160;  // of a point: what points_of, its order and RefinedVertex take
  OutputBytes bytes{.face = 36, .point = bytes_of_parting};
  for (const VertexSet& set : mesh.geometry.sets)
    bytes.point = std::max(bytes.point, 2 * bytes_of_vertex(set) + bytes_of_parting);
  return bytes;
}

/// Returns how many faces a mesh will have at least: all of the last level, where the refinement is uniform.
uint64_t least_faces(const SceneMesh& mesh) {
  const bool is_uniform = mesh.options && mesh.options->scheme == Scheme::red_green && mesh.options->levels > 0 &&
                          mesh.options->max_faces == 0 && !uses_hierarchy(*mesh.options);
  return is_uniform ? mesh.coarse_faces() << (2 * mesh.options->levels) : mesh.coarse_faces();
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
      : parameters_(parameters), limits_(limits), document_(read_document(bytes)), views_(document_) {
    require_supported(parameters);
    scene_ = translate_errors([&] { return read_meshes(views_, limits); });
    options_ = options_for(parameters, scene_.box);
    options_.memory_limit = limits.max_compute_bytes;
    options_.edges = parameters.normals;
    scene_diagonal_ = scene_.box.diagonal();
    for (SceneMesh& mesh : scene_.meshes) {
      mesh.options = options_of_mesh(options_, scene_diagonal_, {mesh.surface.mesh, mesh.diagonal, mesh.maps});
      if (mesh.options) mesh.options->max_faces = 0;
    }
    require_room();
    times_.decode = milliseconds_since(begin_);
  }

  RefinedScene run(const RefinementHooks& hooks) {
    hooks_ = &hooks;
    divide_budget();
    std::vector<NewGeometry> replaced;
    Statistics statistics;
    add_unchanged(statistics);
    for (SceneMesh& mesh : scene_.meshes) {
      add(statistics.found, mesh.surface.found);
      refine_mesh(mesh, statistics, replaced);
    }
    times_.refine = milliseconds_since(begin_) - times_.decode;
    RefinedScene made{write(std::move(replaced))};
    times_.encode = milliseconds_since(begin_) - times_.decode - times_.refine;
    made.statistics = std::move(statistics);
    made.statistics.times = times_;
    made.statistics.unreached = unreached_text(options_, made.statistics);
    made.statistics.shape = shape_text(shape_);
    return made;
  }

  [[nodiscard]] const SceneMeshes& scene() const { return scene_; }

 private:
  [[nodiscard]] uint64_t coarse_faces() const {
    uint64_t faces = scene_.unchanged_faces;
    for (const SceneMesh& mesh : scene_.meshes) faces += mesh.coarse_faces();
    return faces;
  }

  /// Throws if the faces of all meshes are bound to exceed a limit.
  void require_room() {
    const uint64_t coarse = coarse_faces();
    if (options_.max_faces > 0 && coarse > options_.max_faces)
      throw Problem(Code::result_too_large, "The scene has " + std::to_string(coarse) +
                                                " faces, more than max_faces, which is " +
                                                std::to_string(options_.max_faces) + ". Raise max_faces.");
    uint64_t least = scene_.unchanged_faces;
    for (SceneMesh& mesh : scene_.meshes) {
      if (mesh.options) {
        mesh.options->face_limit = limits_.max_output_faces;
        mesh.options->output = output_bytes(mesh);
        translate_errors([&] { check_room(mesh.surface.mesh, *mesh.options); });
      }
      least += least_faces(mesh);
      remaining_coarse_ += mesh.coarse_faces();
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

  Result refine_prepared(SceneMesh& mesh, const Options& options) {
    if (!uses_hierarchy(options)) return papilio::refine(mesh.surface.mesh, options, core_hooks());
    if (!mesh.prepared)
      mesh.prepared = std::make_shared<const PreparedMesh>(mesh.surface.mesh, options, prepared_bytes);
    return papilio::refine(*mesh.prepared, options, core_hooks());
  }

  /// Returns the options of a mesh at a tolerance of the scene.
  static Options at_tolerance(const SceneMesh& mesh, double tolerance) {
    Options options = *mesh.options;
    if (tolerance <= 0) return options;
    double scale = 0;
    for (const auto& maps : mesh.maps)
      for (const Affine& map : maps) scale = std::max(scale, largest_scale(map));
    options.tolerance = std::clamp(tolerance / (scale * mesh.diagonal), options.tolerance, 1.0);
    return options;
  }

  /// Faces of all meshes at a tolerance of the scene; of a mesh beyond the budget, a number above it.
  uint64_t faces_at(double tolerance, std::vector<uint64_t>& faces) {
    uint64_t sum = scene_.unchanged_faces;
    for (size_t m = 0; m < scene_.meshes.size(); ++m) {
      SceneMesh& mesh = scene_.meshes[m];
      faces[m] = mesh.coarse_faces();
      if (mesh.options) {
        Options options = at_tolerance(mesh, tolerance);
        options.max_faces = options_.max_faces;
        options.measure_error = false;
        const Result result = translate_errors([&] { return refine_prepared(mesh, options); });
        faces[m] =
            result.stop_reason == StopReason::budget ? options_.max_faces + 1 : result.mesh.topology.face_count();
      }
      sum += faces[m];
    }
    return sum;
  }

  /// Gives each mesh its part of `max_faces`: what it takes at one tolerance for all, and of what is left as much as it
  /// can use, in their order.
  void divide_budget() {
    if (options_.max_faces == 0) return;
    std::vector<SceneMesh*> refined;
    for (SceneMesh& mesh : scene_.meshes)
      if (mesh.options) refined.push_back(&mesh);
    std::vector<uint64_t> faces(scene_.meshes.size());
    std::vector<uint64_t> best(scene_.meshes.size());
    uint64_t best_sum = coarse_faces();
    for (size_t m = 0; m < best.size(); ++m) best[m] = scene_.meshes[m].coarse_faces();
    if (refined.size() > 1)
      (void)tolerance_within_budget(options_.max_faces, scene_diagonal_, [&](double tolerance) {
        const uint64_t sum = faces_at(tolerance, faces);
        if (sum <= options_.max_faces && sum >= best_sum) std::tie(best, best_sum) = std::pair(faces, sum);
        return sum;
      });
    budget_left_ = options_.max_faces - best_sum;
    for (size_t m = 0; m < best.size(); ++m)
      if (scene_.meshes[m].options) scene_.meshes[m].options->max_faces = best[m];
  }

  void add_unchanged(Statistics& statistics) const {
    statistics.faces = scene_.unchanged_faces;
    statistics.stop_reason = StopReason::converged;
    if (options_.view) statistics.error_pixels = 0;
  }

  static void leave(const SceneMesh& mesh, Statistics& statistics) {
    statistics.vertices += mesh.surface.mesh.topology.vertex_count;
    statistics.faces += mesh.coarse_faces();
  }

  void refine_mesh(SceneMesh& mesh, Statistics& statistics, std::vector<NewGeometry>& replaced) {
    poll();
    remaining_coarse_ -= mesh.coarse_faces();
    if (!mesh.options) {
      leave(mesh, statistics);
      if (parameters_.compression == Compression::same) return;
      replaced.push_back({mesh.number, mesh.geometry, quantization_box(mesh.surface.mesh.positions)});
      return;
    }
    Options options = *mesh.options;
    if (options_.max_faces > 0) {
      options.max_faces += budget_left_;
      budget_left_ = options.max_faces;
    }
    options.face_limit =
        limits_.max_output_faces - std::min(limits_.max_output_faces, statistics.faces + remaining_coarse_);
    if (options.memory_limit > 0) options.memory_limit -= std::min(options.memory_limit - 1, held_bytes_);
    const Result result = translate_errors([&] {
      return mesh.prepared ? papilio::refine(*mesh.prepared, options, core_hooks())
                           : papilio::refine(mesh.surface.mesh, options, core_hooks());
    });
    mesh.prepared.reset();
    if (options_.max_faces > 0) budget_left_ -= result.mesh.topology.face_count();
    count_result(mesh, result, statistics);
    const bool is_new = result.levels > 0 || parameters_.normals || parameters_.compression != Compression::same;
    if (is_new) {
      replaced.push_back(new_geometry(mesh, result));
      for (const VertexSet& set : replaced.back().geometry.sets) held_bytes_ += set.count * bytes_of_vertex(set);
    }
    mesh.geometry = {};
    mesh.surface = {};
  }

  void count_result(const SceneMesh& mesh, const Result& result, Statistics& statistics) {
    statistics.level = std::max(statistics.level, result.levels);
    statistics.vertices += result.mesh.topology.vertex_count;
    statistics.faces += result.mesh.topology.face_count();
    if (rank_of(result.stop_reason) > rank_of(*statistics.stop_reason)) statistics.stop_reason = result.stop_reason;
    double scale = 0;
    for (const auto& maps : mesh.maps)
      for (const Affine& map : maps) scale = std::max(scale, largest_scale(map));
    if (scene_diagonal_ > 0)
      statistics.error = std::max(statistics.error, result.error * mesh.diagonal * scale / scene_diagonal_);
    if (statistics.error_pixels) statistics.error_pixels = std::max(*statistics.error_pixels, result.error_pixels);
    shape_.components += result.shape.components;
    shape_.mechanical += result.shape.mechanical;
    shape_.creases += result.shape.creases;
  }

  /// Returns the geometry of a refined mesh. Primitives that have lost all triangles are left out, and stay as they
  /// are.
  NewGeometry new_geometry(const SceneMesh& mesh, const Result& result) {
    Mesh refined = result.mesh;
    std::optional<size_t> normals;
    if (mesh.surface.has_normals) {
      normals = 1;
      if (result.levels > 0) renew_normals(refined, *normals);
    } else if (parameters_.normals) {
      normals = 1;
      add_normals(refined);
    }
    poll();
    const RefinedPrimitives parts = part_primitives(mesh.geometry, mesh.surface, refined, normals);
    NewGeometry made{mesh.number, {}, quantization_box(mesh.surface.mesh.positions)};
    for (size_t s = 0; s < mesh.geometry.sets.size(); ++s)
      made.geometry.sets.push_back(interpolate_vertices(mesh.geometry.sets[s], parts.sets[s], parameters_.normals));
    for (size_t p = 0; p < mesh.geometry.primitives.size(); ++p)
      if (!parts.triangles[p].empty())
        made.geometry.primitives.push_back(
            {mesh.geometry.primitives[p].number, mesh.geometry.primitives[p].set, parts.triangles[p]});
    return made;
  }

  std::string write(std::vector<NewGeometry> replaced) {
    const GeometryEncoding encoding{parameters_.compression, parameters_.output, [this] { poll(); }};
    BufferPieces pieces = replaced.empty() && parameters_.compression == Compression::same
                              ? unchanged_pieces(document_)
                              : write_geometry(document_, std::move(replaced), encoding);
    poll();
    return write_document(document_, std::move(pieces), FileKind::glb).document;
  }

  Clock::time_point begin_ = Clock::now();
  Clock::duration waited_{};  ///< time in `RefinementHooks::cancelled`
  Parameters parameters_;
  Limits limits_;
  Document document_;
  Views views_;
  SceneMeshes scene_;
  Options options_;  ///< for the scene
  double scene_diagonal_ = 0;
  uint64_t budget_left_ = 0;       ///< faces of `max_faces` that no mesh has yet
  uint64_t remaining_coarse_ = 0;  ///< faces of meshes that are not refined yet
  uint64_t held_bytes_ = 0;        ///< of refined meshes
  ShapeReport shape_;
  StageTimes times_;
  const RefinementHooks* hooks_ = nullptr;
};

SceneRefinement::SceneRefinement(std::string_view bytes, const Parameters& parameters, const Limits& limits)
    : state_(std::make_unique<State>(bytes, parameters, limits)) {}

SceneRefinement::~SceneRefinement() = default;

uint64_t SceneRefinement::coarse_faces() const {
  uint64_t faces = state_->scene().unchanged_faces;
  for (const SceneMesh& mesh : state_->scene().meshes) faces += mesh.coarse_faces();
  return faces;
}

uint64_t SceneRefinement::coarse_vertices() const {
  uint64_t vertices = 0;
  for (const SceneMesh& mesh : state_->scene().meshes) vertices += mesh.surface.mesh.topology.vertex_count;
  return vertices;
}

BuildReport SceneRefinement::found() const {
  BuildReport sum;
  for (const SceneMesh& mesh : state_->scene().meshes) add(sum, mesh.surface.found);
  return sum;
}

RefinedScene SceneRefinement::run(const RefinementHooks& hooks) {
  return translate_errors([&] { return state_->run(hooks); });
}

}  // namespace papilio::proto::gltf
