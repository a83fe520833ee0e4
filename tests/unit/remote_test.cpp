#include "client/lib/remote.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "server/endpoints.h"
#include "tests/support/draco_tools.h"
#include "tests/support/shapes.h"

namespace papilio::client {
namespace {

using testing::HasSubstr;

/// A server on a loopback port that answers one request with the given bytes and closes the connection.
class Stranger {
 public:
  explicit Stranger(std::string answer) : answer_(std::move(answer)), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* general = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(listener_, general, size), 0);
    EXPECT_EQ(::listen(listener_, 1), 0);
    EXPECT_EQ(::getsockname(listener_, general, &size), 0);
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { answer_one(); });
  }
  ~Stranger() {
    ::shutdown(listener_, SHUT_RDWR);  // unblocks accept
    thread_.join();
    ::close(listener_);
  }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;

  [[nodiscard]] const std::string& url() const { return url_; }

 private:
  void answer_one() {
    const int connection = ::accept(listener_, nullptr, nullptr);
    if (connection < 0) return;
    std::array<char, 4096> buffer{};
    (void)::recv(connection, buffer.data(), buffer.size(), 0);
    (void)::send(connection, answer_.data(), answer_.size(), MSG_NOSIGNAL);
    ::shutdown(connection, SHUT_WR);
    while (::recv(connection, buffer.data(), buffer.size(), 0) > 0) {
    }
    ::close(connection);
  }

  std::string answer_;
  int listener_;
  std::string url_;
  std::thread thread_;
};

/// Returns the exception of a call.
template <class Call>
ServerError server_error_of(Call call) {
  try {
    call();
  } catch (const ServerError& error) {
    return error;
  }
  ADD_FAILURE() << "was not refused";
  return {0, "", ""};
}

/// Returns the error of `refine` for an answer.
ServerError refinement_refused(const std::string& answer) {
  const Stranger stranger(answer);
  return server_error_of([&] { (void)Remote(stranger.url()).refine("a mesh", {}); });
}

/// The service on a free loopback port, and a client.
class RemoteTest : public ::testing::Test {
 protected:
  static server::HttpOptions options() {
    server::HttpOptions options;
    options.port = 0;
    return options;
  }

  static server::EngineOptions engine_options() {
    server::EngineOptions options;
    options.limits.max_output_faces = 2000;
    options.slots = 2;
    options.queue = 4;
    return options;
  }
  RemoteTest() : engine_(engine_options()), server_(options()) {
    server::add_endpoints(server_, engine_);
    url_ = "http://127.0.0.1:" + std::to_string(server_.bind());
    thread_ = std::thread([this] { server_.run(); });
  }
  ~RemoteTest() override {
    server_.stop();
    thread_.join();
  }

  std::string coarse_ = test::encode_with_draco(test::icosahedron(), test::Method::edgebreaker);
  server::Engine engine_;
  server::HttpServer server_;
  std::string url_;
  std::thread thread_;
};

TEST_F(RemoteTest, RemoteResultEqualsTheLocal) {
  const proto::Parameters parameters = proto::parse_query({{"levels", "2"}});
  const proto::EncodedLevel there = Remote(url_ + "/").refine(coarse_, parameters);
  const proto::EncodedLevel here = proto::Refinement(coarse_, parameters, {}).run();
  EXPECT_EQ(there.bytes, here.bytes);
  EXPECT_EQ(there.statistics.faces, 320U);
  EXPECT_EQ(there.statistics.vertices, here.statistics.vertices);
  EXPECT_EQ(there.statistics.stop_reason, StopReason::levels);
  EXPECT_GT(there.statistics.times.encode, 0);
}

TEST_F(RemoteTest, UnreachedTargetHasTheReasonOfTheServer) {
  const proto::Parameters parameters =
      proto::parse_query({{"tolerance", "0.0024"}, {"levels", "3"}, {"output.position_bits", "8"}});
  const proto::EncodedLevel there = Remote(url_).refine(coarse_, parameters);
  EXPECT_NE(there.statistics.unreached.find("output.position_bits=8"), std::string::npos) << there.statistics.unreached;
  EXPECT_EQ(there.statistics.unreached,
            proto::Refinement(coarse_, parameters, engine_options().limits).run().statistics.unreached);
}

TEST_F(RemoteTest, LevelsAreReceivedInOrderUpToTheResult) {
  const proto::Parameters parameters = proto::parse_query({{"levels", "2"}});
  std::vector<proto::BodyPart> parts;
  Remote(url_).refine_levels(coarse_, parameters, [&](const proto::BodyPart& part) { parts.push_back(part); });
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[0].header("Papilio-Faces"), "20");
  EXPECT_EQ(parts[2].body, Remote(url_).refine(coarse_, parameters).bytes);
  EXPECT_EQ(parts[3].header("Content-Type"), "application/json");
}

TEST_F(RemoteTest, RefusalsHaveStatusCodeAndMessage) {
  const auto refusal = [](auto call) { return server_error_of(call); };
  const auto ignore = [](const proto::BodyPart&) {};
  const proto::Parameters large = proto::parse_query({{"levels", "6"}});
  EXPECT_EQ(refusal([&] { (void)Remote(url_).refine(coarse_, large); }).status(), 507);
  EXPECT_EQ(refusal([&] { Remote(url_).refine_levels(coarse_, large, ignore); }).code(), "result_too_large");
  // Detected after the stream has begun: the status is 200 and the last part is the problem.
  const proto::Parameters later = proto::parse_query({{"levels", "6"}, {"flatness", "1"}});
  int parts = 0;
  const ServerError midway =
      refusal([&] { Remote(url_).refine_levels(coarse_, later, [&](const proto::BodyPart&) { ++parts; }); });
  EXPECT_EQ(midway.code(), "result_too_large");
  EXPECT_EQ(parts, 4);  // 20, 80, 320 and 1280 faces
  EXPECT_EQ(refusal([&] { (void)Remote(url_).refine("solid", large); }).code(), "mesh_not_draco");
  EXPECT_EQ(refusal([&] { (void)Remote("http://127.0.0.1:1").refine(coarse_, large); }).status(), 0);
  EXPECT_THROW(Remote("localhost:8080"), std::invalid_argument);
}

