#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <vector>

#include "proto/problem.h"
#include "server/store/mesh_store.h"

struct redisContext;
struct redisReply;

namespace papilio::server {

/// Address of a Redis server.
struct RedisAddress {
  std::string host;  ///< host; empty: `path` is a Unix socket
  int port = 6379;
  std::string path;
  std::string user, password;
  int database = 0;
};

/// Parses "redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE]", with USER and PASSWORD percent-encoded, or
/// "redis+unix:PATH". Returns nothing for other text.
[[nodiscard]] std::optional<RedisAddress> parse_redis_address(std::string_view text);

/// Store of meshes in Redis, under "papilio:mesh:ID", shared by several servers. Each command, and each step of a
/// connection, is bounded by two seconds. A connection that is lost, or that leads to an unsuitable server (such as a
/// replica after a failover), is replaced, and the host is resolved again.
///
/// While Redis is unavailable, commands fail at once with store_unavailable; one at a time waits for an answer, a
/// second after the last. A key whose value does not match is an absent mesh to get(); put() replaces it.
class RedisStore final : public MeshStore {
 public:
  /// Refuses meshes that would raise Redis's memory above `budget`. Meshes that are unused for `seconds` expire; 0:
  /// never.
  RedisStore(RedisAddress address, uint64_t budget, int seconds);
  ~RedisStore() override;
  RedisStore(const RedisStore&) = delete;
  RedisStore& operator=(const RedisStore&) = delete;

  bool put(const std::string& id, std::string_view bytes) override;
  bool contains(const std::string& id) override;
  Bytes get(const std::string& id) override;
  bool remove(const std::string& id) override;
  [[nodiscard]] std::string_view kind() const override { return "redis"; }
  [[nodiscard]] std::optional<Usage> usage() override { return std::nullopt; }  // too slow for each scrape

 private:
  struct ContextDeleter {
    void operator()(redisContext* context) const;
  };
  struct ReplyDeleter {
    void operator()(redisReply* reply) const;
  };
  using Context = std::unique_ptr<redisContext, ContextDeleter>;
  using Reply = std::unique_ptr<redisReply, ReplyDeleter>;

  /// Sends a command, which must be idempotent: if an idle connection is lost or leads to the wrong server, it is
  /// repeated on a new one. The reply may be an error.
  Reply ask(const std::vector<std::string_view>& words);
  [[nodiscard]] Context connect();
  [[nodiscard]] Context reach();  ///< connects, without a log-in; null or with an error if there is no server
  [[nodiscard]] static Reply ask_on(redisContext& context, const std::vector<std::string_view>& words);
  [[nodiscard]] Context take_idle();
  void drop_idle();
  /// Records that Redis is unavailable, and returns the problem.
  [[nodiscard]] proto::Problem away(std::string_view reason);
  [[nodiscard]] uint64_t used_memory();
  /// Returns the size of the key's value; 0 if it is absent or of another type.
  [[nodiscard]] uint64_t size_of(const std::string& key);

  const RedisAddress address_;
  const uint64_t budget_;
  const int seconds_;
  std::mutex mutex_;
  std::vector<Context> idle_;                         ///< idle connections, guarded by mutex_
  bool is_away_ = false;                              ///< whether the last command failed, guarded by mutex_
  std::chrono::steady_clock::time_point away_until_;  ///< time of the next attempt, guarded by mutex_
};

}  // namespace papilio::server
