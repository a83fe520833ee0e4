#include <netinet/tcp.h>

#include <csignal>
#include <fstream>
#include <future>

#include "tests/support/http_fixture.h"

// Answers and connections: failures of handlers, streams, disconnects, sockets, draining.

namespace papilio::server {
namespace {

// Failures of handlers

TEST_F(HttpServerTest, ExceptionsBecomeInternalErrorsWithoutTheirMessage) {
  start();
  Client client(port_);
  for (const char* path : {"/throw", "/throw-odd"}) {
    const Reply reply = client.ask(get(path));
    expect_problem(reply, 500, "internal");
    EXPECT_EQ((reply.head + reply.body).find("secret"), std::string::npos);
    EXPECT_EQ(reply.head.find("EXCEPTION"), std::string::npos);
  }
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
  const auto log = finished(3);
  EXPECT_EQ(log[0].code, "internal");
  EXPECT_EQ(log[0].detail, "the secret");
}

TEST_F(HttpServerTest, ProblemsKeepTheirDetail) {
  start();
  const auto json = nlohmann::json::parse(ask(post("/refuse", "")).body);
  EXPECT_EQ(json["detail"], "no");
  EXPECT_EQ(json["parameter"], "levels");
  EXPECT_EQ(json["status"], 400);
  const Reply busy = ask(get("/busy"));
  expect_problem(busy, 429, "busy");
  EXPECT_EQ(busy.field("Retry-After"), "1");
}

// Streams and disconnects

TEST_F(HttpServerTest, StreamsAreChunked) {
  start();
  Client client(port_);
  const Reply reply = client.ask(get("/stream"));
  EXPECT_EQ(reply.field("Transfer-Encoding"), "chunked");
  EXPECT_EQ(reply.field("Content-Length"), "");
  EXPECT_EQ(reply.body, "one two three<end>");
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
}

TEST_F(HttpServerTest, StreamsEndWithTheConnectionInHttp10) {
  start();
  const Reply reply = ask("GET /stream HTTP/1.0\r\n\r\n");
  EXPECT_EQ(reply.field("Transfer-Encoding"), "");
  EXPECT_EQ(reply.body, "one two three");
}

TEST_F(HttpServerTest, StreamThatThrowsIsTruncated) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(get("/stream-throws")).body, "begun");
  EXPECT_TRUE(client.at_end());
  EXPECT_EQ(finished(1).at(0).code, "not_sent");
}

TEST_F(HttpServerTest, HandlerDetectsADisconnect) {
  start();
  for (const bool reset : {false, true}) {
    saw_gone_ = false;
    Client client(port_);
    client.send(get("/watch"));
    ASSERT_TRUE(eventually([&] { return inside_ == 1; }));
    reset ? client.reset() : client.close();
    EXPECT_TRUE(eventually([&] { return saw_gone_.load(); }));
    EXPECT_TRUE(eventually([&] { return server_->running() == 0; }));
  }
}

TEST_F(HttpServerTest, StreamDetectsADisconnect) {
  start();
  for (const bool reset : {false, true}) {
    saw_gone_ = false;
    Client client(port_);
    client.send(get("/pour"));
    EXPECT_EQ(client.receive(true).status, 200);
    reset ? client.reset() : client.close();
    EXPECT_TRUE(eventually([&] { return saw_gone_.load(); }));
  }
  EXPECT_EQ(finished(2).at(1).code, "not_sent");
}

TEST_F(HttpServerTest, DisconnectedStreamIsLoggedAsNotSent) {
  start();
  Client client(port_);
  client.send(get("/pour"));
  EXPECT_EQ(client.receive(true).status, 200);
  client.close_sending();  // half-closed: the client could still read
  while (client.skip(65536)) continue;
  EXPECT_EQ(finished(1).at(0).code, "not_sent");
}

TEST_F(HttpServerTest, ClientThatReadsSlowlyIsServed) {
  // 80 KB/s: too slow to free a third of the socket's buffer within a second.
  options_.write_seconds = 1;
  start();
  Client client(port_, 4096);
  client.send(get("/pour"));
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(client.skip(8192));
    std::this_thread::sleep_for(100ms);
    ASSERT_FALSE(saw_gone_.load()) << i;
  }
}

/// Reads the whole answer in small pieces at about 24 KB/s. Returns its size with the head.
size_t read_slowly(const Client& client) {
  size_t size = 0;
  for (size_t count = 1; count > 0; size += count) {
    std::this_thread::sleep_for(100ms);
    count = client.skip_some(2400);
  }
  return size;
}

