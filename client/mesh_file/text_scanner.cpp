#include "client/mesh_file/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "client/mesh_file/formats.h"

namespace papilio::client {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

template <class Number>
std::errc parse_whole(std::string_view word, Number& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::errc::invalid_argument;
  return error;
}

}  // namespace

bool parse_number(std::string_view word, float& value) {
  const std::errc error = parse_whole(word, value);
  if (error != std::errc::result_out_of_range) return error == std::errc();
  // from_chars does not distinguish too large from too small.
  double wide = 0;
  if (!parse_number(word, wide) || std::abs(wide) >= 1) return false;
  value = static_cast<float>(wide);
  return true;
}

bool parse_number(std::string_view word, double& value) {
  const std::errc error = parse_whole(word, value);
  if (error != std::errc::result_out_of_range) return error == std::errc();
  long double wide = 0;
  if (parse_whole(word, wide) != std::errc() || std::abs(wide) >= 1) return false;
  value = static_cast<double>(wide);
  return true;
}

bool parse_number(std::string_view word, int64_t& value) { return parse_whole(word, value) == std::errc(); }

std::string_view TextScanner::word() {
  skip_blanks();
  const size_t start = position_;
  while (!at_line_end() && !is_blank(text_[position_]) && continuation() == 0) ++position_;
  return text_.substr(start, position_ - start);
}

std::string_view TextScanner::word_anywhere() {
  to_word();
  return word();
}

std::string_view TextScanner::rest_of_line() {
  std::string_view rest = text_.substr(position_, text_.find('\n', position_) - position_);
  position_ += rest.size();
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  while (!rest.empty() && is_blank(rest.back())) rest.remove_suffix(1);
  return rest;
}

float TextScanner::coordinate() {
  const std::string_view found = word();
  float value = 0;
  if (!parse_number(found, value)) fail("expected a number that a float can hold, found " + quoted(found));
  return value;
}

int64_t TextScanner::integer() {
  const std::string_view found = word();
  int64_t value = 0;
  if (!parse_number(found, value)) fail("expected a whole number, found " + quoted(found));
  return value;
}

bool TextScanner::next_line() {
  while (skip_blanks(), !at_line_end()) ++position_;
  return to_word();
}

bool TextScanner::to_word() {
  while (skip_blanks(), at_line_end()) {
    if (position_ == text_.size()) return false;
    ++position_;
    ++line_;
  }
  return true;
}

size_t TextScanner::end_of_line() const { return std::min(text_.find('\n', position_), text_.size() - 1) + 1; }

void TextScanner::fail(const std::string& what) const {
  throw ParseError("line " + std::to_string(line_) + ": " + what);
}

void TextScanner::skip_blanks() {
  for (; !at_line_end(); ++position_) {
    if (const size_t hidden = continuation(); hidden != 0) {
      position_ += hidden - 1;
      ++line_;
    } else if (dialect_.hash_comments && text_[position_] == '#') {
      position_ = std::min(text_.find('\n', position_), text_.size()) - 1;
    } else if (!is_blank(text_[position_])) {
      return;
    }
  }
}

size_t TextScanner::continuation() const {
  if (!dialect_.backslash_continues || text_[position_] != '\\') return 0;
  const std::string_view rest = text_.substr(position_ + 1, 2);
  if (rest.starts_with('\n')) return 2;
  return rest == "\r\n" ? 3 : 0;
}

std::string quoted(std::string_view word) {
  if (word.empty()) return "the end of the line";
  std::string shown(word.substr(0, 24));
  std::ranges::replace_if(
      shown, [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return "'" + shown + (word.size() > 24 ? "…'" : "'");
}

}  // namespace papilio::client