const std::string ok = "HTTP/1.1 200 OK\r\n";
const std::string draco_type = "Content-Type: application/x-draco\r\n";

/// Returns the last header field and an empty line.
std::string length(size_t bytes) { return "Content-Length: " + std::to_string(bytes) + "\r\n\r\n"; }

std::string icosahedron() { return test::encode_with_draco(test::icosahedron(), test::Method::edgebreaker); }

TEST(Remote, AnswerWithoutAMeshIsRefused) {
  EXPECT_THAT(refinement_refused(ok + "Content-Type: text/html; charset=utf-8\r\n" + length(5) + "hello").what(),
              HasSubstr("answered with \"text/html\", not with application/x-draco. Is papilio-server running there"));
  EXPECT_THAT(refinement_refused(ok + length(5) + "hello").what(), HasSubstr("no Content-Type"));
  EXPECT_THAT(refinement_refused(ok + draco_type + length(5) + "hello").what(),
              HasSubstr("5 bytes that are no whole Draco mesh"));
  EXPECT_THAT(refinement_refused(ok + draco_type + length(0)).what(),
              HasSubstr("0 bytes that are no whole Draco mesh"));
  EXPECT_EQ(refinement_refused("HTTP/1.1 301 Moved\r\nLocation: /\r\n" + length(0)).status(), 301);
  EXPECT_EQ(refinement_refused("hello").status(), 0);
  EXPECT_EQ(refinement_refused("").status(), 0);
  const std::string mesh = icosahedron();
  EXPECT_THAT(refinement_refused(ok + draco_type + "Papilio-Faces: 80\r\n" + length(mesh.size()) + mesh).what(),
              HasSubstr("20 faces, but Papilio-Faces is \"80\""));
}

TEST(Remote, TruncatedAnswerIsRefusedAtAnySize) {
  const std::string mesh = icosahedron();
  const std::string head = ok + "Content-Type: Application/X-Draco;a=b\r\nPapilio-Faces: 20\r\n";
  const Stranger whole(head + length(mesh.size()) + mesh);
  EXPECT_EQ(Remote(whole.url()).refine("a mesh", {}).bytes, mesh);
  for (size_t size = 0; size < mesh.size(); ++size) {
    const std::string cut = mesh.substr(0, size);
    EXPECT_THAT(refinement_refused(head + length(mesh.size()) + cut).what(),
                HasSubstr("broke off after " + std::to_string(size) + " bytes"));
    EXPECT_THAT(refinement_refused(head + "Transfer-Encoding: chunked\r\n\r\nfff\r\n" + cut).what(),
                HasSubstr("broke off"));
    EXPECT_THAT(refinement_refused(head + "\r\n" + cut).what(), HasSubstr("neither Content-Length"));
  }
  for (size_t size = 0; size < mesh.size(); size += 7)
    EXPECT_THAT(refinement_refused(head + length(size) + mesh.substr(0, size)).what(),
                HasSubstr("no whole Draco mesh"));
}

TEST(Remote, ServersMessagesHaveNoControlCharacters) {
  const std::string escape = "\x1b[2J\x1b]0;title\x07";
  const std::string problem = R"({"code": "\u001b[31m", "detail": "no\u001b[2J\nway\u202e", "request_id": "\u009b1"})";
  for (const std::string& answer :
       {ok + "Content-Type: text/" + escape + "\r\n" + length(0),
        ok + draco_type + "Papilio-Faces: " + escape + "\r\n" + length(icosahedron().size()) + icosahedron(),
        "HTTP/1.1 400 " + escape + "\r\n" + length(problem.size()) + problem}) {
    const ServerError error = refinement_refused(answer);
    for (const std::string& text : {std::string(error.what()), error.code()})
      for (const char c : text) EXPECT_TRUE(c >= ' ' && c <= '~') << text;
  }
  EXPECT_STREQ(refinement_refused("HTTP/1.1 400 No\r\n\r\n" + problem).what(),
               "no\\x1b[2J\\x0away\\u202e (request \\x9b1)");
}

TEST(Remote, EndlessAnswerIsReadUpToTheLimit) {
  const std::string endless = "HTTP/1.1 500 No\r\nContent-Length: 900000000000\r\n\r\n" + std::string(100'000, 'x');
  EXPECT_THAT(refinement_refused(endless).what(), HasSubstr("more than 65536 bytes"));
  const Stranger stranger(endless);
  EXPECT_THAT(server_error_of([&] { (void)Remote(stranger.url()).health(Health::alive); }).what(),
              HasSubstr("more than 65536 bytes"));
}

TEST(Remote, HealthRequiresAPapilioServer) {
  for (const std::string body :
       {R"({"status": "alive"})", R"({"status": "\u001b[2Jalive"})", R"({"status": 1})", "alive", ""}) {
    const Stranger stranger(ok + "Content-Type: application/json\r\n" + length(body.size()) + body);
    const Remote remote(stranger.url());
    if (body == R"({"status": "alive"})")
      EXPECT_EQ(remote.health(Health::alive), "alive");
    else
      EXPECT_THAT(server_error_of([&] { (void)remote.health(Health::alive); }).what(), HasSubstr("no papilio-server"));
  }
}

}  // namespace
}  // namespace papilio::client
