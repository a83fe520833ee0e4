#include "server/store/redis_store.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "proto/problem.h"
#include "server/sha256.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;
using Replies = std::vector<std::string>;

/// A server that sends scripted replies, one per command, over successive connections. The next connection is accepted
/// once the client has closed the one before.
class ScriptedRedis {
 public:
  explicit ScriptedRedis(std::vector<Replies> script) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(fd_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(fd_, 64), 0);
    EXPECT_EQ(::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, script = std::move(script)] {
      for (const Replies& replies : script) serve(replies);
    });
  }
  ~ScriptedRedis() {
    ::shutdown(fd_, SHUT_RDWR);  // unblocks accept
    thread_.join();
    ::close(fd_);
  }
  ScriptedRedis(const ScriptedRedis&) = delete;
  ScriptedRedis& operator=(const ScriptedRedis&) = delete;

  [[nodiscard]] RedisAddress address() const {
    return *parse_redis_address("redis://127.0.0.1:" + std::to_string(port_));
  }
  /// Returns the number of connections so far.
  [[nodiscard]] int connections() const { return connections_; }

 private:
  void serve(const Replies& replies) {
    const int client = ::accept(fd_, nullptr, nullptr);
    if (client < 0) return;
    ++connections_;
    std::array<char, 4096> command{};  // a command arrives in one read: it is small, and the client waits for its reply
    for (const std::string& reply : replies) {
      if (::recv(client, command.data(), command.size(), 0) <= 0) break;
      EXPECT_EQ(::send(client, reply.data(), reply.size(), MSG_NOSIGNAL), static_cast<ssize_t>(reply.size()));
    }
    (void)::recv(client, command.data(), command.size(), 0);
    ::close(client);
  }

  const int fd_;
  int port_ = 0;
  std::atomic<int> connections_ = 0;
  std::thread thread_;
};

const std::string is_absent = ":0\r\n";
const std::string is_there = ":1\r\n";

class ErrorsOfTheServer : public testing::TestWithParam<const char*> {
 protected:
  const std::string error_ = "-" + std::string(GetParam()) + "\r\n";
};
INSTANTIATE_TEST_SUITE_P(Kinds, ErrorsOfTheServer,
                         testing::Values("READONLY You can't write against a read only replica.",
                                         "LOADING Redis is loading the dataset in memory",
                                         "MASTERDOWN Link with MASTER is down", "MOVED 3999 127.0.0.1:6381",
                                         "NOREPLICAS Not enough good replicas to write.",
                                         "CLUSTERDOWN The cluster is down", "UNBLOCKED force unblock",
                                         "NOAUTH Authentication required.", "MISCONF cannot persist to disk",
                                         "ERR max number of clients reached", "SOMETHING of a later version"));

TEST_P(ErrorsOfTheServer, CommandIsRepeatedOnANewConnection) {
  const ScriptedRedis redis({{is_absent, error_}, {is_there, is_absent}});
  RedisStore store(redis.address(), 1 << 20, 0);
  EXPECT_FALSE(store.contains("a"));
  EXPECT_TRUE(store.contains("a"));
  EXPECT_FALSE(store.contains("a"));  // on the new connection
  EXPECT_EQ(redis.connections(), 2);
}

TEST_P(ErrorsOfTheServer, CommandIsRepeatedOnlyOnce) {
  const ScriptedRedis redis({{is_absent, error_}, {error_}, {is_there}});
  RedisStore store(redis.address(), 1 << 20, 0);
  EXPECT_FALSE(store.contains("a"));
  try {
    (void)store.contains("a");
    ADD_FAILURE() << "was answered";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::store_unavailable);
  }
  EXPECT_EQ(redis.connections(), 2);
}

TEST(RedisStore, ReplicaIsReadAfterARefusedWrite) {
  const ScriptedRedis redis({{is_there, "-READONLY replica\r\n"}, {"-READONLY replica\r\n"}, {is_there}});
  RedisStore store(redis.address(), 1 << 20, 0);
  EXPECT_TRUE(store.contains("a"));
  EXPECT_THROW((void)store.remove("a"), Problem);
  EXPECT_TRUE(store.contains("a"));
}

TEST(RedisStore, KeyErrorsKeepTheConnection) {
  const std::string mesh = "mesh";
  const ScriptedRedis redis({{"-WRONGTYPE of a list\r\n", "-WRONGTYPE of a list\r\n",
                              "$26\r\n# Memory\r\nused_memory:1000\r\n", "-OOM above maxmemory\r\n", is_there}});
  RedisStore store(redis.address(), 1 << 20, 0);
  EXPECT_EQ(store.get(sha256(mesh)), nullptr);
  try {
    store.put(sha256(mesh), mesh);
    ADD_FAILURE() << "was put";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::store_full);
  }
  EXPECT_TRUE(store.contains("a"));
  EXPECT_EQ(redis.connections(), 1);
}

}  // namespace
}  // namespace papilio::server
