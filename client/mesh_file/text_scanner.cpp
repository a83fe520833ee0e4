#include "client/mesh_file/text_scanner.h"

#include <algorithm>

#include "client/mesh_file/formats.h"

namespace papilio::client {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

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
