#include "server/http/http.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

// Speaks to the real server over raw sockets on the loopback: every trap that was measured on cpp-httplib
// (its table is in the engineering notes) and every way to be a bad client has its test here. Times are upper
// bounds against hangs only.

namespace papilio::server {
namespace {

using namespace std::chrono_literals;
using proto::Code;
using proto::Problem;

constexpr auto patience = 20s;

bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

struct Reply {
  int status = 0;  ///< 0: no answer came
  std::string head;
  std::string body;

  [[nodiscard]] std::string field(const std::string& name) const {
    const size_t at = head.find("\r\n" + name + ": ");
    if (at == std::string::npos) return {};
    const size_t begin = at + name.size() + 4;
    return head.substr(begin, head.find("\r\n", begin) - begin);
  }
  [[nodiscard]] std::string code() const {
    const auto json = nlohmann::json::parse(body, nullptr, false);
    return json.is_object() ? json.value("code", "") : "";
  }
};

class Client {
 public:
  explicit Client(int port, int receive_buffer = 0) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
    if (receive_buffer > 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { close(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] bool connected() const { return connected_; }

  bool send(std::string_view bytes) const {
    return ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  Reply receive(bool without_body = false) {
    Reply reply;
    while (held_.find("\r\n\r\n") == std::string::npos)
      if (!fill()) return reply;
    const size_t end = held_.find("\r\n\r\n") + 4;
    reply.head = held_.substr(0, end);
    held_.erase(0, end);
    reply.status = std::stoi(reply.head.substr(9, 3));
    if (without_body || reply.status == 100 || reply.status == 204 || reply.status == 304) return reply;
    if (reply.field("Transfer-Encoding") == "chunked") {
      receive_chunks(reply.body);
    } else if (const std::string length = reply.field("Content-Length"); !length.empty()) {
      while (held_.size() < std::stoul(length) && fill()) continue;
      reply.body = held_.substr(0, std::stoul(length));
      held_.erase(0, reply.body.size());
    } else {
      while (fill()) continue;
      reply.body.swap(held_);
    }
    return reply;
  }

  Reply ask(std::string_view bytes, bool without_body = false) {
    send(bytes);
    return receive(without_body);
  }

  /// Up to `most` bytes of what has come, thrown away.
  bool skip(size_t most) const {
    std::string bytes(most, 0);
    return ::recv(fd_, bytes.data(), bytes.size(), 0) > 0;
  }

  /// True when the server ends the connection properly, without a reset and without sending anything more.
  bool at_end() { return held_.empty() && !fill() && ended_; }

  [[nodiscard]] int local_port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }

  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  void reset() {
    const linger now{1, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_LINGER, &now, sizeof now);
    close();
  }

 private:
  bool fill() {
    pollfd one{fd_, POLLIN, 0};
    if (::poll(&one, 1, static_cast<int>(std::chrono::milliseconds(patience).count())) <= 0) return false;
    std::array<char, 65536> bytes{};
    const ssize_t count = ::recv(fd_, bytes.data(), bytes.size(), 0);
    ended_ = count == 0;
    if (count > 0) held_.append(bytes.data(), static_cast<size_t>(count));
    return count > 0;
  }

  void receive_chunks(std::string& body) {
    for (;;) {
      while (held_.find("\r\n") == std::string::npos)
        if (!fill()) return;
      const size_t line = held_.find("\r\n") + 2;
      const size_t size = std::stoul(held_, nullptr, 16);
      while (held_.size() < line + size + 2)
        if (!fill()) return;
      body += held_.substr(line, size);
      held_.erase(0, line + size + 2);
      if (size == 0) {
        body += "<end>";
        return;
      }
    }
  }

  int fd_;
  bool connected_ = false;
  bool ended_ = false;
  std::string held_;
};

std::string request(const std::string& line, const std::string& fields = {}, const std::string& body = {}) {
  return line + " HTTP/1.1\r\nHost: test\r\n" + fields + "\r\n" + body;
}

std::string get(const std::string& path, const std::string& fields = {}) { return request("GET " + path, fields); }

std::string post(const std::string& path, const std::string& body, const std::string& fields = {}) {
  return request("POST " + path, fields + "Content-Length: " + std::to_string(body.size()) + "\r\n", body);
}

std::string form(const std::string& body, const std::string& boundary = "cut") {
  return post("/form", body, "Content-Type: multipart/form-data; boundary=" + boundary + "\r\n");
}

const std::string smuggled = get("/count");
constexpr uint64_t body_limit = 4096;

class HttpServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.port = 0;
    options_.max_body_bytes = body_limit;
    options_.max_header_bytes = 2048;
    options_.threads = 8;
    options_.idle_seconds = 20;
    options_.read_seconds = 20;
    options_.write_seconds = 20;
    options_.on_finished = [this](const Finished& finished) {
      const std::lock_guard lock(mutex_);
      finished_.push_back(finished);
    };
  }