TEST_F(HttpServerTest, SteadySlowReaderReceivesTheWholeAnswer) {
  // Too slow to make the socket writable within a second.
  options_.write_seconds = 1;
  start();
  const Client client(port_, 2048);
  client.send(get("/large", "Connection: close\r\n"));
  EXPECT_GT(read_slowly(client), large_size);
  EXPECT_EQ(finished(1).at(0).code, "");
  EXPECT_GT(finished(1).at(0).milliseconds, 2000) << "longer than the timeout of one write";
}

TEST_F(HttpServerTest, AnswersAreCountedUntilTheyAreSent) {
  start();
  auto client = std::make_unique<Client>(port_, 2048);
  client->send(get("/large-shared"));
  EXPECT_TRUE(eventually([&] { return server_->held().answers == large_size; }));
  auto second = std::make_unique<Client>(port_, 2048);
  second->send(get("/large-shared"));
  Client other(port_, 2048);
  other.send(get("/large"));
  EXPECT_TRUE(eventually([&] { return server_->held().answers == 2 * large_size; })) << "a shared object counts once";
  client->reset();
  second->reset();
  EXPECT_TRUE(eventually([&] { return server_->held().answers == large_size; }));
  other.reset();
  EXPECT_TRUE(eventually([&] { return server_->held().answers == 0; }));
}

TEST_F(HttpServerTest, OldestAnswerIsCutBeyondTheBudget) {
  options_.max_held_bytes = 5 * large_size / 2;
  start();
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 4; ++i) {
    clients.push_back(std::make_unique<Client>(port_, 2048));
    clients.back()->send(get("/large", "X-Request-Id: client-" + std::to_string(i) + "\r\n"));
    EXPECT_TRUE(eventually([&] { return inside_ == i + 1; }));
    EXPECT_TRUE(eventually([&] { return server_->held().answers == std::min(i + 1, 2) * large_size; }));
    if (i == 2) {
      EXPECT_EQ(finished(1).size(), 1U) << "reported before the next is cut";
    }
  }
  const auto cut = finished(2);
  ASSERT_EQ(cut.size(), 2U);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(cut[i].id, "client-" + std::to_string(i));
    EXPECT_EQ(cut[i].code, "not_sent");
    EXPECT_NE(cut[i].detail.find("--max-held-bytes"), std::string::npos);
  }
}

TEST_F(HttpServerTest, BodyIsNotCountedWhileItsAnswerIsSent) {
  options_.max_body_bytes = options_.max_held_bytes = 1 << 20;
  start();
  Client slow(port_, 2048);
  slow.send(post("/large", std::string(1 << 20, 'x')));
  EXPECT_TRUE(eventually([&] { return server_->held().answers == large_size; }));
  EXPECT_EQ(server_->held().bodies, 0U);
  EXPECT_EQ(ask(post("/echo", std::string(1 << 20, 'x'))).status, 200);
}

TEST_F(HttpServerTest, ClientThatDoesNotReadIsCut) {
  options_.write_seconds = 1;
  start();
  Client client(port_, 4096);
  client.send(get("/pour"));
  EXPECT_TRUE(eventually([&] { return saw_gone_.load(); }));
  EXPECT_EQ(finished(1).at(0).code, "not_sent");
}

// Sockets

int server_socket(const std::function<bool(int)>& wanted) {
  for (int fd = 3; fd < 1024; ++fd)
    if (wanted(fd)) return fd;
  return -1;
}

int port_of(int fd, int (*name)(int, sockaddr*, socklen_t*)) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  return name(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 ? ntohs(address.sin_port) : -1;
}

TEST_F(HttpServerTest, AcceptedSocketsHaveNoDelaySet) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
  const int fd = server_socket([&](int one) { return port_of(one, ::getpeername) == client.local_port(); });
  ASSERT_GE(fd, 0);
  int no_delay = 0;
  socklen_t size = sizeof no_delay;
  ::getsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &no_delay, &size);
  EXPECT_EQ(no_delay, 1);
}

