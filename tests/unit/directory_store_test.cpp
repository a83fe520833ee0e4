#include "server/store/directory_store.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "proto/problem.h"
#include "server/sha256.h"

namespace papilio::server {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using proto::Code;
using proto::Problem;

class StoreFolderTest : public testing::Test {
 protected:
  StoreFolderTest() : folder_(fs::temp_directory_path() / ("papilio-directory-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~StoreFolderTest() override {
    fs::permissions(folder_, fs::perms::all);
    fs::remove_all(folder_);
  }

  [[nodiscard]] fs::path file_of(const std::string& id) const { return folder_ / id.substr(0, 2) / (id + ".drc"); }
  static void write(const fs::path& file, const std::string& bytes) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
  }

  const fs::path folder_;
  const std::string mesh_ = std::string(200'000, 'm');
  const std::string id_ = sha256(mesh_);
  const fs::path file_ = file_of(id_);
};

/// Damage by other programs, disks and power failures.
struct Damage {
  const char* name;
  void (*make)(const fs::path& file);
};
void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

class DamagedMeshTest : public StoreFolderTest, public testing::WithParamInterface<Damage> {};
INSTANTIATE_TEST_SUITE_P(Damages, DamagedMeshTest,
                         testing::Values(Damage{"Truncated",
                                                [](const fs::path& file) { fs::resize_file(file, 100'000); }},
                                         Damage{"Empty", [](const fs::path& file) { fs::resize_file(file, 0); }},
                                         Damage{"Longer", [](const fs::path& file) { fs::resize_file(file, 200'001); }},
                                         Damage{"LastByteChanged",
                                                [](const fs::path& file) {
                                                  std::fstream out(file,
                                                                   std::ios::binary | std::ios::in | std::ios::out);
                                                  out.seekp(-1, std::ios::end).put('x');
                                                }},
                                         Damage{"EmptyFolder",
                                                [](const fs::path& file) {
                                                  fs::remove(file);
                                                  fs::create_directory(file);
                                                }}),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(DamagedMeshTest, GetOmitsADamagedMeshAndPutReplacesIt) {
  DirectoryStore store(folder_, 1 << 20);
  EXPECT_TRUE(store.put(id_, mesh_));
  GetParam().make(file_);
  EXPECT_EQ(store.get(id_), nullptr);
  EXPECT_TRUE(store.put(id_, mesh_));
  const MeshStore::Bytes got = store.get(id_);
  ASSERT_NE(got, nullptr);
  EXPECT_EQ(*got, mesh_);
  EXPECT_FALSE(store.put(id_, mesh_));
}

TEST_P(DamagedMeshTest, PutReplacesADamagedMeshAndCountsItOnce) {
  DirectoryStore store(folder_, 1 << 20);
  EXPECT_TRUE(store.put(id_, mesh_));
  GetParam().make(file_);
  DirectoryStore later(folder_, 1 << 20);  // counts the existing meshes
  EXPECT_TRUE(later.put(id_, mesh_));
  ASSERT_NE(later.get(id_), nullptr);
  EXPECT_EQ(later.usage()->meshes, 1U);
  EXPECT_EQ(later.usage()->bytes, mesh_.size());
}

TEST_F(StoreFolderTest, PutRepairsADamagedMeshInAFullStore) {
  DirectoryStore store(folder_, mesh_.size() + 10);
  EXPECT_TRUE(store.put(id_, mesh_));
  fs::resize_file(file_, mesh_.size() - 1);
  EXPECT_TRUE(store.put(id_, mesh_));
  ASSERT_NE(store.get(id_), nullptr);
}

// A `get` that removed a damaged file could remove the file that a concurrent `put` has written.
TEST_F(StoreFolderTest, GetDoesNotRemoveADamagedFile) {
  DirectoryStore store(folder_, 1 << 20);
  store.put(id_, mesh_);
  fs::resize_file(file_, 10);
  EXPECT_EQ(store.get(id_), nullptr);
  EXPECT_TRUE(fs::exists(file_));
  EXPECT_TRUE(store.remove(id_));
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(StoreFolderTest, FolderInPlaceOfAMeshIsKeptAndNoMesh) {
  write(file_ / "of_others", "bytes");
  DirectoryStore store(folder_, 1 << 20);
  EXPECT_EQ(store.usage()->meshes, 0U);
  EXPECT_EQ(store.get(id_), nullptr);
  EXPECT_FALSE(store.contains(id_));
  EXPECT_FALSE(store.remove(id_));
  try {
    store.put(id_, mesh_);
    ADD_FAILURE() << "was put";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::store_unavailable);
  }
  EXPECT_TRUE(fs::exists(file_ / "of_others"));
  EXPECT_EQ(store.usage()->bytes, 0U);
}

TEST_F(StoreFolderTest, FileInPlaceOfAFolderIsNoMesh) {
  write(file_.parent_path(), "bytes");
  DirectoryStore store(folder_, 1 << 20);
  EXPECT_EQ(store.get(id_), nullptr);
  EXPECT_FALSE(store.contains(id_));
  EXPECT_FALSE(store.remove(id_));
  EXPECT_THROW(store.put(id_, mesh_), Problem);
}

/// Drops root's effective user for its lifetime: root ignores permissions.
class NotRoot {
 public:
  NotRoot() {
    if (::geteuid() == 0) {
      EXPECT_EQ(::seteuid(65534), 0);
    }
  }
  ~NotRoot() { EXPECT_EQ(::seteuid(::getuid()), 0); }
  NotRoot(const NotRoot&) = delete;
  NotRoot& operator=(const NotRoot&) = delete;
};

TEST_F(StoreFolderTest, UnreadableFoldersAreLoggedAndSkipped) {
  fs::permissions(folder_, fs::perms::all);
  const fs::path closed = folder_ / "lost+found";
  fs::create_directory(closed);
  fs::permissions(closed, fs::perms::none);
  testing::internal::CaptureStdout();
  EXPECT_NO_THROW({
    const NotRoot user;
    DirectoryStore store(folder_, 10'000'000);
    for (int i = 0; i < 20; ++i) store.put(sha256(std::to_string(i)), std::to_string(i));
    DirectoryStore later(folder_, 1'000);
    EXPECT_EQ(later.usage()->meshes, 20U);
    EXPECT_THROW(later.put(id_, mesh_), Problem);  // counts again
    EXPECT_EQ(later.usage()->meshes, 20U);
  });
  fs::permissions(closed, fs::perms::all);
  const std::string log = testing::internal::GetCapturedStdout();
  size_t warnings = 0;
  for (size_t at = log.find(closed.string()); at != std::string::npos; at = log.find(closed.string(), at + 1))
    ++warnings;
  EXPECT_EQ(warnings, 2U) << log;  // one per store
}

TEST_F(StoreFolderTest, UnreadableDirectoryIsRefusedWithItsName) {
  fs::permissions(folder_, static_cast<fs::perms>(0333));
  const NotRoot user;
  try {
    const DirectoryStore store(folder_, 1'000);
    ADD_FAILURE() << "was opened";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(folder_.string() + ": Permission denied"), std::string::npos)
        << error.what();
  }
}

TEST_F(StoreFolderTest, DirectoryThatBecomesUnreadableIsUnavailable) {
  DirectoryStore store(folder_, 1'000);
  fs::permissions(folder_, static_cast<fs::perms>(0333));
  const NotRoot user;
  try {
    store.put(id_, mesh_);  // larger than the store: meshes are counted again before the refusal
    ADD_FAILURE() << "was put";
  } catch (const Problem& problem) {
    EXPECT_EQ(problem.code(), Code::store_unavailable);
  }
}

/// Waits until the condition holds; returns false after a minute.
bool eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

TEST_F(StoreFolderTest, RunningStoreRemovesAbandonedPartFiles) {
  const DirectoryStore store(folder_, 1'000, 10ms);
  const fs::path abandoned = folder_ / "ab" / "12-34.part";
  const fs::path locked = folder_ / "ab" / "12-35.part";
  const fs::path young = folder_ / "ab" / "12-36.part";
  const fs::path foreign = folder_ / "ab" / "notes.part";
  const fs::path second = folder_ / "cd" / "12-37.part";
  for (const fs::path& file : {locked, young, foreign, abandoned, second}) write(file, "bytes");
  const int writer = ::open(locked.c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  const auto hour_ago = fs::file_time_type::clock::now() - 1h;
  for (const fs::path& file : {locked, foreign, abandoned, second}) fs::last_write_time(file, hour_ago);
  EXPECT_TRUE(eventually([&] { return !fs::exists(abandoned) && !fs::exists(second); }));
  for (const fs::path& file : {locked, young, foreign}) EXPECT_TRUE(fs::exists(file)) << file;
  ::close(writer);  // as the end of its process would
  EXPECT_TRUE(eventually([&] { return !fs::exists(locked); }));
  for (const fs::path& file : {young, foreign}) EXPECT_TRUE(fs::exists(file)) << file;
}

}  // namespace
}  // namespace papilio::server
