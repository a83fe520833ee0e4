#include "client/mesh_file/byte_order_mark.h"

#include <string>

#include "client/mesh_file/formats.h"

namespace papilio::client {

std::string_view skip_byte_order_mark(std::string_view text) {
  using namespace std::string_view_literals;
  const auto refuse = [](const std::string& encoding) {
    throw ParseError("is " + encoding + " text; save it as UTF-8 or ASCII");
  };
  // UTF-32 first: in little-endian order its mark begins with UTF-16's.
  if (text.starts_with("\xff\xfe\0\0"sv) || text.starts_with("\0\0\xfe\xff"sv)) refuse("UTF-32");
  if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv)) refuse("UTF-16");
  constexpr std::string_view utf8 = "\xef\xbb\xbf";
  if (text.starts_with(utf8)) text.remove_prefix(utf8.size());
  return text;
}

}  // namespace papilio::client
