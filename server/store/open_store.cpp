#include <stdexcept>

#include "server/store/directory_store.h"
#include "server/store/memory_store.h"
#include "server/store/redis_store.h"

namespace papilio::server {

std::unique_ptr<MeshStore> open_store(const StoreOptions& options) {
  constexpr std::string_view directory = "directory:";
  const std::string& address = options.address;
  if (address == "memory") return std::make_unique<MemoryStore>(options.bytes);
  if (address.starts_with(directory) && address.size() > directory.size())
    return std::make_unique<DirectoryStore>(address.substr(directory.size()), options.bytes);
  if (const auto redis = parse_redis_address(address))
    return std::make_unique<RedisStore>(*redis, options.bytes, options.seconds);
  // The address is not repeated: it may contain a password.
  throw std::runtime_error(
      "--store (PAPILIO_STORE) takes memory, directory:PATH, redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE] (USER and "
      "PASSWORD percent-encoded) or redis+unix:PATH");
}

}  // namespace papilio::server
