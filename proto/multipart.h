#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// multipart/mixed (RFC 2046) as the service streams it: every part has a Content-Length, so that a reader
// knows a part's end without searching for the boundary.

namespace papilio::proto {

/// One part: its header fields in order, and its bytes.
struct Part {
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;

  /// A field's value, "" when absent; names match without regard to case.
  [[nodiscard]] std::string header(std::string_view name) const;
};

class MultipartWriter {
 public:
  /// 1 to 70 characters of [A-Za-z0-9._-]. A random one is made when none is given.
  explicit MultipartWriter(std::string boundary = {});
  /// The value of the answer's Content-Type.
  [[nodiscard]] std::string content_type() const;
  /// The bytes of one part; Content-Length is added to its headers.
  [[nodiscard]] std::string part(const Part& part) const;
  /// The bytes after the last part.
  [[nodiscard]] std::string end() const;

 private:
  std::string boundary_;
};

/// Reads what `MultipartWriter` writes, in pieces of any size.
class MultipartReader {
 public:
  /// `content_type`: that of the answer. `max_part_bytes` bounds a part's body. Throws `Problem` bad_request
  /// when it is not multipart/mixed with a boundary.
  MultipartReader(std::string_view content_type, uint64_t max_part_bytes, std::function<void(Part)> on_part);
  /// Takes the next bytes; calls `on_part` for each part completed. Throws `Problem` bad_request when they
  /// are no such body.
  void feed(std::string_view bytes);
  /// Call after the last bytes: throws `Problem` bad_request when the closing boundary has not come, so
  /// nothing may be missing.
  void finish() const;

 private:
  bool step();

  std::string delimiter_;  ///< "--" and the boundary
  uint64_t max_part_bytes_;
  std::function<void(Part)> on_part_;
  std::string pending_;
  Part part_;
  uint64_t body_size_ = 0;
  enum class State { delimiter, headers, body, done } state_ = State::delimiter;
};

}  // namespace papilio::proto