TEST_F(HttpServerTest, BacklogIs1024OrTheSystemsMaximum) {
  start();
  const int fd = server_socket([&](int one) {
    int listens = 0;
    socklen_t size = sizeof listens;
    return ::getsockopt(one, SOL_SOCKET, SO_ACCEPTCONN, &listens, &size) == 0 && listens == 1 &&
           port_of(one, ::getsockname) == port_;
  });
  ASSERT_GE(fd, 0);
  int most = 1024;
  std::ifstream("/proc/sys/net/core/somaxconn") >> most;
  tcp_info info{};
  socklen_t size = sizeof info;
  ASSERT_EQ(::getsockopt(fd, IPPROTO_TCP, TCP_INFO, &info, &size), 0);
  EXPECT_EQ(info.tcpi_sacked, static_cast<uint32_t>(std::min(most, 1024))) << "a listening socket's backlog";
}

TEST_F(HttpServerTest, PortInUseIsAnErrorThatNamesIt) {
  start();
  HttpOptions same = options_;
  same.port = port_;
  HttpServer second(same);
  try {
    second.bind();
    FAIL() << "two servers share a port";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("127.0.0.1:" + std::to_string(port_)), std::string::npos) << error.what();
  }
}

TEST_F(HttpServerTest, PortIsFreeForTheNextServerAtOnce) {
  start();
  EXPECT_EQ(ask(get("/hello", "Connection: close\r\n")).status, 200);
  options_.port = port_;
  stop();
  start();
  EXPECT_EQ(ask(get("/hello")).status, 200);
}

// Draining and stopping

TEST_F(HttpServerTest, DrainWaitsForRunningRequestsAndRefusesOthers) {
  start();
  Client running(port_);
  running.send(get("/hold"));
  Client kept(port_);
  EXPECT_EQ(kept.ask(get("/hello")).status, 200);
  ASSERT_TRUE(eventually([&] { return inside_ == 1; }));
  auto drained = std::async(std::launch::async, [&] { return server_->drain(60); });
  Reply refused;
  ASSERT_TRUE(eventually([&] {
    refused = ask(get("/hello"));
    return refused.status == 503;
  }));
  expect_problem(refused, 503, "draining");
  EXPECT_EQ(refused.field("Connection"), "close");
  expect_problem(kept.ask(get("/hello")), 503, "draining");
  EXPECT_TRUE(kept.at_end());
  EXPECT_EQ(ask(get("/alive")).status, 200);
  EXPECT_EQ(drained.wait_for(0s), std::future_status::timeout);
  released_ = true;
  EXPECT_EQ(running.receive().body, "held");
  EXPECT_TRUE(drained.get());
  thread_.join();
  EXPECT_FALSE(Client(port_).connected());
}

TEST_F(HttpServerTest, DrainCutsLongRequestsAndSigpipeIsIgnored) {
  start();
  Client client(port_);
  client.send(get("/watch"));
  ASSERT_TRUE(eventually([&] { return inside_ == 1; }));
  EXPECT_FALSE(server_->drain(0));
  thread_.join();
  EXPECT_TRUE(saw_gone_);
}

TEST_F(HttpServerTest, DrainDoesNotWaitForIdleConnections) {
  options_.idle_seconds = 600;
  start();
  Client idle(port_);
  EXPECT_EQ(idle.ask(get("/hello")).status, 200);
  Client silent(port_);
  Client half(port_);
  half.send("GET /hel");
  EXPECT_TRUE(eventually([&] { return server_->running() == 0; }));
  EXPECT_TRUE(server_->drain(60));
  thread_.join();
  EXPECT_TRUE(idle.at_end());
}

TEST_F(HttpServerTest, StopBeforeRunEndsRun) {
  for (const bool drains : {false, true}) {
    HttpServer server(options_);
    const int port = server.bind();
    if (drains) {
      EXPECT_TRUE(server.drain(60));
    } else {
      server.stop();
    }
    auto run = std::async(std::launch::async, [&] { server.run(); });
    EXPECT_EQ(run.wait_for(patience), std::future_status::ready);
    EXPECT_FALSE(Client(port).connected());
  }
}

TEST_F(HttpServerTest, StopAtAnyMomentEndsRun) {
  for (int i = 0; i < 50; ++i) {
    HttpServer server(options_);
    server.bind();
    std::thread run([&] { server.run(); });
    if (i % 2) std::this_thread::sleep_for(std::chrono::microseconds(i * 10));
    server.stop();
    server.stop();
    run.join();
  }
}

TEST_F(HttpServerTest, RunWithoutBindIsAnError) {
  HttpServer server(options_);
  EXPECT_THROW(server.run(), std::runtime_error);
}

}  // namespace
}  // namespace papilio::server
