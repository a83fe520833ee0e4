#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/http.h"

namespace papilio::server {

/// Access keys that clients send as `Authorization: Bearer KEY`. Thread-safe.
///
/// A file has one key per line: a name for the log, the key or `sha256:` and its SHA-256 in hexadecimal, and `manage`
/// if the key may also delete meshes and read metrics. The case of `sha256:` and of the digits is ignored; other
/// digests are refused. Empty lines and lines that start with # are skipped. Several keys may be valid at once, so that
/// a key can be replaced without interruption.
///
///     viewer   3f9a...
///     operator sha256:9b74c989...   manage
class Keys {
 public:
  /// Reads the file. Throws std::runtime_error with the file and the line.
  explicit Keys(std::filesystem::path file);

  /// Reloads the file. Throws as the constructor; the old keys then stay in use.
  void reload();
  /// Returns the name of the request's key. Throws `Problem`: unauthorized without a key or for an unknown one,
  /// forbidden if it lacks the right. Compares all keys, each in constant time.
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
  std::shared_ptr<const List> list_;  ///< keys; the pointer is guarded by mutex_
};

}  // namespace papilio::server
