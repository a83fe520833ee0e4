#include "server/store/store_files.h"

#include "server/log.h"
#include "server/sha256.h"
#include "server/store/new_file.h"

namespace papilio::server {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view mesh_extension = ".drc";

bool is_absent(const std::error_code& error) { return error == std::errc::no_such_file_or_directory; }

}  // namespace

fs::path StoreFiles::file_of(const std::string& id) const {
  return directory_ / id.substr(0, 2) / (id + std::string(mesh_extension));
}

MeshStore::Usage StoreFiles::count() {
  MeshStore::Usage counted;
  visit([&](const fs::directory_entry& file) {
    const std::string id = file.path().stem().string();
    if (!is_sha256(id) || file.path() != file_of(id)) return;
    std::error_code gone;
    if (!file.is_regular_file(gone)) return;
    const uint64_t bytes = file.file_size(gone);
    if (gone) return;
    ++counted.meshes;
    counted.bytes += bytes;
  });
  return counted;
}

void StoreFiles::remove_abandoned() {
  visit([](const fs::directory_entry& file) { remove_if_abandoned(file.path()); });
}

void StoreFiles::visit(const Visit& visit_file) {
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_)) {
    std::error_code error;
    const bool is_folder = entry.is_directory(error);
    if (is_folder)
      visit_folder(entry.path(), visit_file);
    else if (!error)
      visit_file(entry);
    else if (!is_absent(error))
      warn_once(entry.path(), error.message());
  }
}

void StoreFiles::visit_folder(const fs::path& folder, const Visit& visit_file) {
  std::error_code error;
  for (auto file = fs::directory_iterator(folder, error); !error && file != fs::directory_iterator();
       file.increment(error))
    visit_file(*file);
  if (error && !is_absent(error)) warn_once(folder, error.message());
}

void StoreFiles::warn_once(const fs::path& folder, const std::string& reason) {
  {
    const std::lock_guard lock(mutex_);
    if (!warned_.insert(folder).second) return;
  }
  log_event("warning", "store", {{"path", folder.string()}, {"reason", "is skipped: " + reason}});
}

}  // namespace papilio::server
