#include "client/c/papilio.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "client/c/failure.h"
#include "papilio/prepared_mesh.h"
#include "papilio/refine.h"
#include "proto/parameters.h"
#include "proto/problem.h"
#include "proto/url.h"

using namespace papilio;  // the C functions have no namespace

namespace {

/// Memory limit of a level: half of the address space with 32-bit addresses, else none.
constexpr uint64_t memory_limit = sizeof(void*) == 4 ? uint64_t{2} << 30 : 0;
/// Upper bound of the bytes that a mesh keeps for its next view.
constexpr uint64_t kept_bytes = uint64_t{256} << 20;

/// Triangles, and their C description.
struct Arrays {
  TriangleMesh mesh;
  std::vector<papilio_attribute> attributes;
  papilio_triangles seen{};

  Arrays(TriangleMesh triangles, const std::vector<int32_t>& kinds) : mesh(std::move(triangles)) {
    for (size_t a = 0; a < mesh.attributes.size(); ++a)
      attributes.push_back({mesh.attributes[a].components, kinds[a], mesh.attributes[a].values.data()});
    seen = {.point_count = static_cast<uint32_t>(mesh.positions.size()),
            .face_count = static_cast<uint32_t>(mesh.triangles.size()),
            .attribute_count = static_cast<uint32_t>(attributes.size()),
            .positions = mesh.positions.empty() ? nullptr : &mesh.positions[0].x,
            .triangles = mesh.triangles.empty() ? nullptr : mesh.triangles[0].data(),
            .attributes = attributes.data()};
  }
};

thread_local c::Failure last_failure;

/// Runs `work`, which returns a pointer. Records an exception and returns null if it throws.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const proto::Problem& problem) {
    last_failure = c::failure_of(problem);
  } catch (const Error& error) {
    last_failure = c::failure_of(error);
  } catch (const std::bad_alloc&) {
    last_failure = c::lack_of_memory();
  } catch (const std::exception& error) {
    last_failure = c::failure_of(error);
  }
  return nullptr;
}

void require_attribute(const papilio_attribute& attribute) {
  const uint32_t components = attribute.components;
  const auto takes = [&](uint32_t count, const char* what) {
    if (components != count)
      throw proto::Problem(proto::Code::mesh_unusable, std::string(what) + " have " + std::to_string(count) +
                                                           " components, not " + std::to_string(components) + ".");
  };
  switch (attribute.kind) {
    case PAPILIO_VALUES:
      if (components == 0) takes(1, "Values");
      return;
    case PAPILIO_NORMALS:
      return takes(3, "Normals");
    case PAPILIO_SMOOTHING_GROUPS:
      return takes(1, "Smoothing groups");
    case PAPILIO_DISPLACEMENTS:
      return takes(3, "Displacements");
    default:
      throw proto::Problem(proto::Code::mesh_unusable,
                           "Unknown kind of attribute: " + std::to_string(attribute.kind) + ".");
  }
}

TriangleMesh copy_of(const papilio_triangles& from) {
  TriangleMesh to;
  to.positions = Buffer<Vec3f>::for_overwrite(from.point_count);
  if (from.point_count > 0) std::copy_n(from.positions, size_t{3} * from.point_count, &to.positions[0].x);
  to.triangles = Buffer<Triangle>::for_overwrite(from.face_count);
  if (from.face_count > 0) std::copy_n(from.triangles, size_t{3} * from.face_count, to.triangles[0].data());
  for (size_t a = 0; a < from.attribute_count; ++a) {
    const papilio_attribute& attribute = from.attributes[a];
    require_attribute(attribute);
    const size_t count = size_t{attribute.components} * from.point_count;
    to.attributes.push_back({.components = attribute.components,
                             .unit_length = attribute.kind == PAPILIO_NORMALS,
                             .values = {attribute.values, attribute.values + count},
                             .is_smoothing_group = attribute.kind == PAPILIO_SMOOTHING_GROUPS,
                             .is_displacement = attribute.kind == PAPILIO_DISPLACEMENTS});
  }
  return to;
}

}  // namespace

struct papilio_mesh {
  Mesh coarse;
  std::vector<int32_t> kinds;                      ///< [attributes]
  std::unique_ptr<const PreparedMesh> prepared{};  ///< mesh prepared for the rules of the last refinement that used it