  void TearDown() override { stop(); }

  void start() {
    server_ = std::make_unique<HttpServer>(options_);
    std::signal(SIGPIPE, SIG_DFL);  // cpp-httplib ignores it; the server must not depend on that
    add_routes();
    port_ = server_->bind();
    thread_ = std::thread([this] { server_->run(); });
  }

  void stop() {
    released_ = true;
    if (server_) server_->stop();
    if (thread_.joinable()) thread_.join();
    server_.reset();
  }

  Reply ask(const std::string& bytes) { return Client(port_).ask(bytes); }

  /// The answer is this refusal, complete in every respect, and the connection is closed behind it.
  void expect_refused(const std::string& bytes, int status, const std::string& code) {
    SCOPED_TRACE(bytes.substr(0, 300));
    Client client(port_);
    const Reply reply = client.ask(bytes);
    expect_problem(reply, status, code);
    EXPECT_EQ(reply.field("Connection"), "close");
    EXPECT_TRUE(client.at_end());
    EXPECT_EQ(counted_, 0) << "bytes of a refused request were executed as another one";
  }

  static void expect_problem(const Reply& reply, int status, const std::string& code) {
    EXPECT_EQ(reply.status, status);
    EXPECT_EQ(reply.code(), code);
    EXPECT_EQ(reply.field("Content-Type"), "application/problem+json");
    EXPECT_EQ(reply.field("Cache-Control"), "no-store");
    EXPECT_FALSE(reply.field("X-Request-Id").empty());
  }

  std::vector<Finished> finished(size_t count) {
    eventually([&] {
      const std::lock_guard lock(mutex_);
      return finished_.size() >= count;
    });
    const std::lock_guard lock(mutex_);
    return finished_;
  }

  HttpOptions options_;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
  int port_ = 0;
  std::atomic<int> counted_ = 0;        ///< calls of /count
  std::atomic<bool> released_ = false;  ///< lets /hold end
  std::atomic<bool> saw_gone_ = false;  ///< /watch or /pour has seen its client go

 private:
  static Response text(std::string body) {
    Response response;
    response.content_type = "text/plain";
    response.body = std::move(body);
    return response;
  }

  static std::string described(const Body& body) {
    std::string description;
    for (const FormPart& part : body.parts) description += part.name + "|" + part.content_type + "|" + part.bytes + ";";
    return description + body.bytes;
  }

  void add_routes() {
    server_->add(
        "GET", "/alive", [](Request&) { return text("alive"); }, WhileDraining::answer);
    server_->add("GET", "/hello", [](Request& r) { return text("hello " + r.method()); });
    server_->add("GET", "/count", [this](Request&) {
      ++counted_;
      return text("counted");
    });
    server_->add("POST", "/echo", [](Request& r) { return text(r.read_body().bytes); });
    server_->add("POST", "/form", [](Request& r) { return text(described(r.read_body())); });
    server_->add("POST", "/refuse", [](Request&) -> Response { throw Problem(Code::bad_parameter, "no", "levels"); });
    server_->add("GET", "/busy", [](Request&) -> Response { throw Problem(Code::busy, "full"); });
    server_->add("GET", "/throw", [](Request&) -> Response { throw std::runtime_error("the secret"); });
    server_->add("GET", "/throw-odd", [](Request&) -> Response { throw 42; });
    server_->add("POST", "/twice", [](Request& r) {
      r.read_body();
      return text(r.read_body().bytes);
    });
    server_->add("GET", "/query", [](Request& r) {
      std::string all;
      for (const auto& [name, value] : r.query()) all += name + "=" + value + ";";
      return text(all);
    });
    server_->add("GET", "/address",
                 [](Request& r) { return text(r.remote_address() + " " + r.header("remote_addr")); });
    server_->add("GET", "/mirror", [](Request& r) {
      Response response = text(r.header("x-in"));
      for (const auto& [name, value] : r.query()) response.headers.emplace_back(name, value);
      return response;
    });
    server_->add("GET", "/unmodified", [](Request&) {
      Response response;
      response.status = 304;
      return response;
    });
    server_->add("GET", "/stream", [](Request&) {
      Response response = text("ignored");
      response.stream = [](Sink& sink) {
        for (const char* word : {"one ", "", "two ", "three"}) sink.write(word);
      };
      return response;
    });
    server_->add("GET", "/stream-throws", [](Request&) {
      Response response = text("");
      response.stream = [](Sink& sink) {
        sink.write("begun");
        throw std::runtime_error("the secret");
      };
      return response;
    });
    server_->add("GET", "/hold", [this](Request&) {
      EXPECT_TRUE(eventually([this] { return released_.load(); }));
      return text("held");
    });
    server_->add("GET", "/watch", [this](Request& r) {
      EXPECT_FALSE(r.client_gone());
      saw_gone_ = eventually([&r] { return r.client_gone(); });
      return text("watched");
    });
    server_->add("GET", "/pour", [this](Request&) {
      Response response = text("");
      response.stream = [this](Sink& sink) {
        const std::string much(100000, 'x');
        saw_gone_ = eventually([&] { return !sink.write(much); });
      };
      return response;
    });
  }

