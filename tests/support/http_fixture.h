#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/http/http.h"

// A server on a free loopback port and clients on raw sockets. Time limits are only upper bounds against hangs.

namespace papilio::server {

using namespace std::chrono_literals;
using proto::Code;
using proto::Problem;

inline constexpr auto patience = 20s;

inline bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

struct Reply {
  int status = 0;  ///< 0: no answer
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

  /// Receives and discards up to `most` bytes.
  bool skip(size_t most) const { return skip_some(most) > 0; }
  /// Returns the number of bytes; 0 at the end.
  size_t skip_some(size_t most) const {
    std::string bytes(most, 0);
    return static_cast<size_t>(std::max<ssize_t>(0, ::recv(fd_, bytes.data(), bytes.size(), 0)));
  }

  /// Returns true if the server closes the connection without a reset and without further bytes.
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
  void close_sending() const { ::shutdown(fd_, SHUT_WR); }
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

inline std::string request(const std::string& line, const std::string& fields = {}, const std::string& body = {}) {
  return line + " HTTP/1.1\r\nHost: test\r\n" + fields + "\r\n" + body;
}

inline std::string get(const std::string& path, const std::string& fields = {}) {
  return request("GET " + path, fields);
}

inline std::string post(const std::string& path, const std::string& body, const std::string& fields = {}) {
  return request("POST " + path, fields + "Content-Length: " + std::to_string(body.size()) + "\r\n", body);
}

inline std::string form(const std::string& body, const std::string& boundary = "cut") {
  return post("/form", body, "Content-Type: multipart/form-data; boundary=" + boundary + "\r\n");
}

inline const std::string smuggled = get("/count");
inline constexpr uint64_t body_limit = 4096;
inline constexpr size_t large_size = 130'000;  ///< bytes of the answer of /large; exceeds a client's small buffer

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

  /// Expects a complete refusal with this status and code, after which the connection is closed.
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
  std::atomic<int> inside_ = 0;         ///< running handlers of /hold and /watch (a request counts earlier)
  std::atomic<bool> released_ = false;  ///< lets /hold end
  std::atomic<bool> saw_gone_ = false;  ///< /watch or /pour has detected the disconnect

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
    server_->add("GET", "/alive", [](Request&) { return text("alive"); }, {.while_draining = WhileDraining::answer});
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
      (void)r.read_body();
      return text(r.read_body().bytes);
    });
    server_->add("GET", "/query", [](Request& r) {
      std::string all;
      for (const auto& [name, value] : r.query()) all += name + "=" + value + ";";
      return text(all);
    });
    server_->add("GET", "/address",
                 [](Request& r) { return text(r.remote_address() + " " + r.header("remote_addr")); });
    server_->add("GET", "/client", [](Request& r) { return text(r.client()); });
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
      ++inside_;
      EXPECT_TRUE(eventually([this] { return released_.load(); }));
      --inside_;
      return text("held");
    });
    server_->add("GET", "/watch", [this](Request& r) {
      EXPECT_FALSE(r.client_gone());
      ++inside_;
      saw_gone_ = eventually([&r] { return r.client_gone(); });
      --inside_;
      return text("watched");
    });
    const auto large = [this](Request& r) {
      if (r.method() == "POST") (void)r.read_body();
      ++inside_;
      return text(std::string(large_size, 'x'));
    };
    server_->add("GET", "/large", large);
    server_->add("POST", "/large", large);
    server_->add("GET", "/large-shared", [shared = std::make_shared<std::string>(large_size, 'x')](Request&) {
      Response response = text("");
      response.shared = shared;
      return response;
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

}  // namespace papilio::server
