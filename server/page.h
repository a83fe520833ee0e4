#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace papilio::server {

/// A file of the viewer.
struct PageFile {
  std::string content_type;
  std::string entity_tag;  ///< strong, quotes included
  std::shared_ptr<const std::string> bytes;
  std::shared_ptr<const std::string> gzipped;  ///< the same in gzip; null where that is not there
};

/// The viewer (client/web) as Vite built it, in memory, never changed: threads may share one object.
class Page {
 public:
  /// `folder` has index.html and assets/*, and x.gz beside what is to be sent compressed too. Empty: there is no page.
  /// Throws std::runtime_error where index.html or another file cannot be read.
  explicit Page(const std::string& folder);

  /// Null where there is no page.
  [[nodiscard]] const PageFile* index() const;
  /// `name`: of a file in assets. Null where there is none.
  [[nodiscard]] const PageFile* asset(std::string_view name) const;

 private:
  std::map<std::string, PageFile, std::less<>> files_;  ///< by their paths in the folder
};

/// Where the page is when the operator does not say: `web` beside this program (as built), or ../share/papilio/web (as
/// installed); empty where it is in neither.
[[nodiscard]] std::string default_page_folder();

}  // namespace papilio::server
