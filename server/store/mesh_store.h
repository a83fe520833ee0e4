#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace papilio::server {

/// Store of uploaded meshes, each under the SHA-256 of its bytes. Thread-safe. All functions throw `Problem`:
/// store_unavailable if the store does not answer; put() also store_full.
class MeshStore {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  virtual ~MeshStore() = default;
  /// Stores a mesh; on return, it is as durable as the store permits. Verifies a present mesh, and replaces it if
  /// damaged. Returns true if the mesh was absent or damaged.
  virtual bool put(const std::string& id, std::string_view bytes) = 0;
  /// Returns whether a mesh is present. Counts as a use.
  virtual bool contains(const std::string& id) = 0;
  /// Returns the bytes of a mesh, whose SHA-256 is verified; null if it is absent or damaged.
  virtual Bytes get(const std::string& id) = 0;
  /// Removes a mesh. Returns whether it was present.
  virtual bool remove(const std::string& id) = 0;
  /// Returns "memory", "directory" or "redis".
  [[nodiscard]] virtual std::string_view kind() const = 0;

  /// Contents of the store, if known.
  struct Usage {
    uint64_t meshes = 0, bytes = 0;
  };
  [[nodiscard]] virtual std::optional<Usage> usage() = 0;

 protected:
  MeshStore() = default;
  MeshStore(const MeshStore&) = default;
  MeshStore& operator=(const MeshStore&) = default;
};

/// Options of a store.
struct StoreOptions {
  /// Address: "memory", "directory:PATH", "redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE]" or "redis+unix:PATH".
  std::string address = "memory";
  uint64_t bytes = 256u << 20;  ///< budget; beyond it, memory evicts least recently used meshes, and others refuse
  int seconds = 0;              ///< Redis: time after which unused meshes expire; 0: never
};

/// Opens a store. Throws std::runtime_error, with a message for the operator, for an invalid address or an unusable
/// directory. A Redis that does not answer is no error: it may start later.
[[nodiscard]] std::unique_ptr<MeshStore> open_store(const StoreOptions& options);

}  // namespace papilio::server
