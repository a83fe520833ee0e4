#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

/// The keys that clients show as `Authorization: Bearer KEY`. Any thread may use it.
///
/// A file has one key a line: a name for the log, the key or `sha256:` and the SHA-256 of the key in hexadecimal, and
/// `manage` where the key may also delete meshes and read the metrics. The case of `sha256:` and of the digits does not
/// matter; what looks like another digest is refused. Empty lines and lines that begin with # are passed over. Several
/// keys are valid at once, so that one can be changed for another without a pause.
///
///     viewer   3f9a...
///     operator sha256:9b74c989...   manage
class Keys {
 public:
  /// Throws std::runtime_error, naming the file and the line.
  explicit Keys(std::filesystem::path file);

  /// Reads the file again; throws as the constructor does, and the keys stay as they were.
  void reload();
  /// The name of the request's key. Throws `Problem`: unauthorized when there is none or it is not known, forbidden
  /// when it does not have the right that is asked for. Every key is compared, each in constant time.
  [[nodiscard]] std::string authorize(const Request& request, Access access) const;
  [[nodiscard]] size_t size() const;

 private:
  struct Key {
    std::string name;
    std::string digest;  ///< SHA-256 of the key
    bool manages = false;
  };
  using List = std::vector<Key>;
  [[nodiscard]] static List read(const std::filesystem::path& file);
  [[nodiscard]] std::shared_ptr<const List> list() const;

  const std::filesystem::path file_;
  mutable std::mutex mutex_;
  std::shared_ptr<const List> list_;  ///< guarded by mutex_
};

}  // namespace papilio::server
