#include "server/accept.h"

#include <algorithm>
#include <cctype>

#include "proto/text.h"

namespace papilio::server {
namespace {

struct MediaRange {
  std::string type;  ///< type in lower case, without parameters
  double quality = 1;

  /// Returns the precision of a match: 3 by type, 2 by family, 1 by */*, 0 for no match.
  [[nodiscard]] int precision_for(const std::string& offered) const {
    if (type == offered) return 3;
    if (type == offered.substr(0, offered.find('/')) + "/*") return 2;
    return type == "*/*" ? 1 : 0;
  }
};

std::string normalise(std::string_view text) {
  std::string out;
  for (unsigned char c : text)
    if (std::isspace(c) == 0) out += static_cast<char>(std::tolower(c));
  return out;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> pieces;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    pieces.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return pieces;
}

std::vector<MediaRange> parse(std::string_view accept) {
  std::vector<MediaRange> ranges;
  for (const std::string& piece : split(normalise(accept), ',')) {
    const std::vector<std::string> fields = split(piece, ';');
    if (fields[0].empty()) continue;
    MediaRange range{fields[0]};
    for (const std::string& field : fields)
      if (field.starts_with("q=")) range.quality = proto::parse_number(field.substr(2)).value_or(0);
    ranges.push_back(range);
  }
  return ranges;
}

}  // namespace

std::optional<std::string> negotiate(std::string_view accept, const std::vector<std::string>& offered) {
  const std::vector<MediaRange> ranges = parse(accept);
  if (ranges.empty()) return offered.front();
  std::optional<std::string> best;
  double best_quality = 0;
  int best_precision = 0;
  for (const std::string& type : offered) {
    int precision = 0;
    double quality = 0;
    for (const MediaRange& range : ranges) {
      if (range.precision_for(type) <= precision) continue;
      precision = range.precision_for(type);
      quality = range.quality;
    }
    // At equal quality, the more precise match wins.
    if (quality > best_quality || (quality > 0 && quality == best_quality && precision > best_precision)) {
      best = type;
      best_quality = quality;
      best_precision = precision;
    }
  }
  return best;
}

bool accepts_gzip(std::string_view accept_encoding) {
  bool accepted = false;
  for (const MediaRange& coding : parse(accept_encoding)) {
    if (coding.type == "gzip" || coding.type == "x-gzip") return coding.quality > 0;
    if (coding.type == "*") accepted = coding.quality > 0;
  }
  return accepted;
}

}  // namespace papilio::server