  std::mutex mutex_;
  std::vector<Finished> finished_;
};

// Ordinary requests

TEST_F(HttpServerTest, AnswersWithLengthDateAndId) {
  start();
  Client client(port_);
  const Reply reply = client.ask(get("/hello"));
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, "hello GET");
  EXPECT_EQ(reply.field("Content-Length"), "9");
  EXPECT_EQ(reply.field("Content-Type"), "text/plain");
  EXPECT_EQ(reply.field("X-Request-Id").size(), 16u);
  EXPECT_TRUE(reply.field("Date").ends_with(" GMT"));
  EXPECT_EQ(reply.field("Connection"), "");
}

TEST_F(HttpServerTest, NeverCompressesOnItsOwn) {
  start();
  const Reply reply = ask(get("/hello", "Accept-Encoding: gzip, br\r\n"));
  EXPECT_EQ(reply.body, "hello GET");
  EXPECT_EQ(reply.field("Content-Encoding"), "");
}

TEST_F(HttpServerTest, HeadFollowsGetWithoutABody) {
  start();
  Client client(port_);
  const Reply head = client.ask(request("HEAD /hello"), true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.field("Content-Length"), "10");
  EXPECT_EQ(client.ask(request("HEAD /stream"), true).field("Transfer-Encoding"), "chunked");
  EXPECT_EQ(client.ask(request("HEAD /nowhere"), true).status, 404);
  EXPECT_EQ(client.ask(get("/hello")).body, "hello GET") << "HEAD's answers must have had no body";
}

TEST_F(HttpServerTest, NotModifiedHasNeitherBodyNorLength) {
  start();
  Client client(port_);
  const Reply reply = client.ask(get("/unmodified"));
  EXPECT_EQ(reply.status, 304);
  EXPECT_EQ(reply.field("Content-Length"), "");
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
}

TEST_F(HttpServerTest, UnknownPathsAre404ForAnyMethod) {
  start();
  for (const char* method : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE", "PURGE"}) {
    Client client(port_);
    expect_problem(client.ask(request(std::string(method) + " /nowhere")), 404, "not_found");
    EXPECT_EQ(client.ask(get("/hello")).status, 200) << "nothing is unread: the connection stays";
  }
  expect_problem(ask(get("/hello/")), 404, "not_found");
  expect_problem(ask(get("/hello%2e")), 404, "not_found");
}

TEST_F(HttpServerTest, OtherMethodsAre405WithAllow) {
  start();
  for (const char* method : {"POST", "PUT", "PATCH", "DELETE", "TRACE", "get"}) {
    const Reply reply = ask(request(std::string(method) + " /hello"));
    expect_problem(reply, 405, "method_not_allowed");
    EXPECT_EQ(reply.field("Allow"), "GET, HEAD, OPTIONS");
  }
  EXPECT_EQ(ask(get("/echo")).field("Allow"), "OPTIONS, POST");
}

TEST_F(HttpServerTest, OptionsListsTheMethods) {
  start();
  const Reply reply = ask(request("OPTIONS /hello"));
  EXPECT_EQ(reply.status, 204);
  EXPECT_EQ(reply.field("Allow"), "GET, HEAD, OPTIONS");
}

TEST_F(HttpServerTest, QueryKeepsOrderDuplicatesAndEqualsSigns) {
  start();
  EXPECT_EQ(ask(get("/query?b=2&a=1&a=1&c=x=y&d&e=%2C+?&&=z")).body, "b=2;a=1;a=1;c=x=y;d=;e=, ?;=z;");
  EXPECT_EQ(ask(get("http://test:80/query?a=1")).body, "a=1;");
  EXPECT_EQ(ask(get("/hell%6F")).body, "hello GET");
}

TEST_F(HttpServerTest, HeaderValuesAreNotPercentDecoded) {
  start();
  EXPECT_EQ(ask(get("/mirror", "X-In: %0d%0aX: \xc3\xa4 %41\r\n")).body, "%0d%0aX: \xc3\xa4 %41");
}

TEST_F(HttpServerTest, KeepsAConnectionForManyRequests) {
  options_.keep_alive_requests = 300;
  start();
  Client client(port_);
  for (int i = 1; i < 300; ++i) {
    const std::string body = "body " + std::to_string(i);
    const Reply reply = client.ask(i % 2 ? post("/echo", body) : get("/query?" + std::to_string(i)));
    ASSERT_EQ(reply.status, 200) << i;
    ASSERT_EQ(reply.field("Connection"), "") << i;
  }
  EXPECT_EQ(client.ask(get("/hello")).field("Connection"), "close");
  EXPECT_TRUE(client.at_end());
}

TEST_F(HttpServerTest, AnswersPipelinedRequestsInOrder) {
  start();
  Client client(port_);
  client.send(post("/echo", "first") + "\r\n" + get("/query?second=") + post("/echo", "third"));
  EXPECT_EQ(client.receive().body, "first");
  EXPECT_EQ(client.receive().body, "second=;");
  EXPECT_EQ(client.receive().body, "third");
}

TEST_F(HttpServerTest, ClosesWhenTheClientAsksForIt) {
  start();
  for (const std::string& bytes : {get("/hello", "Connection: Close\r\n"), get("/hello", "Connection: x, close\r\n"),
                                   std::string("GET /hello HTTP/1.0\r\n\r\n")}) {
    Client client(port_);
    const Reply reply = client.ask(bytes);
    EXPECT_EQ(reply.body, "hello GET");
    EXPECT_EQ(reply.field("Connection"), "close");
    EXPECT_TRUE(client.at_end());
  }
}

TEST_F(HttpServerTest, ServesFiftyConnectionsAtOnce) {
  start();
  std::vector<std::thread> clients;
  std::atomic<int> good = 0;
  for (int i = 0; i < 50; ++i) {
    clients.emplace_back([&, i] {
      const std::string body = "body " + std::to_string(i);
      for (int j = 0; j < 5; ++j)
        if (ask(post("/echo", body)).body == body) ++good;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 250);
  EXPECT_EQ(finished(250).size(), 250u);
}

TEST_F(HttpServerTest, LogsEachRequestOnce) {
  start();
  Client client(port_);
  client.ask(post("/echo?secret=1", "12345", "X-Request-Id: mine\r\n"));
  const Reply odd = client.ask(get("/odd%0Apath"));
  const auto log = finished(2);
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].id, "mine");
  EXPECT_EQ(log[0].method, "POST");
  EXPECT_EQ(log[0].path, "/echo");
  EXPECT_EQ(log[0].remote_address, "127.0.0.1");
  EXPECT_EQ(log[0].status, 200);
  EXPECT_EQ(log[0].code, "");
  EXPECT_EQ(log[0].bytes_in, post("/echo?secret=1", "12345", "X-Request-Id: mine\r\n").size());
  EXPECT_GT(log[0].bytes_out, 5u);
  EXPECT_EQ(log[1].status, 400);
  EXPECT_EQ(log[1].code, "bad_request");
  EXPECT_EQ(log[1].bytes_out, odd.head.size() + odd.body.size());
}

// Bodies

TEST_F(HttpServerTest, ReadsBodiesOfEitherFraming) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(post("/echo", std::string(body_limit, 'x'))).body, std::string(body_limit, 'x'));
  EXPECT_EQ(client.ask(post("/echo", "")).body, "");
  const std::string chunked = "Transfer-Encoding: Chunked\r\n";
  EXPECT_EQ(client.ask(request("POST /echo", chunked, "5\r\nhello\r\n1;ext=1\r\n!\r\n0\r\nTrailer: x\r\n\r\n")).body,
            "hello!");
  EXPECT_EQ(client.ask(request("POST /echo", chunked, "0\r\n\r\n")).body, "");
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
}

