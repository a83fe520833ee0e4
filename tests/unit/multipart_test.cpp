#include "proto/multipart.h"

#include <gtest/gtest.h>

#include "proto/problem.h"

namespace papilio::proto {
namespace {

const std::vector<BodyPart> parts{
    {{{"Content-Type", "application/x-draco"}, {"Papilio-Faces", "12"}}, "abc"},
    {{{"Content-Type", "text/plain"}}, ""},
    {{{"Content-Type", "application/json"}}, "--papilio-test--\r\n\r\n--papilio-test\r\n"}};

std::string body_of(const MultipartWriter& writer) {
  std::string body;
  for (const BodyPart& part : parts) body += writer.part(part);
  return body + writer.end();
}

std::vector<BodyPart> read(const std::string& type, const std::string& body, size_t piece) {
  std::vector<BodyPart> found;
  MultipartReader reader(type, 1000, [&](BodyPart part) { found.push_back(std::move(part)); });
  for (size_t begin = 0; begin < body.size(); begin += piece) reader.feed(std::string_view(body).substr(begin, piece));
  reader.finish();
  return found;
}

TEST(Multipart, PartsRoundTripInPiecesOfAnySize) {
  const MultipartWriter writer("papilio-test");
  const std::string body = body_of(writer);
  for (size_t piece = 1; piece <= body.size(); ++piece) {
    const std::vector<BodyPart> found = read(writer.content_type(), body, piece);
    ASSERT_EQ(found.size(), parts.size()) << piece;
    for (size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(found[i].body, parts[i].body);
      EXPECT_EQ(found[i].header("content-type"), parts[i].header("Content-Type"));
      EXPECT_EQ(found[i].header("Content-Length"), std::to_string(parts[i].body.size()));
    }
    EXPECT_EQ(found[0].header("papilio-faces"), "12");
    EXPECT_EQ(found[0].header("absent"), "");
  }
}

TEST(Multipart, EveryTruncationIsRefused) {
  const MultipartWriter writer("papilio-test");
  const std::string body = body_of(writer);
  for (size_t size = 0; size < body.size(); ++size)
    EXPECT_THROW((void)read(writer.content_type(), body.substr(0, size), 7), Problem) << size;
}

TEST(Multipart, RandomBoundariesDiffer) {
  EXPECT_NE(MultipartWriter().content_type(), MultipartWriter().content_type());
}

TEST(Multipart, ReaderAcceptsQuotedBoundariesAndOtherFields) {
  const std::string body = body_of(MultipartWriter("papilio-test"));
  EXPECT_EQ(read("Multipart/Mixed; charset=x; boundary=\"papilio-test\"", body, 100).size(), 3U);
}

TEST(Multipart, ReaderRefusesMalformedBodies) {
  const std::string type = "multipart/mixed; boundary=b";
  for (const char* bad : {"application/json", "multipart/mixed", "multipart/mixed; boundary=", ""})
    EXPECT_THROW((void)read(bad, "--b--\r\n", 99), Problem) << bad;
  EXPECT_THROW((void)read(type, "--c\r\n", 99), Problem);
  EXPECT_THROW((void)read(type, std::string(500, 'x'), 99), Problem);
  EXPECT_THROW((void)read(type, "--b\r\nno colon\r\n\r\n", 99), Problem);
  EXPECT_THROW((void)read(type, "--b\r\n\r\nabc\r\n--b--\r\n", 99), Problem);
  EXPECT_THROW((void)read(type, "--b\r\nContent-Length: -1\r\n\r\n", 99), Problem);
  EXPECT_THROW((void)read(type, "--b\r\nContent-Length: 1001\r\n\r\n", 99), Problem);
  EXPECT_THROW((void)read(type, "--b\r\nContent-Length: 1\r\n\r\nab\r\n--b--\r\n", 99), Problem);
  EXPECT_THROW((void)read(type, "--b\r\n" + std::string(20000, 'x'), 99), Problem);
  EXPECT_EQ(read(type, "--b--\r\n", 99).size(), 0U);
}

}  // namespace
}  // namespace papilio::proto
