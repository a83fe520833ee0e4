#include "server/http/body.h"

#include <algorithm>
#include <charconv>

#include "proto/text.h"
#include "server/http/chunk_line.h"

namespace papilio::server {
namespace {

using proto::Code;
using proto::Problem;

constexpr size_t longest_chunk_line = 256;
constexpr size_t longest_trailer = 8 << 10;
constexpr uint64_t first_reserve = 1 << 20;

Problem too_large(uint64_t limit) {
  return {Code::body_too_large, "A body may have " + std::to_string(limit) + " bytes."};
}

Problem damaged_chunks() { return {Code::bad_request, "The body's chunked encoding is damaged."}; }

/// Parses a text of decimal digits only; a number beyond 64 bits becomes the largest one.
bool parse_number(std::string_view text, uint64_t& number) {
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, number);
  if (error == std::errc::result_out_of_range) number = UINT64_MAX;
  return error != std::errc::invalid_argument && last == end;
}

}  // namespace

Framing framing_of(const Head& head) {
  const size_t hosts = head.count("Host");
  if (hosts > 1 || (hosts == 0 && head.minor_version == 1))
    throw Problem(Code::bad_request, "Exactly one Host header is required.");
  const std::string host = head.field("Host");
  if (!host.empty() && !is_authority(host))
    throw Problem(Code::bad_request, "Host is " + proto::quote(host) + ", which is not valid. Send HOST or HOST:PORT.");
  const size_t lengths = head.count("Content-Length");
  const size_t encodings = head.count("Transfer-Encoding");
  if (lengths + encodings == 0) return {};
  if (lengths + encodings > 1)
    throw Problem(Code::bad_request, "A request can have only one Content-Length or Transfer-Encoding header.");
  if (encodings == 1) {
    if (head.minor_version == 0 || !same_ignoring_case(head.field("Transfer-Encoding"), "chunked"))
      throw Problem(Code::bad_request, "Unsupported Transfer-Encoding. Use `chunked`, with HTTP/1.1.");
    return {Framing::Kind::chunked};
  }
  Framing framing{Framing::Kind::length};
  if (!parse_number(head.field("Content-Length"), framing.length))
    throw Problem(Code::bad_request, "Content-Length must be a whole number of bytes.");
  if (framing.length == 0) framing.kind = Framing::Kind::none;
  return framing;
}

void refuse_unreadable(const Head& head, const Framing& framing, uint64_t limit) {
  const bool has_length = head.count("Content-Length") + head.count("Transfer-Encoding") > 0;
  if (!has_length && (head.method == "POST" || head.method == "PUT" || head.method == "PATCH"))
    throw Problem(Code::length_required, "Send Content-Length, or Transfer-Encoding: chunked.");
  if (head.count("Range") > 0) throw Problem(Code::range_not_supported, "Omit the Range header.");
  for (const auto& [name, value] : head.fields)
    if (same_ignoring_case(name, "Content-Encoding") && !same_ignoring_case(value, "identity"))
      throw Problem(Code::unsupported_encoding, "Send the body as it is, without Content-Encoding.");
  if (framing.length > limit) throw too_large(limit);
}

std::string BodyReader::read() {
  std::string bytes;
  if (complete_) return bytes;
  connection_.begin_body();
  if (framing_.kind == Framing::Kind::chunked) {
    read_chunks(bytes);
  } else {
    bytes.reserve(std::min(framing_.length, first_reserve));
    read_exactly(framing_.length, bytes);
  }
  complete_ = true;
  return bytes;
}

void BodyReader::read_exactly(uint64_t count, std::string& bytes) {
  if (count > limit_ - bytes.size()) throw too_large(limit_);
  while (count > 0) {
    const std::string_view some = connection_.peek().substr(0, count);
    hold(bytes.size() + some.size());
    bytes += some;
    count -= some.size();
    connection_.consume(some.size());
  }
}

// Grows the share in steps, as all requests contend for its counter.
void BodyReader::hold(uint64_t bytes) {
  constexpr uint64_t step = 256 << 10;
  if (held_ != nullptr && !held_->grow_to(std::min((bytes + step - 1) / step * step, limit_)))
    throw Problem(Code::busy,
                  "The bodies of all requests together exceed the memory limit. Try again after the time in "
                  "Retry-After.");
}

void BodyReader::read_chunks(std::string& bytes) {
  for (;;) {
    const uint64_t size = chunk_size(read_line());
    if (size == 0) break;
    read_exactly(size, bytes);
    if (!read_line().empty()) throw damaged_chunks();
  }
  size_t trailer = 0;
  for (std::string line = read_line(); !line.empty(); line = read_line()) {
    trailer += line.size();
    if (trailer > longest_trailer) throw damaged_chunks();
    (void)parse_field(line);
  }
}

std::string BodyReader::read_line() {
  std::string line;
  while (!line.ends_with('\n')) {
    const std::string_view held = connection_.peek();
    const size_t feed = held.find('\n');
    const std::string_view some = feed == std::string_view::npos ? held : held.substr(0, feed + 1);
    if (line.size() + some.size() > longest_chunk_line) throw damaged_chunks();
    line += some;
    connection_.consume(some.size());
  }
  if (!line.ends_with("\r\n")) throw damaged_chunks();
  line.resize(line.size() - 2);
  return line;
}

}  // namespace papilio::server
