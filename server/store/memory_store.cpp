#include "server/store/memory_store.h"

#include "proto/problem.h"

namespace papilio::server {

bool MemoryStore::put(const std::string& id, std::string_view bytes) {
  if (bytes.size() + Lru<const std::string>::entry_bytes > meshes_.budget())
    throw proto::Problem(proto::Code::store_full, "The mesh has " + std::to_string(bytes.size()) +
                                                      " bytes; the whole store has " +
                                                      std::to_string(meshes_.budget()) + ".");
  if (contains(id)) return false;
  return meshes_.put(id, std::make_shared<const std::string>(bytes), bytes.size());
}

}  // namespace papilio::server