TEST_F(HttpServerTest, ReadsABodyThatComesByteByByte) {
  start();
  Client client(port_);
  for (const char c : request("POST /echo", "Transfer-Encoding: chunked\r\n", "5\r\nhello\r\n0\r\n\r\n")) {
    ASSERT_TRUE(client.send({&c, 1}));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(client.receive().body, "hello");
}

TEST_F(HttpServerTest, TooLargeByContentLengthIsRefusedBeforeTheBodyComes) {
  start();
  const std::string head = request("POST /echo", "Content-Length: 4097\r\n");
  expect_refused(head, 413, "body_too_large");
  expect_refused(request("POST /echo", "Content-Length: 99999999999999999999999\r\n"), 413, "body_too_large");
  EXPECT_NE(ask(head).body.find("4096 bytes"), std::string::npos) << "the limit is named";
}

TEST_F(HttpServerTest, TooLargeBodyIsNotExecutedAsTheNextRequest) {
  start();
  std::string body;
  while (body.size() < 2 * body_limit) body += smuggled;
  expect_refused(post("/echo", body), 413, "body_too_large");
}

TEST_F(HttpServerTest, TooLargeUploadStillReadsTheRefusal) {
  start();
  Client client(port_);
  client.send(request("POST /echo", "Content-Length: 1000000\r\n"));
  const std::string some(50000, 'x');
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(client.send(some)) << "a reset would lose the answer";
  expect_problem(client.receive(), 413, "body_too_large");
  EXPECT_TRUE(client.at_end());
}

TEST_F(HttpServerTest, ChunkedBodyIsRefusedAsSoonAsItPassesTheLimit) {
  start();
  const std::string chunked = "Transfer-Encoding: chunked\r\n";
  const std::string chunk = "800\r\n" + std::string(0x800, 'x') + "\r\n";
  EXPECT_EQ(ask(request("POST /echo", chunked, chunk + chunk + "0\r\n\r\n")).body.size(), body_limit);
  expect_refused(request("POST /echo", chunked, chunk + chunk + "1\r\n"), 413, "body_too_large");
  expect_refused(request("POST /echo", chunked, "7fffffffffffffff\r\n" + smuggled), 413, "body_too_large");
  expect_refused(request("POST /echo", chunked, "1\r\nx\r\nffffffffffffffff\r\n"), 413, "body_too_large");
  expect_refused(request("POST /echo", chunked, "10000000000000000000000\r\n"), 413, "body_too_large");
}

TEST_F(HttpServerTest, DamagedChunkingIsRefused) {
  start();
  for (const std::string& body :
       {"5\r\nhelloXX\r\n0\r\n\r\n" + smuggled, "-1\r\nx\r\n" + smuggled, "0x1\r\nx\r\n0\r\n\r\n" + smuggled,
        "+1\r\nx\r\n0\r\n\r\n" + smuggled, "\r\n\r\n" + smuggled, "1\nx\r\n0\r\n\r\n" + smuggled,
        "5 5\r\nhello\r\n0\r\n\r\n" + smuggled, "1;" + std::string(1000, 'e') + "\r\nx\r\n0\r\n\r\n" + smuggled}) {
    expect_refused(request("POST /echo", "Transfer-Encoding: chunked\r\n", body), 400, "bad_request");
  }
  std::string endless = "0\r\n";
  for (int i = 0; i < 100; ++i) endless += "Trailer: " + std::string(200, 't') + "\r\n";
  expect_refused(request("POST /echo", "Transfer-Encoding: chunked\r\n", endless), 400, "bad_request");
}

TEST_F(HttpServerTest, BodyThatEndsEarlyIsRefused) {
  start();
  for (const std::string& bytes : {request("POST /echo", "Content-Length: 10\r\n", "short"),
                                   request("POST /echo", "Transfer-Encoding: chunked\r\n", "5\r\nhel")}) {
    Client client(port_);
    client.send(bytes);
    client.close();
  }
  const auto log = finished(2);
  ASSERT_EQ(log.size(), 2u);
  for (const Finished& one : log) EXPECT_EQ(one.code, "bad_request");
}

TEST_F(HttpServerTest, ExpectContinueIsAnsweredWhenTheBodyIsWanted) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(request("POST /echo", "Content-Length: 5\r\nExpect: 100-Continue\r\n")).status, 100);
  EXPECT_EQ(client.ask("hello").body, "hello");
}

