#include "server/keys.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>

#include "server/sha256.h"

namespace papilio::server {
namespace {

using proto::Problem;

/// A request with only an Authorization header.
class Asking final : public Request {
 public:
  explicit Asking(std::string authorization) : authorization_(std::move(authorization)) {}
  [[nodiscard]] const std::string& method() const override { return text_; }
  [[nodiscard]] const std::string& path() const override { return text_; }
  [[nodiscard]] std::string path_parameter(std::string_view) const override { return {}; }
  [[nodiscard]] const Fields& query() const override { return fields_; }
  [[nodiscard]] std::string header(std::string_view name) const override {
    return name == "Authorization" ? authorization_ : "";
  }
  [[nodiscard]] const std::string& remote_address() const override { return text_; }
  [[nodiscard]] const std::string& client() const override { return text_; }
  [[nodiscard]] const std::string& id() const override { return text_; }
  [[nodiscard]] std::string content_type() const override { return {}; }
  [[nodiscard]] Body read_body() override { return {}; }
  [[nodiscard]] bool client_gone() const override { return false; }

 private:
  const std::string authorization_;
  const std::string text_;
  const Fields fields_;
};

class KeysTest : public testing::Test {
 protected:
  ~KeysTest() override { std::filesystem::remove(file_); }
  void write(const std::string& text) const { std::ofstream(file_) << text; }
  /// Returns the client's name or the problem's code.
  static std::string outcome(const Keys& keys, const std::string& authorization, Access access) {
    try {
      return keys.authorize(Asking(authorization), access);
    } catch (const Problem& problem) {
      return std::string(proto::problem_kind(problem.code()).name);
    }
  }
  [[nodiscard]] std::string refusal() const {
    try {
      const Keys keys(file_);
      return "none";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("papilio-keys-" + std::to_string(::getpid()));
};

TEST_F(KeysTest, SeveralKeysAreValidWithTheirOwnRights) {
  write("# comment\n\nold  0123456789abcdef\n  new  sha256:" + sha256("fedcba9876543210") + "  manage\n");
  const Keys keys(file_);
  EXPECT_EQ(keys.size(), 2U);
  EXPECT_EQ(outcome(keys, "Bearer 0123456789abcdef", Access::use), "old");
  EXPECT_EQ(outcome(keys, "bearer   fedcba9876543210", Access::use), "new");
  EXPECT_EQ(outcome(keys, "Bearer 0123456789abcdef", Access::manage), "forbidden");
  EXPECT_EQ(outcome(keys, "Bearer fedcba9876543210", Access::manage), "new");
  for (const char* other : {"", "Bearer", "Bearer ", "Bearer 0123456789abcdeF", "0123456789abcdef",
                            "Basic 0123456789abcdef", "Bearer 0123456789abcdef0"})
    EXPECT_EQ(outcome(keys, other, Access::use), "unauthorized") << other;
  EXPECT_EQ(outcome(keys, "", Access::open), "");
}

TEST_F(KeysTest, DigestsAreCaseInsensitive) {
  std::string digest = sha256("fedcba9876543210");
  std::ranges::transform(digest, digest.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  for (const char* mark : {"sha256:", "SHA256:", "Sha256:"}) {
    write("one " + (mark + digest) + "\n");
    const Keys keys(file_);
    EXPECT_EQ(outcome(keys, "Bearer fedcba9876543210", Access::use), "one") << mark;
    EXPECT_EQ(outcome(keys, "Bearer " + (mark + digest), Access::use), "unauthorized") << mark;
  }
}

TEST_F(KeysTest, MalformedDigestIsRefusedWithItsLine) {
  const std::string digest = sha256("fedcba9876543210");
  for (const std::string& wrong :
       {"SHA256:" + digest.substr(1), "sha256:" + digest + "0", "SHA256:" + digest.substr(1) + "g", "sha256=" + digest,
        "sha-256:" + digest, "SHA_256:" + digest, "sha256" + digest, "sha512:" + digest + digest, "MD5:" + digest,
        "sha1=" + digest, std::string("sha256-n4bQgYhMfWWaL+qgxVrQFaO/TxsrC4Is0V1sFbDwCgg=")}) {
    write("one 0123456789abcdef\ntwo " + wrong + "\n");
    EXPECT_NE(refusal().find(":2: the digest of a key is written sha256: and 64 hexadecimal digits"), std::string::npos)
        << wrong << ": " << refusal();
  }
}

TEST_F(KeysTest, HexadecimalKeyIsNoDigest) {
  const std::string key = sha256("anything");  // as `openssl rand -hex 32` makes them
  for (const std::string& literal : {key, "share:" + key, "md5" + key}) {
    write("one " + literal + "\n");
    EXPECT_EQ(outcome(Keys(file_), "Bearer " + literal, Access::use), "one");
  }
}

TEST_F(KeysTest, FailedReloadKeepsTheOldKeys) {
  write("one 0123456789abcdef\n");
  Keys keys(file_);
  write("one 0123456789abcdef\ntwo fedcba9876543210\n");
  keys.reload();
  EXPECT_EQ(outcome(keys, "Bearer fedcba9876543210", Access::use), "two");
  write("one\n");
  EXPECT_THROW(keys.reload(), std::runtime_error);
  EXPECT_EQ(outcome(keys, "Bearer fedcba9876543210", Access::use), "two");
}

TEST_F(KeysTest, FaultsStateTheirLine) {
  write("one 0123456789abcdef\ntwo short\n");
  EXPECT_NE(refusal().find(":2: a key has at least 16"), std::string::npos) << refusal();
  write("one 0123456789abcdef admin\n");
  EXPECT_NE(refusal().find(":1:"), std::string::npos);
  write("one sha256:12\n");
  EXPECT_NE(refusal().find("64 hexadecimal"), std::string::npos);
  write("# nothing\n");
  EXPECT_NE(refusal().find("no key"), std::string::npos);
}

}  // namespace
}  // namespace papilio::server
