#pragma once

#include "server/cache/lru.h"
#include "server/store/mesh_store.h"

namespace papilio::server {

/// Store of meshes in memory. Least recently used meshes are evicted beyond the budget.
class MemoryStore final : public MeshStore {
 public:
  explicit MemoryStore(uint64_t budget) : meshes_(budget) {}

  bool put(const std::string& id, std::string_view bytes) override;
  bool contains(const std::string& id) override { return meshes_.get(id) != nullptr; }
  Bytes get(const std::string& id) override { return meshes_.get(id); }
  bool remove(const std::string& id) override { return meshes_.remove(id); }
  [[nodiscard]] std::string_view kind() const override { return "memory"; }
  [[nodiscard]] std::optional<Usage> usage() override { return Usage{meshes_.size(), meshes_.bytes()}; }

 private:
  Lru<const std::string> meshes_;
};

}  // namespace papilio::server