TEST_F(HttpServerTest, ExpectContinueIsRefusedWithoutTheUpload) {
  start();
  const std::string expect = "Expect: 100-continue\r\nContent-Length: ";
  expect_refused(request("POST /echo", expect + "4097\r\n"), 413, "body_too_large");
  expect_refused(request("POST /refuse", expect + "10\r\n"), 400, "bad_parameter");
  expect_refused(request("POST /nowhere", expect + "10\r\n"), 404, "not_found");
}

TEST_F(HttpServerTest, EncodedBodiesAreRefused) {
  start();
  for (const char* encoding : {"gzip", "deflate", "br", "zstd", "identity, gzip"})
    expect_refused(post("/echo", smuggled, "Content-Encoding: " + std::string(encoding) + "\r\n"), 415,
                   "unsupported_encoding");
  expect_refused(post("/echo", smuggled, "Content-Encoding: identity\r\nContent-Encoding: gzip\r\n"), 415,
                 "unsupported_encoding");
  EXPECT_EQ(ask(post("/echo", "plain", "Content-Encoding: Identity\r\n")).body, "plain");
}

TEST_F(HttpServerTest, RangesAreRefused) {
  start();
  std::string many = "bytes=0-1";
  for (int i = 0; i < 300; ++i) many += ",0-1";
  expect_problem(ask(get("/hello", "Range: " + many + "\r\n")), 416, "range_not_supported");
  expect_problem(ask(get("/stream", "Range: nonsense\r\n")), 416, "range_not_supported");
}

TEST_F(HttpServerTest, PostWithoutLengthIsRefusedAtOnce) {
  start();
  expect_problem(ask(request("POST /echo")), 411, "length_required");
}

TEST_F(HttpServerTest, UnreadBodiesAreNotExecuted) {
  start();
  expect_refused(post("/refuse", smuggled), 400, "bad_parameter");
  expect_refused(post("/nowhere", smuggled), 404, "not_found");
  expect_refused(post("/hello", smuggled), 405, "method_not_allowed");
  Client client(port_);
  const std::string length = "Content-Length: " + std::to_string(smuggled.size()) + "\r\n";
  const Reply reply = client.ask(request("GET /hello", length, smuggled));
  EXPECT_EQ(reply.status, 200) << "a body on GET is lawful";
  EXPECT_EQ(reply.field("Connection"), "close");
  EXPECT_TRUE(client.at_end());
  EXPECT_EQ(counted_, 0);
}

