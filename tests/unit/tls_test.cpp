#include "server/http/tls.h"

#include <fstream>
#include <random>

#include "tests/support/http_fixture.h"
#include "tests/support/tls_client.h"

// The server over TLS: answers, and the limits of plain connections.

namespace papilio::server {
namespace {

namespace fs = std::filesystem;
using test::TlsClient;
using test::write_certificate;

class TlsTest : public HttpServerTest {
 protected:
  void SetUp() override {
    HttpServerTest::SetUp();
    folder_ = fs::path(::testing::TempDir()) / ("tls" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    options_.tls_cert = folder_ / "certificate.pem";
    options_.tls_key = folder_ / "key.pem";
    write_certificate(options_.tls_cert, options_.tls_key, "first");
  }
  void TearDown() override {
    HttpServerTest::TearDown();
    fs::remove_all(folder_);
  }

  std::string common_name() const {
    TlsClient client(port_);
    EXPECT_TRUE(client.handshake());
    return client.common_name();
  }

  fs::path folder_;
};

std::string refusal(const std::string& certificate, const std::string& key) {
  try {
    const TlsContext context(certificate, key);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "was not refused";
}

TEST_F(TlsTest, UnusableFilesAreRefusedByName) {
  const std::string missing = folder_ / "missing";
  EXPECT_EQ(refusal(missing, options_.tls_key).find("--tls-cert " + missing), 0U);
  EXPECT_EQ(refusal(options_.tls_cert, missing).find("--tls-key " + missing), 0U);
  EXPECT_EQ(refusal(options_.tls_key, options_.tls_key).find("--tls-cert"), 0U);
  const std::string other = folder_ / "other";
  write_certificate(folder_ / "unused", other, "other");
  const std::string mismatch = refusal(options_.tls_cert, other);
  EXPECT_EQ(mismatch.find("--tls-key " + other), 0U);
  EXPECT_NE(mismatch.find("mismatch"), std::string::npos) << mismatch;
}

TEST_F(TlsTest, LargeBodiesAreEchoedUnchanged) {
  options_.max_body_bytes = 64 << 20;
  start();
  std::mt19937_64 random(1);
  std::string large(60 << 20, 0);
  for (size_t i = 0; i + 8 <= large.size(); i += 8) {
    const uint64_t word = random();
    std::memcpy(&large[i], &word, 8);
  }
  TlsClient client(port_);
  ASSERT_TRUE(client.send(post("/echo", large)));
  std::string answer;
  while (answer.find("\r\n\r\n") == std::string::npos) answer += client.receive();
  answer.erase(0, answer.find("\r\n\r\n") + 4);
  while (answer.size() < large.size()) {
    const std::string some = client.receive();
    ASSERT_FALSE(some.empty()) << answer.size();
    answer += some;
  }
  EXPECT_TRUE(answer == large);
  ASSERT_TRUE(client.send(get("/hello")));
  EXPECT_NE(client.receive_until("hello GET").find("200 OK"), std::string::npos) << "the connection is kept";
}

TEST_F(TlsTest, OnlyHttp11IsChosen) {
  start();
  TlsClient both(port_);
  both.offer_protocols("\x02h2\x08http/1.1");
  EXPECT_TRUE(both.handshake());
  EXPECT_EQ(both.protocol(), "http/1.1");
  TlsClient other(port_);
  other.offer_protocols("\x02h2");
  EXPECT_FALSE(other.handshake());
}

TEST_F(TlsTest, SmallPiecesOfAStreamShareRecords) {
  start();
  TlsClient client(port_);
  ASSERT_TRUE(client.send(get("/stream")));
  const int before = client.records();
  EXPECT_NE(client.receive_until("0\r\n\r\n").find("4\r\ntwo \r\n"), std::string::npos);
  // The head, three chunks and the last chunk; with TLS 1.3 also the end of the handshake, which looks like data.
  EXPECT_LE(client.records() - before, 5 + 4);
}

TEST_F(TlsTest, PipelinedRequestsSurviveTheDisconnectCheck) {
  start();
  TlsClient client(port_);
  ASSERT_TRUE(client.send(get("/stream") + get("/stream") + post("/echo", "the end")));
  const std::string answers = client.receive_until("the end");
  EXPECT_TRUE(answers.ends_with("the end")) << answers;
  EXPECT_EQ(finished(3).size(), 3U);
}

TEST_F(TlsTest, EachKindOfDisconnectIsDetected) {
  start();
  for (const char* way : {"close_notify", "close", "reset"}) {
    SCOPED_TRACE(way);
    saw_gone_ = false;
    auto client = std::make_unique<TlsClient>(port_);
    ASSERT_TRUE(client->send(get("/watch")));
    ASSERT_TRUE(eventually([&] { return inside_ == 1; }));
    if (way == std::string("close_notify")) {
      client->say_goodbye();
    } else {
      const linger now{1, 0};
      if (way == std::string("reset")) ::setsockopt(client->fd(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
      client.reset();
    }
    EXPECT_TRUE(eventually([&] { return saw_gone_.load(); }));
    EXPECT_TRUE(eventually([&] { return server_->running() == 0; }));
  }
}

TEST_F(TlsTest, ServerEndsWithACloseNotify) {
  options_.idle_seconds = 1;
  start();
  TlsClient idle(port_);
  ASSERT_TRUE(idle.send(get("/hello")));
  EXPECT_TRUE(idle.receive_until("hello GET").ends_with("hello GET"));
  EXPECT_TRUE(idle.at_proper_end()) << "an idle connection";
  TlsClient asked(port_);
  ASSERT_TRUE(asked.send("GET /stream HTTP/1.0\r\n\r\n"));
  EXPECT_TRUE(asked.receive_until("three").ends_with("three"));
  EXPECT_TRUE(asked.at_proper_end()) << "the end of the connection is the end of the answer";
}

TEST_F(TlsTest, SilentAndDrippingHandshakesAreCut) {
  options_.idle_seconds = 1;
  options_.threads = 2;
  start();
  for (const bool drips : {false, true}) {
    TlsClient client(port_);
    std::atomic<bool> done = !drips;
    // The head of a record of 512 bytes, then one byte at a time.
    if (drips) client.send_raw(std::string("\x16\x03\x01\x02\x00\x01", 6));
    std::thread dripping([&] {
      while (!done && client.send_raw("x")) std::this_thread::sleep_for(20ms);
    });
    EXPECT_EQ(common_name(), "first") << "other clients are served";
    char byte = 0;
    EXPECT_LE(::recv(client.fd(), &byte, 1, 0), 0);
    EXPECT_NE(errno, EAGAIN);
    done = true;
    dripping.join();
  }
  EXPECT_EQ(finished(0).size(), 0U) << "a handshake is no request";
}

TEST_F(TlsTest, PlainHttpIsClosedWithoutAnAnswer) {
  options_.idle_seconds = 600;
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(get("/count")).status, 0);
  EXPECT_EQ(counted_, 0);
  EXPECT_EQ(common_name(), "first");
}

TEST_F(TlsTest, EmptyRecordsDoNotExtendTheDeadlines) {
  options_.read_seconds = 1;
  options_.idle_seconds = 1;
  start();
  for (const std::string& begun :
       {std::string(), std::string("GET /hello HTTP/1.1\r\n"), request("POST /echo", "Content-Length: 100\r\n")}) {
    SCOPED_TRACE(begun);
    TlsClient client(port_);
    ASSERT_TRUE(client.handshake());
    ASSERT_TRUE(begun.empty() || client.send(begun));
    const auto hang = std::chrono::steady_clock::now() + patience;
    while (client.send_key_update() && std::chrono::steady_clock::now() < hang) continue;
    EXPECT_LT(std::chrono::steady_clock::now(), hang);
  }
}

TEST_F(TlsTest, SlowBodyIsCutWithAnAnswer) {
  options_.read_seconds = 1;
  start();
  TlsClient client(port_);
  ASSERT_TRUE(client.send(request("POST /echo", "Content-Length: 4000\r\n", "x")));
  EXPECT_NE(client.receive_until("}\n").find("408 "), std::string::npos);
  EXPECT_TRUE(client.at_proper_end());
}

TEST_F(TlsTest, SlowReaderIsServedUntilItStopsReading) {
  options_.write_seconds = 1;
  start();
  TlsClient slow(port_, 4096);
  ASSERT_TRUE(slow.send(get("/pour")));
  for (int i = 0; i < 20; ++i) {
    ASSERT_FALSE(slow.receive(8192).empty());
    std::this_thread::sleep_for(100ms);
    ASSERT_FALSE(saw_gone_.load()) << i;
  }
  EXPECT_TRUE(eventually([&] { return saw_gone_.load(); })) << "once it reads no more";
  EXPECT_EQ(finished(1).at(0).code, "not_sent");
}

TEST_F(TlsTest, SteadySlowReaderReceivesTheWholeAnswer) {
  options_.write_seconds = 1;
  start();
  TlsClient slow(port_, 2048);
  ASSERT_TRUE(slow.send(get("/large", "Connection: close\r\n")));
  size_t size = 0;
  for (std::string some = slow.receive(2400); !some.empty(); some = slow.receive(2400)) {
    size += some.size();
    std::this_thread::sleep_for(100ms);
  }
  EXPECT_GT(size, large_size);
  EXPECT_EQ(finished(1).at(0).code, "");
}

TEST_F(TlsTest, StalledHandshakesHoldNoThread) {
  options_.idle_seconds = 600;
  options_.threads = 1;
  start();
  const TlsClient silent(port_);
  const TlsClient stalled(port_);
  stalled.send_raw(std::string("\x16\x03\x01\x02\x00\x01", 6));
  EXPECT_EQ(common_name(), "first");
}

TEST_F(TlsTest, StopCutsHandshakesAndRequests) {
  options_.idle_seconds = 600;
  start();
  const TlsClient silent(port_);
  TlsClient working(port_);
  ASSERT_TRUE(working.send(get("/watch")));
  ASSERT_TRUE(eventually([&] { return inside_ == 1; }));
  stop();
  EXPECT_TRUE(saw_gone_);
}

TEST_F(TlsTest, ReloadAffectsOnlyNewConnectionsAndValidCertificates) {
  start();
  TlsClient old(port_);
  ASSERT_TRUE(old.handshake());
  write_certificate(options_.tls_cert, options_.tls_key, "second");
  EXPECT_EQ(common_name(), "first") << "until the reload";
  server_->reload_certificate();
  EXPECT_EQ(common_name(), "second");
  std::ofstream(options_.tls_cert) << "no certificate";
  EXPECT_THROW(server_->reload_certificate(), std::runtime_error);
  EXPECT_EQ(common_name(), "second");
  ASSERT_TRUE(old.send(get("/hello")));
  EXPECT_TRUE(old.receive_until("hello GET").ends_with("hello GET")) << "a connection outlives its certificate";
}

TEST_F(TlsTest, ReloadsDuringHandshakesAreSafe) {
  start();
  std::atomic<bool> done = false;
  std::thread reloading([&] {
    while (!done) server_->reload_certificate();
  });
  for (int i = 0; i < 50; ++i) EXPECT_EQ(common_name(), "first");
  done = true;
  reloading.join();
}

}  // namespace
}  // namespace papilio::server
