#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace papilio::server {

/// Where uploaded meshes are kept, each under the SHA-256 of its bytes. Any thread may use it. All of it throws
/// `Problem`: store_unavailable when the store does not answer; `put` also store_full.
class MeshStore {
 public:
  using Bytes = std::shared_ptr<const std::string>;

  virtual ~MeshStore() = default;
  /// Once this has returned the mesh is kept as well as the store can keep it. What is there already is verified, and
  /// replaced when it is damaged. True when the mesh was not there, or was damaged.
  virtual bool put(const std::string& id, std::string_view bytes) = 0;
  /// Counts as using it.
  virtual bool contains(const std::string& id) = 0;
  /// Null when there is none, or when it is damaged: the bytes have the SHA-256 that is asked for, always.
  virtual Bytes get(const std::string& id) = 0;
  /// True when it was there.
  virtual bool remove(const std::string& id) = 0;
  /// "memory", "directory" or "redis".
  [[nodiscard]] virtual std::string_view kind() const = 0;

  /// What it holds, where it knows.
  struct Usage {
    uint64_t meshes = 0, bytes = 0;
  };
  [[nodiscard]] virtual std::optional<Usage> usage() = 0;

 protected:
  MeshStore() = default;
  MeshStore(const MeshStore&) = default;
  MeshStore& operator=(const MeshStore&) = default;
};

/// How a store is set up.
struct StoreOptions {
  /// "memory", "directory:PATH", or "redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE]", or "redis+unix:PATH".
  std::string address = "memory";
  uint64_t bytes = 256u << 20;  ///< memory: what was used longest ago gives way; the others refuse more (store_full)
  int seconds = 0;              ///< Redis: meshes not used for so long go; 0: never
};

/// Throws std::runtime_error, in words for the operator, when the address cannot be understood or the directory not
/// be used. A Redis that does not answer is no error: it may come later.
[[nodiscard]] std::unique_ptr<MeshStore> open_store(const StoreOptions& options);

}  // namespace papilio::server