TEST_F(HttpServerTest, ReadingABodyTwiceIsABug) {
  start();
  expect_problem(ask(post("/twice", "x")), 500, "internal");
}

// Forms

TEST_F(HttpServerTest, ReadsFormParts) {
  start();
  Client client(port_);
  const Reply reply =
      client.ask(form("preamble\r\n--cut\r\nContent-Disposition: form-data; filename=\"a;b\"; name=\"mesh\"\r\n"
                      "content-type: application/x-draco\r\n\r\n\r\n--cu\r\nbytes\r\n"
                      "--cut  \r\nContent-Disposition: form-data; name=params\r\n\r\n{}\r\n"
                      "--cut\r\nContent-Disposition: form-data; name=\"a \\\"b\\\"\"\r\n\r\n\r\n--cut--"));
  EXPECT_EQ(reply.body, "mesh|application/x-draco|\r\n--cu\r\nbytes;params||{};a \"b\"||;");
  EXPECT_EQ(client.ask(form("--cut--\r\n")).body, "");
  EXPECT_EQ(client
                .ask(form("--c=t:\r\nContent-Disposition: form-data; name=n\r\n\r\nv\r\n--c=t:--\r\nepilogue",
                          "\"c=t:\"; charset=utf-8"))
                .body,
            "n||v;");
}

TEST_F(HttpServerTest, DamagedFormsAreRefused) {
  start();
  const std::string part = "--cut\r\nContent-Disposition: form-data; name=n\r\n\r\nv\r\n";
  for (const std::string& body :
       {std::string(), std::string("--cut"), part, std::string("nothing"), std::string("--other--"),
        part + "--cutter--", std::string("--cut\r\n\r\nno name\r\n--cut--"),
        std::string("--cut\r\nContent-Disposition: form-data; name=n"), "--cut\r\nX: " + std::string(4000, 'x')}) {
    SCOPED_TRACE(body.substr(0, 100));
    expect_problem(ask(form(body)), 400, "bad_request");
  }
  const std::string good = part + "--cut--";
  for (const std::string& boundary :
       {std::string(), std::string("\"\""), std::string(71, 'x'), std::string("\"a\xff\"")})
    expect_problem(ask(form(good, boundary)), 400, "bad_request");
  expect_problem(ask(post("/form", good, "Content-Type: multipart/form-data\r\n")), 400, "bad_request");
  expect_problem(ask(post("/form", good, "Content-Type: multipart/form-data; notboundary=cut\r\n")), 400,
                 "bad_request");
}

TEST_F(HttpServerTest, FormsHaveALimitedNumberOfParts) {
  options_.max_body_bytes = 1 << 20;
  start();
  std::string body;
  for (int i = 0; i < 65; ++i) body += "--cut\r\nContent-Disposition: form-data; name=n\r\n\r\nv\r\n";
  expect_problem(ask(form(body + "--cut--")), 400, "bad_request");
}

TEST_F(HttpServerTest, LongPartHeadersDoNotOverflowTheStack) {
  options_.max_body_bytes = 8 << 20;
  start();
  const std::string name(4 << 20, 'n');
  expect_problem(ask(form("--cut\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\nv\r\n--cut--")), 400,
                 "bad_request");
}

// Heads

