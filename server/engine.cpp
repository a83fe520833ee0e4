#include "server/engine.h"

#include <algorithm>
#include <chrono>
#include <type_traits>

#include "proto/draco_header.h"
#include "proto/gltf/container.h"
#include "proto/gltf/scene_description.h"
#include "proto/problem.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;
using proto::gltf::SceneRefinement;
using proto::gltf::SharedScene;

namespace {

constexpr uint64_t face_count_bytes = 4ULL << 20;  ///< budget of about 10,000 counts

}  // namespace

Engine::Engine(const EngineOptions& options)
    : options_(options),
      admission_(options.slots, options.queue),
      store_(open_store(options.store)),
      results_(options.result_cache_bytes, options.slots + options.queue),
      meshes_(options.mesh_cache_bytes),
      face_counts_(face_count_bytes),
      are_scenes_(face_count_bytes),
      samples_(options.samples, options.limits),
      page_(options.web) {}

std::shared_ptr<Admission::Slot> Engine::enter(const Request& request, Work work,
                                               const std::function<bool()>& abandoned) {
  const auto begin = std::chrono::steady_clock::now();
  auto slot = admission_.enter(request.client(), work, abandoned);
  metrics_.observe_wait(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  return slot;
}

proto::RefinementHooks Engine::sharing(proto::RefinementHooks hooks, Admission::Slot& slot) const {
  hooks.cancelled = [abandoned = std::move(hooks.cancelled), &slot] {
    slot.take_turn(abandoned);
    return abandoned();
  };
  hooks.threads = 1 + std::max(0, options_.slots - admission_.computing());  // threads of its own slot and of free ones
  return hooks;
}

template <class AnyRefinement>
proto::EncodedLevel Engine::run_any(AnyRefinement& refinement, proto::RefinementHooks hooks, Admission::Slot& slot) {
  const uint64_t faces = refinement.coarse_faces();
  proto::EncodedLevel made = refinement.run(sharing(std::move(hooks), slot));
  metrics_.count_refinement(faces, made.statistics);
  return made;
}

proto::EncodedLevel Engine::run(proto::Refinement& refinement, proto::RefinementHooks hooks, Admission::Slot& slot) {
  return run_any(refinement, std::move(hooks), slot);
}

proto::EncodedLevel Engine::run(proto::gltf::SceneRefinement& refinement, proto::RefinementHooks hooks,
                                Admission::Slot& slot) {
  return run_any(refinement, std::move(hooks), slot);
}

Work Engine::work_of_scene(std::string_view glb, const Options& options) const {
  return predicted_work(proto::gltf::declared_faces(glb), options, options_.limits);
}

Work Engine::work_of(std::string_view draco, const Options& options) const {
  return predicted_work(proto::read_draco_header(draco, options_.limits).faces, options, options_.limits);
}

bool Engine::is_scene(const std::string& id) {
  std::shared_ptr<const bool> is_scene = are_scenes_.get(id);
  if (is_scene == nullptr) {
    is_scene = std::make_shared<bool>(proto::gltf::is_glb(*stored_bytes(id)));
    are_scenes_.put(id, is_scene, sizeof(bool));
  }
  return *is_scene;
}

Work Engine::work_of_stored(const std::string& id, const Options& options) {
  std::shared_ptr<const uint64_t> faces = face_counts_.get(id);
  if (faces == nullptr) {
    const MeshStore::Bytes bytes = stored_bytes(id);
    faces = std::make_shared<uint64_t>(proto::gltf::is_glb(*bytes)
                                           ? proto::gltf::declared_faces(*bytes)
                                           : proto::read_draco_header(*bytes, options_.limits).faces);
    face_counts_.put(id, faces, sizeof(uint64_t));
  }
  return predicted_work(*faces, options, options_.limits);
}

MeshStore::Bytes Engine::stored_bytes(const std::string& id) {
  MeshStore::Bytes bytes = store_->get(id);
  if (bytes == nullptr)
    throw Problem(Code::mesh_not_found, "No mesh is stored under this id. Send it to POST /v1/meshes.");
  return bytes;
}

std::unique_ptr<proto::Refinement> Engine::mesh_refinement_of(const std::string& id,
                                                              const proto::Parameters& parameters) {
  return std::make_unique<proto::Refinement>(decoded<proto::SharedMesh>(id), parameters, options_.limits);
}

std::unique_ptr<SceneRefinement> Engine::scene_refinement_of(const std::string& id,
                                                             const proto::Parameters& parameters) {
  if (!parameters.splits_instances)
    return std::make_unique<SceneRefinement>(decoded<SharedScene>(id), parameters, options_.limits);
  return std::make_unique<SceneRefinement>(stored_bytes(id), parameters, options_.limits);
}

template <class Shared>
std::shared_ptr<const Shared> Engine::decoded(const std::string& id) {
  const std::shared_ptr<const Decoded> known = meshes_.get(id);
  metrics_.count_lookup(Metrics::Cache::meshes, known != nullptr);
  if (known != nullptr) {
    count_again(id);
    return std::get<std::shared_ptr<const Shared>>(*known);
  }
  // One mesh may take a quarter of the cache, so that several large ones fit.
  const uint64_t budget = options_.mesh_cache_bytes / 4;
  std::shared_ptr<const Shared> made;
  if constexpr (std::is_same_v<Shared, SharedScene>)
    made = std::make_shared<const Shared>(stored_bytes(id), options_.limits, budget);
  else
    made = std::make_shared<const Shared>(*stored_bytes(id), options_.limits, budget);
  meshes_.put(id, std::make_shared<const Decoded>(made), made->bytes());
  return made;
}

void Engine::count_again(const std::string& id) {
  if (const auto known = meshes_.get(id))
    meshes_.put(id, known, std::visit([](const auto& shared) { return shared->bytes(); }, *known));
}

std::string Engine::metrics_text() {
  Gauges gauges{.slots = options_.slots,
                .computing = admission_.computing(),
                .waiting = admission_.waiting(),
                .result_cache_bytes = results_.bytes(),
                .mesh_cache_bytes = meshes_.bytes(),
                .held = held_()};
  if (const auto usage = store_->usage()) {
    gauges.store_meshes = usage->meshes;
    gauges.store_bytes = usage->bytes;
  }
  return metrics_.text(gauges);
}

}  // namespace papilio::server
