#include "tests/support/draco_tools.h"
#include "tests/support/mesh_file_fixture.h"
#include "tests/support/shapes.h"

// Detection of a file's format from its bytes.

namespace papilio::client {
namespace {

using ContentFormat = MeshFileTest;

Format format_of_bytes(std::string_view bytes) { return format_of_content("standard input", bytes); }

TEST_F(ContentFormat, EveryWrittenFileIsRecognized) {
  for (const Format format : kFormats)
    EXPECT_EQ(format_of_bytes(written(format, untidy())), format) << extension_of(format);
  EXPECT_EQ(format_of_bytes(test::encode_with_draco(test::icosahedron(), test::Method::edgebreaker)), Format::drc);
}

TEST_F(ContentFormat, CommentsAndByteOrderMarksAreSkipped) {
  const std::string mark = "\xef\xbb\xbf";
  for (const std::string& before : {std::string(), mark, std::string("# by hand\n\n"), mark + "#\n"}) {
    EXPECT_EQ(format_of_bytes(before + "o thing\n" + std::string(kThree) + "f 1 2 3\n"), Format::obj) << before;
    EXPECT_EQ(format_of_bytes(before + "COFF\n" + std::string(kOffBody)), Format::off) << before;
    EXPECT_EQ(format_of_bytes(before + std::string(kOffBody)), Format::off) << before;
  }
  EXPECT_EQ(format_of_bytes(mark + std::string(kStlText)), Format::stl);
  EXPECT_EQ(format_of_bytes(mark + ply_header("ascii", kXyz, kIndices) + kPlyText), Format::ply);
  EXPECT_EQ(format_of_bytes(binary_stl(tetrahedron(), "solid")), Format::stl);
}

TEST_F(ContentFormat, OtherBytesAreRefused) {
  const std::string stl = binary_stl(tetrahedron(), "");
  for (const std::string& bytes : {std::string("hello\n"), std::string("<html><body>1 2</body></html>"),
                                   std::string("\n"), std::string("5\n"), stl.substr(0, 200), std::string("v\0 0", 4)})
    EXPECT_THAT([&] { (void)format_of_bytes(bytes); },
                testing::ThrowsMessage<FileError>(HasSubstr("standard input: is of no format")))
        << bytes;
  EXPECT_THAT([&] { (void)format_of_bytes(std::string("\xff\xfev\0 \0", 6)); },
              testing::ThrowsMessage<FileError>(HasSubstr("UTF-16")));
}

}  // namespace
}  // namespace papilio::client