TEST_F(HttpServerTest, AmbiguousFramingIsRefused) {
  start();
  for (const char* fields : {
           "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n",
           "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n",
           "Content-Length: 5\r\nContent-Length: 5\r\n",
           "Content-Length: 5\r\ncontent-length: 6\r\n",
           "Content-Length: 5, 5\r\n",
           "Content-Length: -5\r\n",
           "Content-Length: +5\r\n",
           "Content-Length: 0x5\r\n",
           "Content-Length: 5 5\r\n",
           "Content-Length: %35\r\n",
           "Content-Length:\r\n",
           "Content-Length : 5\r\n",
           "Content-Length: 5\n\r\n",
           "Content-Length: 5\rX: y\r\n",
           "X: y\r\n Content-Length: 5\r\n",
           "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
           "Transfer-Encoding: gzip, chunked\r\n",
           "Transfer-Encoding: identity\r\n",
           "Transfer-Encoding: %63hunked\r\n",
           "Transfer-Encoding:\r\n",
           "Transfer-Encoding: \x0b"
           "chunked\r\n",
       }) {
    expect_refused(request("POST /echo", fields, "0\r\n\r\n" + smuggled), 400, "bad_request");
  }
  expect_refused("POST /echo HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400, "bad_request");
}

TEST_F(HttpServerTest, GarbageIsRefused) {
  start();
  const std::string host = "Host: test\r\n\r\n";
  for (const std::string& bytes : {"nonsense\r\n" + host,
                                   "GET /hello\r\n" + host,
                                   "GET /hello HTTP/2.0\r\n" + host,
                                   "GET /hello HTTP/1.2\r\n" + host,
                                   "GET /hello http/1.1\r\n" + host,
                                   "GET  /hello HTTP/1.1\r\n" + host,
                                   "GET /hello HTTP/1.1 \r\n" + host,
                                   " GET /hello HTTP/1.1\r\n" + host,
                                   "GET hello HTTP/1.1\r\n" + host,
                                   "GET /h\tello HTTP/1.1\r\n" + host,
                                   "GET /hell\xc3\xb6 HTTP/1.1\r\n" + host,
                                   "G@T /hello HTTP/1.1\r\n" + host,
                                   "GET /% HTTP/1.1\r\n" + host,
                                   "GET /%4 HTTP/1.1\r\n" + host,
                                   "GET /%zz HTTP/1.1\r\n" + host,
                                   "GET /%00 HTTP/1.1\r\n" + host,
                                   "GET /%0d%0aX:y HTTP/1.1\r\n" + host,
                                   "GET /query?a=%g1 HTTP/1.1\r\n" + host,
                                   get("/hello", "no colon\r\n"),
                                   get("/hello", ": no name\r\n"),
                                   get("/hello", "bad name: x\r\n"),
                                   get("/hello", std::string("X: \0\r\n", 6)),
                                   get("/hello", "Host: second\r\n"),
                                   std::string("GET /hello HTTP/1.1\r\n\r\n"),
                                   std::string("GET /hello HTTP/1.1\nHost: test\n\n"),
                                   std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"),
                                   std::string("\x16\x03\x01\x02\n\x01\xfc\x03\x03", 9),
                                   std::string("\r\n\r\n\r\n"),
                                   std::string("\n")}) {
    expect_refused(bytes, 400, "bad_request");
  }
}

TEST_F(HttpServerTest, HeaderFloodIsRefused) {
  start();
  expect_refused(get("/hello", "X: " + std::string(2048, 'x') + "\r\n"), 431, "headers_too_large");
  expect_refused("GET /" + std::string(2100, 'x'), 431, "headers_too_large");
  std::string many;
  for (int i = 0; i < 500; ++i) many += "X-" + std::to_string(i) + ": y\r\n";
  expect_refused(get("/hello", many), 431, "headers_too_large");
  const std::string fitting(2048 - get("/hello", "X: \r\n").size(), 'x');
  EXPECT_EQ(ask(get("/hello", "X: " + fitting + "\r\n")).status, 200);
  expect_refused(get("/hello", "X: " + fitting + "x\r\n"), 431, "headers_too_large");
}

TEST_F(HttpServerTest, SlowHeadIsCut) {
  options_.read_seconds = 1;
  start();
  Client client(port_);
  client.send("GET /hello HTTP/1.1\r\n");
  std::atomic<bool> done = false;
  std::thread dripping([&] {
    while (!done && client.send("X: y\r\n")) std::this_thread::sleep_for(50ms);
  });
  expect_problem(client.receive(), 408, "request_timeout");
  EXPECT_TRUE(client.at_end());
  done = true;
  dripping.join();
}

TEST_F(HttpServerTest, SlowBodyIsCut) {
  options_.read_seconds = 1;
  start();
  for (const bool drips : {false, true}) {
    Client client(port_);
    client.send(request("POST /echo", "Content-Length: 4000\r\n"));
    std::atomic<bool> done = !drips;
    std::thread dripping([&] {
      while (!done && client.send("x")) std::this_thread::sleep_for(20ms);
    });
    expect_problem(client.receive(), 408, "request_timeout");
    EXPECT_TRUE(client.at_end());
    done = true;
    dripping.join();
  }
}

TEST_F(HttpServerTest, IdleConnectionIsClosed) {
  options_.idle_seconds = 1;
  start();
  Client silent(port_);
  Client idle(port_);
  EXPECT_EQ(idle.ask(get("/hello")).status, 200);
  EXPECT_TRUE(idle.at_end());
  EXPECT_TRUE(silent.at_end());
  EXPECT_EQ(finished(1).size(), 1u) << "an idle connection is no request";
}

TEST_F(HttpServerTest, IdleConnectionMakesRoomForAWaitingOne) {
  options_.threads = 1;
  options_.idle_seconds = 600;
  start();
  Client idle(port_);
  EXPECT_EQ(idle.ask(get("/hello")).status, 200);
  EXPECT_EQ(ask(get("/hello")).status, 200);
  EXPECT_TRUE(idle.at_end());
}

TEST_F(HttpServerTest, RemoteAddressCannotBeForged) {
  start();
  EXPECT_EQ(ask(get("/address")).body, "127.0.0.1 ");
  EXPECT_EQ(ask(get("/address", "REMOTE_ADDR: 6.6.6.6\r\nX-Forwarded-For: 6.6.6.6\r\n")).body, "127.0.0.1 6.6.6.6");
}

TEST_F(HttpServerTest, TakesOverSaneRequestIdsOnly) {
  start();
  const std::string longest(64, 'a');
  for (const std::string& sane : {std::string("a"), std::string("Az09._-"), longest}) {
    const Reply reply = ask(get("/nowhere", "X-Request-Id: " + sane + "\r\n"));
    EXPECT_EQ(reply.field("X-Request-Id"), sane);
    EXPECT_EQ(nlohmann::json::parse(reply.body).value("request_id", ""), sane);
  }
  std::vector<std::string> ids;
  for (const std::string& insane : {std::string(), longest + "a", std::string("a b"), std::string("a\"b"),
                                    std::string("%0d%0aX: y"), std::string("\xc3\xa4")}) {
    const Reply reply = ask(get("/hello", "X-Request-Id: " + insane + "\r\n"));
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.field("X-Request-Id").size(), 16u);
    EXPECT_EQ(reply.field("X-Request-Id").find_first_not_of("0123456789abcdef"), std::string::npos);
    ids.push_back(reply.field("X-Request-Id"));
  }
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
}

