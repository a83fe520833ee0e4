#include "server/store/host_addresses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <memory>
#include <stdexcept>

namespace papilio::server {
namespace {

using std::chrono::milliseconds;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::string> nobody(const std::string&) { throw std::runtime_error("asked"); }

TEST(HostAddresses, NumericAddressIsNotLookedUp) {
  EXPECT_THAT(host_addresses("10.1.2.3", milliseconds(1), nobody), ElementsAre("10.1.2.3"));
  EXPECT_THAT(host_addresses("::1", milliseconds(1), nobody), ElementsAre("::1"));
}

TEST(HostAddresses, NameIsLookedUp) {
  EXPECT_THAT(host_addresses("localhost", milliseconds(20000)), Contains(testing::AnyOf("127.0.0.1", "::1")));
}

TEST(HostAddresses, ResolversErrorIsReported) {
  EXPECT_THAT([] { (void)host_addresses("store", milliseconds(20000), nobody); },
              ThrowsMessage<std::runtime_error>("asked"));
  EXPECT_THAT([] { (void)host_addresses("no such name", milliseconds(60000)); },
              ThrowsMessage<std::runtime_error>(HasSubstr("no such name cannot be looked up")));
}

TEST(HostAddresses, LookUpEndsAtItsLimit) {
  const auto end = std::make_shared<std::promise<void>>();
  const auto ended = std::make_shared<std::promise<void>>();
  const auto silent = [end, ended](const std::string&) -> std::vector<std::string> {
    end->get_future().wait();
    ended->set_value();
    return {"10.1.2.3"};
  };
  EXPECT_THAT([&] { (void)host_addresses("store", milliseconds(50), silent); },
              ThrowsMessage<std::runtime_error>(HasSubstr("50 ms")));
  end->set_value();
  ended->get_future().wait();
}

}  // namespace
}  // namespace papilio::server
