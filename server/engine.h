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

/// How the service's parts are sized.
struct EngineOptions {
  proto::Limits limits;
  uint64_t max_body_bytes = 64u << 20;       ///< told in /v1/info; the HTTP server holds to it
  int slots = 0;                             ///< requests computed at once; 0: one a core
  int queue = 16;                            ///< requests that may wait for a slot
  StoreOptions store;                        ///
  uint64_t result_cache_bytes = 256u << 20;  ///< results of stored meshes
  uint64_t mesh_cache_bytes = 512u << 20;    ///< stored meshes, decoded and partly refined
  int cache_seconds = 86400;                 ///< how long others may cache a result
  std::string web;                           ///< folder of the viewer; empty: none
  std::string samples;                       ///< folder of further samples; empty: none
  bool keyed = false;                        ///< keys are asked for, so that nobody else may keep what is answered
};

/// What the routes share: the work and what it is kept in. Threads may share it.
class Engine {
 public:
  /// Throws std::runtime_error, naming the setting, where the store, a sample or the viewer cannot be used.
  explicit Engine(const EngineOptions& options);

  [[nodiscard]] const EngineOptions& options() const { return options_; }
  [[nodiscard]] Admission& admission() { return admission_; }
  [[nodiscard]] MeshStore& store() { return *store_; }
  [[nodiscard]] ResultCache& results() { return results_; }
  [[nodiscard]] Metrics& metrics() { return metrics_; }
  [[nodiscard]] const Samples& samples() const { return samples_; }
  [[nodiscard]] const Page& page() const { return page_; }
  [[nodiscard]] const proto::Limits& limits() const { return options_.limits; }

  /// Waits for a slot for the request's client; throws as `Admission::enter`.
  [[nodiscard]] std::shared_ptr<Admission::Slot> enter(const Request& request, Work work,
                                                       const std::function<bool()>& abandoned);
  /// Runs a refinement to its end, on the threads of free slots too, and counts it. Between steps it takes turns with
  /// other requests (`Slot::take_turn`). Throws `Problem`.
  [[nodiscard]] proto::EncodedLevel run(proto::Refinement& refinement, proto::RefinementHooks hooks,
                                        Admission::Slot& slot);
  /// The same for a scene.
  [[nodiscard]] proto::EncodedLevel run(proto::gltf::SceneRefinement& refinement, proto::RefinementHooks hooks,
                                        Admission::Slot& slot);
  /// Work of refining a .glb scene that has the faces which its JSON declares. Throws `Problem`.
  [[nodiscard]] Work work_of_scene(std::string_view glb, const Options& options) const;
  /// Work of refining a mesh that has the faces which the Draco stream declares. Throws `Problem` where the stream is
  /// refused by its header.
  [[nodiscard]] Work work_of(std::string_view draco, const Options& options) const;
  /// Whether a stored mesh is a scene. Throws `Problem` mesh_not_found.
  [[nodiscard]] bool is_scene(const std::string& id);
  /// Work of refining a stored mesh or scene. Throws `Problem`, mesh_not_found too.
  [[nodiscard]] Work work_of_stored(const std::string& id, const Options& options);
  /// The refinement of a stored mesh, ready to run; to be called with a slot. Throws `Problem`, mesh_not_found too.
  [[nodiscard]] std::unique_ptr<proto::Refinement> mesh_refinement_of(const std::string& id,
                                                                      const proto::Parameters& parameters);
  /// The same of a stored scene.
  [[nodiscard]] std::unique_ptr<proto::gltf::SceneRefinement> scene_refinement_of(const std::string& id,
                                                                                  const proto::Parameters& parameters);
  /// The bytes of a stored mesh or scene; never null. Throws `Problem` mesh_not_found.
  [[nodiscard]] MeshStore::Bytes stored_bytes(const std::string& id);
  /// A stored mesh or scene that has been refined takes more memory than before.
  void count_again(const std::string& id);
  [[nodiscard]] std::string metrics_text();
  /// What metrics say of the memory that the HTTP server holds. To be called before it runs.
  void observe_held_bytes(std::function<HeldBytes()> held) { held_ = std::move(held); }

 private:
  using Decoded =
      std::variant<std::shared_ptr<const proto::SharedMesh>, std::shared_ptr<const proto::gltf::SharedScene>>;
  /// Lets a refinement take turns with other requests, and use the threads of free slots.
  [[nodiscard]] proto::RefinementHooks sharing(proto::RefinementHooks hooks, Admission::Slot& slot) const;
  template <class AnyRefinement>
  [[nodiscard]] proto::EncodedLevel run_any(AnyRefinement& refinement, proto::RefinementHooks hooks,
                                            Admission::Slot& slot);
  /// A stored mesh or scene, decoded; `Shared` is its kind.
  template <class Shared>
  [[nodiscard]] std::shared_ptr<const Shared> decoded(const std::string& id);

  const EngineOptions options_;
  Admission admission_;
  std::unique_ptr<MeshStore> store_;
  ResultCache results_;
  Lru<const Decoded> meshes_;
  Lru<const uint64_t> face_counts_;  ///< of stored meshes, so that work is predicted without reading one
  Lru<const bool> are_scenes_;       ///< whether stored meshes are scenes, likewise
  Metrics metrics_;
  std::function<HeldBytes()> held_ = [] { return HeldBytes{}; };
  const Samples samples_;
  const Page page_;
};

}  // namespace papilio::server
