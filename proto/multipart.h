#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// multipart/mixed (RFC 2046) with a Content-Length in every part, so a reader need not search for the boundary.

namespace papilio::proto {

/// Part of a multipart body: header fields in order, and content.
struct BodyPart {
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;

  /// Returns the value of a field, "" if absent. Names are case-insensitive.
  [[nodiscard]] std::string header(std::string_view name) const;
};

/// Writer of a multipart body.
class MultipartWriter {
 public:
  /// `boundary`: 1 to 70 characters of [A-Za-z0-9._-]; empty: a random one.
  explicit MultipartWriter(std::string boundary = {});
  /// Returns the value of the response's Content-Type.
  [[nodiscard]] std::string content_type() const;
  /// Returns the bytes of a part, with Content-Length added to its headers.
  [[nodiscard]] std::string part(const BodyPart& part) const;
  /// Returns the bytes after the last part.
  [[nodiscard]] std::string end() const;

 private:
  std::string boundary_;
};

/// Incremental reader of bodies written by `MultipartWriter`.
class MultipartReader {
 public:
  /// `content_type`: of the response. `max_part_bytes`: limit of a part's body. Throws `Problem` bad_request unless the
  /// type is multipart/mixed with a boundary.
  MultipartReader(std::string_view content_type, uint64_t max_part_bytes, std::function<void(BodyPart)> on_part);
  /// Reads the next bytes and calls `on_part` for each completed part. Throws `Problem` bad_request for a malformed
  /// body.
  void feed(std::string_view bytes);
  /// Ends the body. Throws `Problem` bad_request if the closing boundary is missing.
  void finish() const;

 private:
  /// Reads one element off `pending_`. Returns false if it is incomplete.
  bool step();

  std::string delimiter_;  ///< "--" and the boundary
  uint64_t max_part_bytes_;
  std::function<void(BodyPart)> on_part_;
  std::string pending_;
  BodyPart part_;
  uint64_t body_size_ = 0;
  enum class State { delimiter, headers, body, done } state_ = State::delimiter;
};

}  // namespace papilio::proto
