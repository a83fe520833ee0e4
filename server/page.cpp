#include "server/page.h"

#include <filesystem>
#include <stdexcept>

#include "server/file_bytes.h"
#include "server/sha256.h"

namespace papilio::server {
namespace {

namespace fs = std::filesystem;

std::string content_type(const fs::path& file) {
  static const std::map<std::string, std::string> types{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".wasm", "application/wasm"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
  };
  const auto type = types.find(file.extension().string());
  return type == types.end() ? "application/octet-stream" : type->second;
}

PageFile read_page_file(const fs::path& file) {
  const auto bytes = read_file(file);
  if (bytes == nullptr) throw std::runtime_error("--web: " + file.string() + " cannot be read.");
  return {.content_type = content_type(file),
          .entity_tag = '"' + sha256(*bytes).substr(0, 32) + '"',
          .bytes = bytes,
          .gzipped = read_file(file.string() + ".gz")};
}

}  // namespace

Page::Page(const std::string& folder) {
  if (folder.empty()) return;
  files_["index.html"] = read_page_file(fs::path(folder) / "index.html");
  std::error_code error;
  for (fs::directory_iterator entry(fs::path(folder) / "assets", error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() != ".gz")
      files_["assets/" + entry->path().filename().string()] = read_page_file(entry->path());
  if (error) throw std::runtime_error("--web: " + folder + "/assets: " + error.message());
}

const PageFile* Page::index() const {
  const auto file = files_.find("index.html");
  return file == files_.end() ? nullptr : &file->second;
}

const PageFile* Page::asset(std::string_view name) const {
  const auto file = files_.find("assets/" + std::string(name));
  return file == files_.end() ? nullptr : &file->second;
}

std::string default_page_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return "";
  for (const fs::path& folder : {program / "web", program.parent_path() / "share/papilio/web"})
    if (fs::is_regular_file(folder / "index.html", error)) return folder.string();
  return "";
}

}  // namespace papilio::server
