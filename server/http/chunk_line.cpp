#include "server/http/chunk_line.h"

#include <algorithm>
#include <charconv>

#include "proto/problem.h"
#include "proto/text.h"
#include "server/http/head.h"

namespace papilio::server {
namespace {

/// Scanner of the elements of a chunk line.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : rest_(text) {}

  [[nodiscard]] bool at_end() const { return rest_.empty(); }

  bool take(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  /// Skips spaces and tabs.
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.size(), rest_.find_first_not_of(" \t"))); }
  bool take_number(uint64_t& number) {
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number, 16);
    if (error == std::errc::invalid_argument) return false;
    if (error == std::errc::result_out_of_range) number = UINT64_MAX;
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    return true;
  }
  bool take_token() {
    size_t size = 0;
    while (size < rest_.size() && is_token(rest_.substr(size, 1))) ++size;
    rest_.remove_prefix(size);
    return size > 0;
  }
  bool take_quoted_string() {
    if (!take('"')) return false;
    while (!at_end() && rest_.front() != '"') {
      (void)take('\\');
      if (at_end() || is_control(rest_.front())) return false;
      rest_.remove_prefix(1);
    }
    return take('"');
  }

 private:
  static bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; }

  std::string_view rest_;
};

bool take_extension(Scanner& scanner) {
  scanner.skip_blanks();
  if (!scanner.take(';')) return false;
  scanner.skip_blanks();
  if (!scanner.take_token()) return false;
  Scanner behind = scanner;
  behind.skip_blanks();
  if (!behind.take('=')) return true;
  behind.skip_blanks();
  scanner = behind;
  return scanner.take_token() || scanner.take_quoted_string();
}

}  // namespace

uint64_t chunk_size(std::string_view line) {
  Scanner scanner(line);
  uint64_t size = 0;
  bool good = scanner.take_number(size);
  while (good && !scanner.at_end()) good = take_extension(scanner);
  if (!good)
    throw proto::Problem(proto::Code::bad_request,
                         "The chunk line " + proto::quote(line) +
                             " is not valid. It must be a hexadecimal size, with extensions of the form ;name=value.");
  return size;
}

}  // namespace papilio::server
