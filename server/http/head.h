#pragma once

#include <string>
#include <string_view>

#include "server/http/http.h"

// Strict parser of a request's head. A proxy in front of this server must read each request identically. So
// cpp-httplib's parser is not used: it percent-decodes header values (`Transfer-Encoding: %63hunked` is chunked to it,
// and to no proxy), skips lines that it cannot read, and drops repeated query fields.

namespace papilio::server {

/// Returns whether both are equal, ignoring the case of ASCII letters.
[[nodiscard]] bool same_ignoring_case(std::string_view a, std::string_view b);
/// Returns the text without spaces and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] std::string lower_case(std::string_view text);
/// Returns whether the text is a non-empty `token` of RFC 9110, such as a method or a field name.
[[nodiscard]] bool is_token(std::string_view text);
/// Returns whether the text is a host, perhaps empty, with or without a port: a name, an IPv4 address or an IPv6
/// address in brackets (RFC 3986, section 3.2). Refuses user information, as recommended by RFC 9110, section 4.2.4.
[[nodiscard]] bool is_authority(std::string_view text);
/// Parses one line of a head or of a trailer, without its CR LF. Throws `Problem` bad_request.
[[nodiscard]] std::pair<std::string, std::string> parse_field(std::string_view line);

struct Head {
  std::string method;
  std::string target;  ///< target as sent; visible ASCII only
  std::string path;    ///< percent-decoded path, without control characters; "/" for an absolute target without one
  Fields query;        ///< percent-decoded query fields in the original order, with duplicates
  int minor_version = 1;
  Fields fields;

  /// Returns the value of a field, "" if absent. Several lines are joined to one list (RFC 9110, section 5.2), so that
  /// a field of a single value refuses two.
  [[nodiscard]] std::string field(std::string_view name) const;
  [[nodiscard]] size_t count(std::string_view name) const;
  /// Returns whether the comma-separated list of a field contains the token.
  [[nodiscard]] bool lists(std::string_view name, std::string_view token) const;
};

/// Parses the text, including the empty line, into `head`. Throws `Problem` bad_request for anything ambiguous; `head`
/// then has the fields parsed before.
void parse_head(std::string_view text, Head& head);

}  // namespace papilio::server
