#include "proto/multipart.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <random>
#include <utility>

#include "proto/problem.h"
#include "proto/text.h"

namespace papilio::proto {
namespace {

constexpr size_t longest_header = 16 << 10;
constexpr size_t most_headers = 100;

bool equal_without_case(std::string_view a, std::string_view b) {
  return std::ranges::equal(a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string random_boundary() {
  static constexpr std::string_view digits = "0123456789abcdef";
  std::random_device random;
  std::string text = "papilio-";
  for (int i = 0; i < 24; ++i) text += digits[random() & 15U];
  return text;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

[[noreturn]] void fail(const std::string& what) { throw Problem(Code::bad_request, "The multipart body " + what); }

std::string boundary_of(std::string_view content_type) {
  const size_t semicolon = content_type.find(';');
  if (!equal_without_case(trim(content_type.substr(0, semicolon)), "multipart/mixed"))
    throw Problem(Code::bad_request, "Content-Type must be multipart/mixed, not " + quote(content_type) + ".");
  while (semicolon != std::string_view::npos) {
    content_type.remove_prefix(content_type.find(';') + 1);
    std::string_view field = trim(content_type.substr(0, content_type.find(';')));
    if (equal_without_case(field.substr(0, 9), "boundary=")) {
      field.remove_prefix(9);
      if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
      if (!field.empty() && field.size() <= 70) return std::string(field);
    }
    if (content_type.find(';') == std::string_view::npos) break;
  }
  fail("has no boundary of 1 to 70 characters.");
}

}  // namespace

std::string BodyPart::header(std::string_view name) const {
  for (const auto& [key, value] : headers)
    if (equal_without_case(key, name)) return value;
  return {};
}

MultipartWriter::MultipartWriter(std::string boundary) : boundary_(std::move(boundary)) {
  if (boundary_.empty()) boundary_ = random_boundary();
}

std::string MultipartWriter::content_type() const { return "multipart/mixed; boundary=" + boundary_; }

std::string MultipartWriter::part(const BodyPart& part) const {
  std::string out = "--" + boundary_ + "\r\n";
  for (const auto& [name, value] : part.headers) out += name + ": " + value + "\r\n";
  out += "Content-Length: " + std::to_string(part.body.size()) + "\r\n\r\n";
  out += part.body;
  return out + "\r\n";
}

std::string MultipartWriter::end() const { return "--" + boundary_ + "--\r\n"; }

MultipartReader::MultipartReader(std::string_view content_type, uint64_t max_part_bytes,
                                 std::function<void(BodyPart)> on_part)
    : delimiter_("--" + boundary_of(content_type)), max_part_bytes_(max_part_bytes), on_part_(std::move(on_part)) {}

void MultipartReader::feed(std::string_view bytes) {
  pending_ += bytes;
  while (step()) {
  }
}

void MultipartReader::finish() const {
  if (state_ != State::done) fail("ends before its closing boundary. Send the request again.");
}

bool MultipartReader::step() {
  switch (state_) {
    case State::delimiter: {
      const size_t end = pending_.find("\r\n");
      if (end == std::string::npos) {
        if (pending_.size() > delimiter_.size() + 4) fail("has other bytes in place of a boundary.");
        return false;
      }
      const std::string line = pending_.substr(0, end);
      if (line != delimiter_ && line != delimiter_ + "--") fail("has other bytes in place of a boundary.");
      state_ = line == delimiter_ ? State::headers : State::done;
      pending_.erase(0, end + 2);
      return true;
    }
    case State::headers: {
      const size_t end = pending_.find("\r\n");
      if (end == std::string::npos) {
        if (pending_.size() > longest_header)
          fail("has a header line of more than " + std::to_string(longest_header) + " bytes.");
        return false;
      }
      const std::string line = pending_.substr(0, end);
      pending_.erase(0, end + 2);
      if (!line.empty()) {
        const size_t colon = line.find(':');
        if (colon == std::string::npos) fail("has a header line without a colon: " + quote(line) + ".");
        if (part_.headers.size() >= most_headers)
          fail("has a part with more than " + std::to_string(most_headers) + " header lines.");
        part_.headers.emplace_back(line.substr(0, colon), trim(std::string_view(line).substr(colon + 1)));
        return true;
      }
      const std::string length = part_.header("Content-Length");
      const auto [last, error] = std::from_chars(length.data(), length.data() + length.size(), body_size_);
      if (error != std::errc() || last != length.data() + length.size() || length.empty())
        fail("has a part without a valid Content-Length.");
      if (body_size_ > max_part_bytes_)
        fail("has a part of " + length + " bytes; the limit is " + std::to_string(max_part_bytes_) + ".");
      state_ = State::body;
      return true;
    }
    case State::body:
      if (pending_.size() < body_size_ + 2) return false;
      if (pending_.compare(body_size_, 2, "\r\n") != 0) fail("has a part longer than its Content-Length.");
      part_.body = pending_.substr(0, body_size_);
      pending_.erase(0, body_size_ + 2);
      state_ = State::delimiter;
      on_part_(std::exchange(part_, {}));
      return true;
    case State::done:
      break;
  }
  return false;
}

}  // namespace papilio::proto
