#pragma once

#include <string>
#include <string_view>

#include "server/http/http.h"

// The head of a request, parsed strictly. cpp-httplib's own parser is not used: it percent-decodes the values
// of header fields (so `Transfer-Encoding: %63hunked` is chunked to it and to nobody in front of it), passes
// over lines that it cannot read, and drops repeated query fields. Whoever stands in front of this server
// must see the same request as it does.

namespace papilio::server {

/// True when both are the same but for the case of ASCII letters.
[[nodiscard]] bool same_ignoring_case(std::string_view a, std::string_view b);
/// Without spaces and tabs at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] std::string lower_case(std::string_view text);
/// True for a non-empty `token` of RFC 9110, of which methods and names of fields are made.
[[nodiscard]] bool is_token(std::string_view text);
/// True for a host, which may be empty, with or without a port: a name, an IPv4 address or an IPv6 address in brackets
/// (RFC 3986, section 3.2). User information is refused, as RFC 9110, section 4.2.4 advises.
[[nodiscard]] bool is_authority(std::string_view text);
/// Parses one line of a head or of a trailer, without its CR LF. Throws `Problem` bad_request.
[[nodiscard]] std::pair<std::string, std::string> parse_field(std::string_view line);

struct Head {
  std::string method;
  std::string target;  ///< as it was sent; visible ASCII only
  std::string path;    ///< percent-decoded, without control characters; "/" where an absolute target has none
  Fields query;        ///< percent-decoded, in the original order, duplicates kept
  int minor_version = 1;
  Fields fields;

  /// The value of the field, "" when there is none; of several lines one list (RFC 9110, section 5.2), so that what
  /// takes one value only refuses two.
  [[nodiscard]] std::string field(std::string_view name) const;
  [[nodiscard]] size_t count(std::string_view name) const;
  /// True when one such field's comma-separated list holds the token.
  [[nodiscard]] bool lists(std::string_view name, std::string_view token) const;
};

/// Parses the text up to and with the empty line into `head`. Throws `Problem` (bad_request) on anything that
/// could be read in two ways; `head` then holds what was read before.
void parse_head(std::string_view text, Head& head);

}  // namespace papilio::server
