#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace papilio::server {

/// File of the viewer.
struct PageFile {
  std::string content_type;
  std::string entity_tag;  ///< strong entity tag with its quotes
  std::shared_ptr<const std::string> bytes;
  std::shared_ptr<const std::string> gzipped;  ///< bytes in gzip; null if there are none
};

/// Viewer (client/web) as built by Vite, in memory. Immutable and thread-safe.
class Page {
 public:
  /// Reads `folder`: index.html and assets/*, with x.gz beside files that are also sent compressed. Empty: no page.
  /// Throws std::runtime_error if index.html or another file cannot be read.
  explicit Page(const std::string& folder);

  /// Returns index.html; null without a page.
  [[nodiscard]] const PageFile* index() const;
  /// Returns a file in assets; null if there is none.
  [[nodiscard]] const PageFile* asset(std::string_view name) const;

 private:
  std::map<std::string, PageFile, std::less<>> files_;  ///< files by path in the folder
};

/// Returns the default folder of the page: `web` beside this program (as built), or ../share/papilio/web (as
/// installed); empty if neither exists.
[[nodiscard]] std::string default_page_folder();

}  // namespace papilio::server
