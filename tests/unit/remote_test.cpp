#include "client/lib/remote.h"

#include <gtest/gtest.h>

#include <thread>

#include "server/endpoints.h"
#include "tests/support/draco_tools.h"
#include "tests/support/shapes.h"

namespace papilio::client {
namespace {

/// The real service on a free loopback port, and a client of it.
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

TEST_F(RemoteTest, RefinesToTheSameBytesAndStatistics) {
  const proto::Parameters parameters = proto::parse_query({{"levels", "2"}});
  const proto::EncodedLevel there = Remote(url_ + "/").refine(coarse_, parameters);
  const proto::EncodedLevel here = proto::Refinement(coarse_, parameters, {}).run();
  EXPECT_EQ(there.draco, here.draco);
  EXPECT_EQ(there.statistics.faces, 320U);
  EXPECT_EQ(there.statistics.vertices, here.statistics.vertices);
  EXPECT_EQ(there.statistics.stop_reason, StopReason::levels);
  EXPECT_GT(there.statistics.times.encode, 0);
}

TEST_F(RemoteTest, LevelsComeOneByOneAndTheLastIsTheAnswer) {
  const proto::Parameters parameters = proto::parse_query({{"levels", "2"}});
  std::vector<proto::Part> parts;
  Remote(url_).refine_levels(coarse_, parameters, [&](const proto::Part& part) { parts.push_back(part); });
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(parts[0].header("Papilio-Faces"), "20");
  EXPECT_EQ(parts[2].body, Remote(url_).refine(coarse_, parameters).draco);
  EXPECT_EQ(parts[3].header("Content-Type"), "application/json");
}

TEST_F(RemoteTest, RefusalsComeWithStatusCodeAndWords) {
  const auto refusal = [](auto call) -> ServerError {
    try {
      call();
    } catch (const ServerError& error) {
      return error;
    }
    return {0, "was not refused", ""};
  };
  const auto ignore = [](const proto::Part&) {};
  const proto::Parameters large = proto::parse_query({{"levels", "6"}});
  EXPECT_EQ(refusal([&] { (void)Remote(url_).refine(coarse_, large); }).status(), 507);
  EXPECT_EQ(refusal([&] { Remote(url_).refine_levels(coarse_, large, ignore); }).code(), "result_too_large");
  // Found out only once the stream has begun: its status is 200, the problem its last part.
  const proto::Parameters later = proto::parse_query({{"levels", "6"}, {"flatness", "1"}});
  int parts = 0;
  const ServerError midway =
      refusal([&] { Remote(url_).refine_levels(coarse_, later, [&](const proto::Part&) { ++parts; }); });
  EXPECT_EQ(midway.code(), "result_too_large");
  EXPECT_EQ(parts, 4);  // 20, 80, 320 and 1280 faces
  EXPECT_EQ(refusal([&] { (void)Remote(url_).refine("solid", large); }).code(), "mesh_not_draco");
  EXPECT_EQ(refusal([&] { (void)Remote("http://127.0.0.1:1").refine(coarse_, large); }).status(), 0);
  EXPECT_THROW(Remote("localhost:8080"), std::invalid_argument);
}

}  // namespace
}  // namespace papilio::client