TEST_F(HttpServerTest, NothingFromTheClientCanAddHeaderLines) {
  start();
  const Reply reply = ask(get("/mirror?X-Out=a%0d%0aX-Evil:%20b%0a&X-Bad%0d%0aX-Evil=c&Content-Length=1&Connection=x"));
  EXPECT_EQ(reply.field("X-Out"), "a  X-Evil: b ");
  EXPECT_EQ(reply.head.find("\r\nX-Evil"), std::string::npos);
  EXPECT_EQ(reply.head.find("X-Bad"), std::string::npos);
  EXPECT_EQ(reply.field("Content-Length"), "0");
  EXPECT_EQ(reply.field("Connection"), "");
}

// Failures of handlers

TEST_F(HttpServerTest, ExceptionsBecomeInternalWithoutAWord) {
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

TEST_F(HttpServerTest, ProblemsAreAnsweredInTheirOwnWords) {
  start();
  const auto json = nlohmann::json::parse(ask(post("/refuse", "")).body);
  EXPECT_EQ(json["detail"], "no");
  EXPECT_EQ(json["parameter"], "levels");
  EXPECT_EQ(json["status"], 400);
  const Reply busy = ask(get("/busy"));
  expect_problem(busy, 429, "busy");
  EXPECT_EQ(busy.field("Retry-After"), "1");
}

// Streams and clients that go away

TEST_F(HttpServerTest, StreamsInChunks) {
  start();
  Client client(port_);
  const Reply reply = client.ask(get("/stream"));
  EXPECT_EQ(reply.field("Transfer-Encoding"), "chunked");
  EXPECT_EQ(reply.field("Content-Length"), "");
  EXPECT_EQ(reply.body, "one two three<end>");
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
}

TEST_F(HttpServerTest, StreamsUntilTheCloseForHttp10) {
  start();
  const Reply reply = ask("GET /stream HTTP/1.0\r\n\r\n");
  EXPECT_EQ(reply.field("Transfer-Encoding"), "");
  EXPECT_EQ(reply.body, "one two three");
}

TEST_F(HttpServerTest, StreamThatThrowsIsSeenAsCutShort) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(get("/stream-throws")).body, "begun");
  EXPECT_TRUE(client.at_end());
  EXPECT_EQ(finished(1).at(0).code, "not_sent");
}

TEST_F(HttpServerTest, HandlerSeesThatTheClientIsGone) {
  start();
  for (const bool reset : {false, true}) {
    saw_gone_ = false;
    Client client(port_);
    client.send(get("/watch"));
    ASSERT_TRUE(eventually([&] { return server_->running() == 1; }));
    reset ? client.reset() : client.close();
    EXPECT_TRUE(eventually([&] { return saw_gone_.load(); }));
    EXPECT_TRUE(eventually([&] { return server_->running() == 0; }));
  }
}

TEST_F(HttpServerTest, StreamSeesThatTheClientIsGone) {
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

TEST_F(HttpServerTest, ClientThatReadsSlowlyIsServed) {
  // 80 KB a second: far too little to free a third of the socket's megabytes within a second.
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

TEST_F(HttpServerTest, AcceptedSocketsDoNotDelaySmallAnswers) {
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

TEST_F(HttpServerTest, BacklogIsLong) {
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

TEST_F(HttpServerTest, DrainWaitsForTheRunningAndRefusesTheRest) {
  start();
  Client running(port_);
  running.send(get("/hold"));
  Client kept(port_);
  EXPECT_EQ(kept.ask(get("/hello")).status, 200);
  ASSERT_TRUE(eventually([&] { return server_->running() == 1; }));
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

TEST_F(HttpServerTest, DrainCutsWhatTakesTooLongAndSigpipeKillsNobody) {
  start();
  Client client(port_);
  client.send(get("/watch"));
  ASSERT_TRUE(eventually([&] { return server_->running() == 1; }));
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

TEST_F(HttpServerTest, StopBeforeRunIsNotLost) {
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
