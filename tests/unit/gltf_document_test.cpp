#include <gtest/gtest.h>

#include "proto/gltf/data_uri.h"
#include "proto/gltf/document.h"
#include "proto/gltf/document_writer.h"
#include "proto/problem.h"
#include "tests/support/gltf_scene.h"
#include "tests/support/shapes.h"

namespace papilio::proto::gltf {
namespace {

using test::GltfScene;

/// Returns the problem with which the document is refused.
Problem refusal_of(const std::string& bytes) {
  try {
    (void)read_document(bytes);
  } catch (const Problem& problem) {
    return problem;
  }
  ADD_FAILURE() << "the document was not refused";
  return {Code::internal, ""};
}

std::string with_byte(std::string bytes, size_t at, char byte) {
  bytes[at] = byte;
  return bytes;
}

std::string text_document(const std::string& members) { return R"({"asset":{"version":"2.0"})" + members + "}"; }

TEST(GltfContainer, ChunksRoundTrip) {
  std::vector<ExtraChunk> extra{{0x12345678, "marker__"}};
  const std::string glb = write_glb("{ }", std::vector<Piece>{{"ab"}, {{}, "cde"}}, extra);
  const Container found = read_glb(glb);
  EXPECT_EQ(found.json, "{ } ");
  EXPECT_EQ(found.binary, std::string_view("abcde\0\0\0", 8));
  ASSERT_EQ(found.extra.size(), 1U);
  EXPECT_EQ(found.extra[0].type, 0x12345678U);
  EXPECT_EQ(found.extra[0].bytes, "marker__");
}

TEST(GltfContainer, EveryTruncationIsRefused) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const std::string glb = scene.glb();
  for (size_t size = 0; size < glb.size(); ++size) EXPECT_THROW((void)read_glb(glb.substr(0, size)), Problem) << size;
  EXPECT_THROW((void)read_glb(glb + "more"), Problem);
}

TEST(GltfContainer, DamageIsRefusedWithItsErrorCode) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const std::string glb = scene.glb();
  EXPECT_EQ(refusal_of(with_byte(glb, 4, 1)).code(), Code::mesh_unsupported);  // version
  EXPECT_EQ(refusal_of(with_byte(glb, 15, 127)).code(), Code::mesh_not_gltf);  // length of the first chunk
  EXPECT_EQ(refusal_of(with_byte(glb, 16, 'X')).code(), Code::mesh_not_gltf);  // its type
  EXPECT_EQ(refusal_of("solid cube").code(), Code::mesh_not_gltf);
}

TEST(GltfDataUri, EveryLengthRoundTrips) {
  std::string bytes;
  for (int length = 0; length < 300; ++length) {
    const std::string uri = encode_data_uri(bytes, "data:application/gltf-buffer;base64,");
    EXPECT_TRUE(uri.starts_with("data:application/gltf-buffer;base64,"));
    EXPECT_EQ(decode_data_uri(uri), bytes);
    bytes += static_cast<char>(length * 7);
  }
  EXPECT_FALSE(decode_data_uri("data:,text"));
  EXPECT_FALSE(decode_data_uri("data:;base64,AA*A"));
  EXPECT_FALSE(decode_data_uri("data:;base64,AAAAA"));
}

TEST(GltfDocument, EmbeddedAndExternalBuffersAreRead) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const std::string glb = scene.glb();
  const std::string text = scene.gltf();
  EXPECT_EQ(read_document(glb).buffers[0].bytes(), scene.binary);
  EXPECT_EQ(read_document(text).buffers[0].bytes(), scene.binary);
  const std::string external = text_document(R"(,"buffers":[{"byteLength":3,"uri":"a.bin"}])");
  const Document read = read_document(external, [](const std::string& uri) { return uri + "!"; });
  EXPECT_EQ(read.buffers[0].bytes(), "a.b");
}

TEST(GltfDocument, FilesAreNotFetchedWithoutAReader) {
  const Problem problem = refusal_of(text_document(R"(,"buffers":[{"byteLength":3,"uri":"file:///etc/passwd"}])"));
  EXPECT_EQ(problem.code(), Code::mesh_unsupported);
  EXPECT_NE(std::string(problem.what()).find("not fetched"), std::string::npos);
}

TEST(GltfDocument, MalformedAndOversizedJsonIsRefused) {
  const auto refused = [](const std::string& text) { return refusal_of(text).code() == Code::mesh_not_gltf; };
  EXPECT_TRUE(refused(std::string(100'000, '[')));
  EXPECT_TRUE(refused(text_document(",\"extras\":" + std::string(80, '[') + std::string(80, ']'))));
  EXPECT_TRUE(refused(text_document(R"(,"a":1,"a":2)")));
  EXPECT_TRUE(refused(text_document(",")));
  EXPECT_TRUE(refused("{}"));
  std::string many = ",\"extras\":{\"x\":0";
  for (int i = 0; i < 5000; ++i) many += ",\"" + std::to_string(i) + "\":0";
  EXPECT_TRUE(refused(text_document(many + "}")));
}

TEST(GltfDocument, MoreThan256BuffersAreRefused) {
  std::string buffers = R"({"byteLength":0,"uri":"data:;base64,"})";
  for (int i = 1; i < 256; ++i) buffers += R"(,{"byteLength":0,"uri":"data:;base64,"})";
  EXPECT_NO_THROW((void)read_document(text_document(",\"buffers\":[" + buffers + "]")));
  const Problem problem = refusal_of(text_document(",\"buffers\":[{}," + buffers + "]"));
  EXPECT_EQ(problem.code(), Code::mesh_too_large);
  EXPECT_NE(std::string(problem.what()).find("256"), std::string::npos) << problem.what();
}

TEST(GltfDocument, OtherVersionsAndNewerCompressionAreRefusedByName) {
  EXPECT_EQ(refusal_of(R"({"asset":{"version":"1.0"}})").code(), Code::mesh_unsupported);
  const Problem newer = refusal_of(text_document(R"(,"extensionsRequired":["KHR_meshopt_compression"])"));
  EXPECT_EQ(newer.code(), Code::mesh_unsupported);
  EXPECT_NE(std::string(newer.what()).find("KHR_meshopt_compression"), std::string::npos);
  const Problem optional =
      refusal_of(text_document(R"(,"bufferViews":[{"extensions":{"KHR_meshopt_compression":{}}}])"));
  EXPECT_EQ(optional.code(), Code::mesh_unsupported);
  EXPECT_NE(std::string(optional.what()).find("bufferViews[0] has KHR_meshopt_compression"), std::string::npos);
}

TEST(GltfDocument, GlbAndGltfConvertIntoEachOther) {
  GltfScene scene;
  scene.add_mesh(test::icosahedron());
  const std::string glb = scene.glb();
  Document document = read_document(glb);
  const SceneFiles text = write_document(document, unchanged_pieces(document), FileKind::gltf, "my.bin");
  ASSERT_EQ(text.buffers.size(), 1U);
  EXPECT_EQ(text.buffers[0].first, "my.bin");
  EXPECT_EQ(text.buffers[0].second, scene.binary);
  Document again = read_document(text.document, [&](const std::string&) { return text.buffers[0].second; });
  EXPECT_EQ(write_document(again, unchanged_pieces(again), FileKind::glb).document, glb);
}

}  // namespace
}  // namespace papilio::proto::gltf
