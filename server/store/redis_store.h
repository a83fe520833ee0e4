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

/// Where a Redis server is.
struct RedisAddress {
  std::string host;  ///< empty: `path` is a Unix socket
  int port = 6379;
  std::string path;
  std::string user, password;
  int database = 0;
};

/// Reads "redis://[USER:PASSWORD@]HOST[:PORT][/DATABASE]", USER and PASSWORD percent-encoded, or "redis+unix:PATH";
/// nothing when it is neither.
[[nodiscard]] std::optional<RedisAddress> parse_redis_address(std::string_view text);

/// Keeps meshes in Redis, under "papilio:mesh:ID"; several servers share them. Every question has a bound of two
/// seconds, and so has each step of making a connection. A connection that is lost, or that leads to a server which
/// does not serve (a replica after a failover, say), is made anew, and the name of the host looked up again. While
/// Redis is away every question is answered with store_unavailable at once, but for one at a time that waits to find
/// out, a second after the last. A key whose value is not what it says is an absent mesh to `get`; `put` replaces it.
class RedisStore final : public MeshStore {
 public:
  /// `budget`: no mesh is added that would bring the memory Redis uses past it. `seconds`: a mesh that is not used for
  /// so long goes; 0: never.
  RedisStore(RedisAddress address, uint64_t budget, int seconds);
  ~RedisStore() override;
  RedisStore(const RedisStore&) = delete;
  RedisStore& operator=(const RedisStore&) = delete;

  bool put(const std::string& id, std::string_view bytes) override;
  bool contains(const std::string& id) override;
  Bytes get(const std::string& id) override;
  bool remove(const std::string& id) override;
  [[nodiscard]] std::string_view kind() const override { return "redis"; }
  [[nodiscard]] std::optional<Usage> usage() override { return std::nullopt; }  // not asked for at each scrape

 private:
  struct ContextDeleter {
    void operator()(redisContext* context) const;
  };
  struct ReplyDeleter {
    void operator()(redisReply* reply) const;
  };
  using Context = std::unique_ptr<redisContext, ContextDeleter>;
  using Reply = std::unique_ptr<redisReply, ReplyDeleter>;

  /// One question, with its words: one that may be asked twice. Where an idle connection turns out to be lost, or leads
  /// to the wrong server, it is asked once more on a new one. The reply may be an error.
  Reply ask(const std::vector<std::string_view>& words);
  [[nodiscard]] Context connect();
  [[nodiscard]] Context reach();  ///< connected, but not yet logged in; null or with an error when nobody is there
  [[nodiscard]] static Reply ask_on(redisContext& context, const std::vector<std::string_view>& words);
  [[nodiscard]] Context take_idle();
  void drop_idle();
  /// Takes note that Redis is away, and gives the words for it.
  [[nodiscard]] proto::Problem away(std::string_view reason);
  [[nodiscard]] uint64_t used_memory();
  /// The size of the key's value; 0 where there is none, or none of bytes.
  [[nodiscard]] uint64_t size_of(const std::string& key);

  const RedisAddress address_;
  const uint64_t budget_;
  const int seconds_;
  std::mutex mutex_;
  std::vector<Context> idle_;                         ///< guarded by mutex_
  bool is_away_ = false;                              ///< guarded by mutex_: it did not answer last time
  std::chrono::steady_clock::time_point away_until_;  ///< guarded by mutex_: not asked before
};

}  // namespace papilio::server
