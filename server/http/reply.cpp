#include "server/http/reply.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>

#include "server/http/head.h"

namespace papilio::server {
namespace {

std::string_view reason(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
    case 202:
      return "Accepted";
    case 204:
      return "No Content";
    case 301:
      return "Moved Permanently";
    case 302:
      return "Found";
    case 303:
      return "See Other";
    case 304:
      return "Not Modified";
    case 307:
      return "Temporary Redirect";
    case 308:
      return "Permanent Redirect";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 406:
      return "Not Acceptable";
    case 408:
      return "Request Timeout";
    case 409:
      return "Conflict";
    case 411:
      return "Length Required";
    case 412:
      return "Precondition Failed";
    case 413:
      return "Content Too Large";
    case 415:
      return "Unsupported Media Type";
    case 416:
      return "Range Not Satisfiable";
    case 422:
      return "Unprocessable Content";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 499:
      return "Client Closed Request";
    case 500:
      return "Internal Server Error";
    case 503:
      return "Service Unavailable";
    case 507:
      return "Insufficient Storage";
    default:
      return "Unnamed";
  }
}

std::string date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 40> text{};
  // The program always uses the C locale.
  return {text.data(), std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc)};
}

bool has_body(int status) { return status >= 200 && status != 204 && status != 304; }

const std::string& bytes_of(const Response& response) { return response.shared ? *response.shared : response.body; }

bool is_of_the_connection(std::string_view name) {
  constexpr std::array<std::string_view, 5> names{"Connection", "Content-Length", "Transfer-Encoding", "Date",
                                                  "X-Request-Id"};
  return std::ranges::any_of(names, [&](std::string_view n) { return same_ignoring_case(n, name); });
}

/// Appends a header field. Replaces line breaks in a value, which would start another header line.
void add_field(std::string& head, std::string_view name, std::string_view value) {
  if (!is_token(name)) return;
  head += name;
  head += ": ";
  const size_t begin = head.size();
  head += value;
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::replace_if(head.begin() + static_cast<ptrdiff_t>(begin), head.end(), is_control, ' ');
  head += "\r\n";
}

std::string reply_head(const Response& response, const Delivery& delivery) {
  std::string head;
  head.reserve(1 << 10);
  head += "HTTP/1.1 " + std::to_string(response.status) + " ";
  head += reason(response.status);
  head += "\r\n";
  add_field(head, "Date", date());
  add_field(head, "X-Request-Id", delivery.request_id);
  if (!response.content_type.empty()) {
    add_field(head, "Content-Type", response.content_type);
    add_field(head, "X-Content-Type-Options", "nosniff");
  }
  bool says_cache = false;
  for (const auto& [name, value] : response.headers) {
    if (is_of_the_connection(name)) continue;
    says_cache = says_cache || same_ignoring_case(name, "Cache-Control");
    add_field(head, name, value);
  }
  if (response.status >= 400 && !says_cache) add_field(head, "Cache-Control", "no-store");
  if (has_body(response.status)) {
    if (!response.stream) add_field(head, "Content-Length", std::to_string(bytes_of(response).size()));
    if (response.stream && delivery.chunked) add_field(head, "Transfer-Encoding", "chunked");
  }
  if (!delivery.keep_alive) add_field(head, "Connection", "close");
  return head + "\r\n";
}

class ConnectionSink final : public Sink {
 public:
  ConnectionSink(Connection& connection, bool chunked, HeldAnswers::Share& held)
      : connection_(connection), chunked_(chunked), held_(held) {}

  bool write(std::string_view bytes) override {
    lost_ = lost_ || connection_.peer_gone();
    if (lost_) return false;
    if (bytes.empty()) return true;  // an empty chunk would end the answer
    lost_ = !(chunked_ ? write_chunk(bytes) : connection_.write(bytes));
    return !lost_;
  }

  void hold(uint64_t bytes) override { held_.hold(bytes); }

  /// Returns whether the client was gone before the whole stream was written.
  [[nodiscard]] bool lost() const { return lost_; }

 private:
  bool write_chunk(std::string_view bytes) {
    std::array<char, 16> size{};
    const char* end = std::to_chars(size.begin(), size.end(), bytes.size(), 16).ptr;
    return connection_.write({size.data(), static_cast<size_t>(end - size.data())}, true) &&
           connection_.write("\r\n", true) && connection_.write(bytes, true) && connection_.write("\r\n");
  }

  Connection& connection_;
  const bool chunked_;
  HeldAnswers::Share& held_;
  bool lost_ = false;
};

}  // namespace

Response problem_response(const proto::Problem& problem, const std::string& request_id) {
  Response response;
  response.status = problem.status();
  response.content_type = "application/problem+json";
  response.headers.emplace_back("Cache-Control", "no-store");
  if (problem.status() == 429 || problem.status() == 503) response.headers.emplace_back("Retry-After", "1");
  if (problem.status() == 401) response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"papilio\"");
  response.body = problem.json(request_id);
  return response;
}

bool send_reply(Connection& connection, const Response& response, const Delivery& delivery, HeldAnswers::Share& held) {
  const bool with_body = has_body(response.status) && !delivery.head_only;
  const bool with_bytes = with_body && !response.stream && !bytes_of(response).empty();
  if (with_bytes) held.hold(bytes_of(response).size(), response.shared.get());
  if (!connection.write(reply_head(response, delivery), with_bytes)) return false;
  if (with_bytes) return connection.write(bytes_of(response));
  if (!with_body || !response.stream) return true;
  ConnectionSink sink(connection, delivery.chunked, held);
  try {
    response.stream(sink);
  } catch (...) {
    return false;  // without its last chunk, the answer is recognizably cut
  }
  return !sink.lost() && (!delivery.chunked || connection.write("0\r\n\r\n"));
}

}  // namespace papilio::server