  /// Returns a level, with recomputed normals if it has any.
  [[nodiscard]] Arrays arrays_of(Mesh level, bool is_coarse, bool adds_normals) const {
    std::vector<int32_t> all = kinds;
    for (size_t a = 0; a < kinds.size() && !is_coarse; ++a)
      if (kinds[a] == PAPILIO_NORMALS) renew_normals(level, a);
    if (adds_normals) {
      add_normals(level);
      all.push_back(PAPILIO_NORMALS);
    }
    return {std::move(level).triangles(), all};
  }

  Result refined(const Options& options, const Hooks& hooks) {
    if (!uses_hierarchy(options)) return refine(coarse, options, hooks);
    if (!prepared || !prepared->suits(options))
      prepared = std::make_unique<const PreparedMesh>(coarse, options, kept_bytes);
    return refine(*prepared, options, hooks);
  }
};

struct papilio_result {
  Arrays arrays;
  papilio_statistics statistics;
};

namespace {

/// Refines the mesh; throws on errors.
papilio_result* refined(papilio_mesh& mesh, std::string_view query, const papilio_hooks& hooks) {
  const proto::Parameters parameters = proto::parse_query(proto::split_query(query));
  Options options = proto::options_for(parameters, bounding_box(mesh.coarse.positions));
  const bool has_normals = std::find(mesh.kinds.begin(), mesh.kinds.end(), PAPILIO_NORMALS) != mesh.kinds.end();
  const bool adds_normals = parameters.normals && !has_normals;
  options.edges = adds_normals;  // normals are split at creases, which are edges
  options.memory_limit = memory_limit;
  check_room(mesh.coarse, options);

  Hooks core{.threads = std::max(hooks.threads, 1)};
  if (hooks.cancelled != nullptr) core.cancelled = [&] { return hooks.cancelled(hooks.user) != 0; };
  if (hooks.on_level != nullptr) {
    core.on_level = [&](const Level& level) {
      if (level.last) return;  // reported below, with its statistics
      const Arrays arrays = mesh.arrays_of(level.mesh, level.level == 0, adds_normals);
      papilio_statistics statistics{};
      statistics.level = level.level;
      hooks.on_level(hooks.user, &arrays.seen, &statistics);
    };
  }
  Result result = mesh.refined(options, core);
  auto made = std::make_unique<papilio_result>(
      papilio_result{.arrays = mesh.arrays_of(std::move(result.mesh), result.levels == 0, adds_normals),
                     .statistics = {.level = result.levels,
                                    .is_last = 1,
                                    .stop_reason = static_cast<int32_t>(result.stop_reason),
                                    .components = result.shape.components,
                                    .mechanical = result.shape.mechanical,
                                    .creases = result.shape.creases,
                                    .error = result.error,
                                    .error_pixels = result.error_pixels}});
  if (hooks.on_level != nullptr) hooks.on_level(hooks.user, &made->arrays.seen, &made->statistics);
  return made.release();
}

}  // namespace

extern "C" {

const char* papilio_version() { return PAPILIO_VERSION; }

papilio_mesh* papilio_mesh_create(const papilio_triangles* triangles) {
  return guarded([&] {
    auto mesh = std::make_unique<papilio_mesh>();
    for (size_t a = 0; a < triangles->attribute_count; ++a) mesh->kinds.push_back(triangles->attributes[a].kind);
    mesh->coarse = build_mesh(copy_of(*triangles), nullptr, rounding_gap);
    return mesh.release();
  });
}

void papilio_mesh_free(papilio_mesh* mesh) { delete mesh; }

papilio_result* papilio_refine(papilio_mesh* mesh, const char* parameters, const papilio_hooks* hooks) {
  return guarded([&] {
    return refined(*mesh, parameters == nullptr ? "" : parameters, hooks == nullptr ? papilio_hooks{} : *hooks);
  });
}

const papilio_triangles* papilio_result_mesh(const papilio_result* result) { return &result->arrays.seen; }

const papilio_statistics* papilio_result_statistics(const papilio_result* result) { return &result->statistics; }

void papilio_result_free(papilio_result* result) { delete result; }

papilio_fault papilio_last_fault() { return last_failure.fault; }

const char* papilio_last_message() { return last_failure.message.c_str(); }

const char* papilio_last_parameter() { return last_failure.parameter.c_str(); }
}
