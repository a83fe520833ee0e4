#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "proto/gltf/scene_refinement.h"
#include "proto/limits.h"
#include "proto/refinement.h"
#include "proto/shared_mesh.h"
#include "server/admission.h"
#include "server/cache/lru.h"
#include "server/cache/result_cache.h"
#include "server/http/http.h"
#include "server/metrics.h"
#include "server/page.h"
#include "server/samples/samples.h"
#include "server/store/mesh_store.h"
#include "server/work.h"

namespace papilio::server {

/// Sizes of the service's parts.
struct EngineOptions {
  proto::Limits limits;
  uint64_t max_body_bytes = 64u << 20;       ///< limit of bodies, for /v1/info; the HTTP server enforces it
  int slots = 0;                             ///< number of concurrent computations; 0: one per core
  int queue = 16;                            ///< upper bound of requests that wait for a slot
  StoreOptions store;                        ///
  uint64_t result_cache_bytes = 256u << 20;  ///< budget of cached results of stored meshes
  uint64_t mesh_cache_bytes = 512u << 20;    ///< budget of cached stored meshes, decoded and partly refined
  int cache_seconds = 86400;                 ///< max-age of results in caches of others
  std::string web;                           ///< folder of the viewer; empty: none
  std::string samples;                       ///< folder of further samples; empty: none
  bool keyed = false;  ///< whether keys are required, so that shared caches must not store answers
};

/// Shared state of the routes: admission, store and caches. Thread-safe.
class Engine {
 public:
  /// Opens store, samples and viewer. Throws std::runtime_error, with the setting's name, if one of them cannot be
  /// used.
  explicit Engine(const EngineOptions& options);

  [[nodiscard]] const EngineOptions& options() const { return options_; }
  [[nodiscard]] Admission& admission() { return admission_; }
  [[nodiscard]] MeshStore& store() { return *store_; }
  [[nodiscard]] ResultCache& results() { return results_; }
  [[nodiscard]] Metrics& metrics() { return metrics_; }
  [[nodiscard]] const Samples& samples() const { return samples_; }
  [[nodiscard]] const Page& page() const { return page_; }
  [[nodiscard]] const proto::Limits& limits() const { return options_.limits; }

  /// Waits for a slot for the request's client. Throws as Admission::enter().
  [[nodiscard]] std::shared_ptr<Admission::Slot> enter(const Request& request, Work work,
                                                       const std::function<bool()>& abandoned);
  /// Runs a refinement to its end, also on threads of free slots, and counts it. Yields to other requests between steps
  /// (`Slot::take_turn`). Throws `Problem`.
  [[nodiscard]] proto::EncodedLevel run(proto::Refinement& refinement, proto::RefinementHooks hooks,
                                        Admission::Slot& slot);
  /// Runs a refinement of a scene to its end, as `run` does for a mesh.
  [[nodiscard]] proto::EncodedLevel run(proto::gltf::SceneRefinement& refinement, proto::RefinementHooks hooks,
                                        Admission::Slot& slot);
  /// Predicts the work of refining a .glb scene, from the faces that its JSON declares. Throws `Problem`.
  [[nodiscard]] Work work_of_scene(std::string_view glb, const Options& options) const;
  /// Predicts the work of refining a mesh, from the faces that its Draco header declares. Throws `Problem` if the
  /// header is refused.
  [[nodiscard]] Work work_of(std::string_view draco, const Options& options) const;
  /// Returns whether a stored mesh is a scene. Throws `Problem` mesh_not_found.
  [[nodiscard]] bool is_scene(const std::string& id);
  /// Predicts the work of refining a stored mesh or scene. Throws `Problem`, including mesh_not_found.
  [[nodiscard]] Work work_of_stored(const std::string& id, const Options& options);
  /// Returns the refinement of a stored mesh, ready to run. Requires a slot. Throws `Problem`, including
  /// mesh_not_found.
  [[nodiscard]] std::unique_ptr<proto::Refinement> mesh_refinement_of(const std::string& id,
                                                                      const proto::Parameters& parameters);
  /// Returns the refinement of a stored scene, ready to run. Requires a slot. Throws `Problem`, including
  /// mesh_not_found.
  [[nodiscard]] std::unique_ptr<proto::gltf::SceneRefinement> scene_refinement_of(const std::string& id,
                                                                                  const proto::Parameters& parameters);
  /// Returns the bytes of a stored mesh or scene; never null. Throws `Problem` mesh_not_found.
  [[nodiscard]] MeshStore::Bytes stored_bytes(const std::string& id);
  /// Updates the cached size of a stored mesh or scene, which grows with each refinement.
  void count_again(const std::string& id);
  [[nodiscard]] std::string metrics_text();
  /// Sets the source of the metrics of the HTTP server's memory. Call before it runs.
  void observe_held_bytes(std::function<HeldBytes()> held) { held_ = std::move(held); }

 private:
  using Decoded =
      std::variant<std::shared_ptr<const proto::SharedMesh>, std::shared_ptr<const proto::gltf::SharedScene>>;
  /// Returns hooks with which a refinement yields to other requests, and uses the threads of free slots.
  [[nodiscard]] proto::RefinementHooks sharing(proto::RefinementHooks hooks, Admission::Slot& slot) const;
  template <class AnyRefinement>
  [[nodiscard]] proto::EncodedLevel run_any(AnyRefinement& refinement, proto::RefinementHooks hooks,
                                            Admission::Slot& slot);
  /// Returns a stored mesh or scene, decoded; `Shared` is its type.
  template <class Shared>
  [[nodiscard]] std::shared_ptr<const Shared> decoded(const std::string& id);

  const EngineOptions options_;
  Admission admission_;
  std::unique_ptr<MeshStore> store_;
  ResultCache results_;
  Lru<const Decoded> meshes_;
  Lru<const uint64_t> face_counts_;  ///< faces of stored meshes, to predict work without reading them
  Lru<const bool> are_scenes_;       ///< kinds of stored meshes, to avoid reading them
  Metrics metrics_;
  std::function<HeldBytes()> held_ = [] { return HeldBytes{}; };
  const Samples samples_;
  const Page page_;
};

}  // namespace papilio::server
