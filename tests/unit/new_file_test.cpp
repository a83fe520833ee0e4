#include "server/store/new_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "server/file_bytes.h"

namespace papilio::server {
namespace {

namespace fs = std::filesystem;

class NewFileTest : public testing::TestWithParam<NewFile::Until> {
 protected:
  NewFileTest() : folder_(fs::temp_directory_path() / ("papilio-new-file-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    if (GetParam() == NewFile::Until::unnamed && supported_until(folder_) != NewFile::Until::unnamed)
      unsupported_ = true;
  }
  ~NewFileTest() override { fs::remove_all(folder_); }
  void SetUp() override {
    if (unsupported_) GTEST_SKIP() << "the file system has no unnamed files";
  }
  [[nodiscard]] int entries() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  const fs::path folder_;
  const fs::path file_ = folder_ / "file";
  bool unsupported_ = false;
};
INSTANTIATE_TEST_SUITE_P(Kinds, NewFileTest, testing::Values(NewFile::Until::unnamed, NewFile::Until::part),
                         [](const auto& instance) {
                           return instance.param == NewFile::Until::unnamed ? "Unnamed" : "Part";
                         });

TEST_P(NewFileTest, FileHasItsNameOnlyOncePublished) {
  {
    NewFile file(folder_, GetParam());
    ASSERT_TRUE(file.is_open());
    ASSERT_TRUE(file.write_and_sync("bytes"));
    EXPECT_EQ(entries(), GetParam() == NewFile::Until::unnamed ? 0 : 1);
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_TRUE(file.publish(file_));
    EXPECT_EQ(entries(), 1);
  }
  EXPECT_TRUE(file_holds(file_, "bytes"));
}

TEST_P(NewFileTest, UnpublishedFileIsRemoved) {
  {
    const NewFile file(folder_, GetParam());
    ASSERT_TRUE(file.write_and_sync("bytes"));
  }
  EXPECT_EQ(entries(), 0);
}

TEST_P(NewFileTest, PublishReplacesAFileOrAnEmptyFolder) {
  for (const bool is_folder : {false, true}) {
    fs::remove(file_);
    if (is_folder)
      fs::create_directory(file_);
    else
      std::ofstream(file_) << "old";
    NewFile file(folder_, GetParam());
    ASSERT_TRUE(file.write_and_sync("new"));
    EXPECT_TRUE(file.publish(file_));
    EXPECT_TRUE(file_holds(file_, "new"));
    EXPECT_EQ(entries(), 1);
  }
}

TEST_P(NewFileTest, PublishKeepsAFolderWithFiles) {
  fs::create_directory(file_);
  std::ofstream(file_ / "of_others") << "old";
  {
    NewFile file(folder_, GetParam());
    ASSERT_TRUE(file.write_and_sync("new"));
    EXPECT_FALSE(file.publish(file_));
    EXPECT_EQ(errno, ENOTEMPTY);
  }
  EXPECT_TRUE(file_holds(file_ / "of_others", "old"));
  EXPECT_EQ(entries(), 1);
}

TEST(FileBytes, OnlyRegularFilesAreRead) {
  const fs::path folder = fs::temp_directory_path() / ("papilio-file-bytes-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  EXPECT_EQ(read_file(folder), nullptr);
  EXPECT_EQ(errno, EISDIR);
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(read_file(folder / "pipe"), nullptr);  // without a writer: opening must not block
  EXPECT_EQ(read_file(folder / "none"), nullptr);
  EXPECT_EQ(errno, ENOENT);
  const std::string bytes(200'000, 'b');
  std::ofstream(folder / "file") << bytes;
  EXPECT_EQ(*read_file(folder / "file"), bytes);
  EXPECT_TRUE(file_holds(folder / "file", bytes));
  EXPECT_FALSE(file_holds(folder / "file", bytes.substr(1)));
  EXPECT_FALSE(file_holds(folder / "file", bytes.substr(1) + 'c'));
  EXPECT_FALSE(file_holds(folder, ""));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace papilio::server
