#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "client/mesh_file/number_text.h"

namespace papilio::client {

/// Forward scanner of the words and lines of a text, with the line number for messages. Blanks are space, tab, carriage
/// return, vertical tab and form feed.
class TextScanner {
 public:
  struct Dialect {
    bool hash_comments = false;        ///< whether `#` starts a comment, up to the end of the line
    bool backslash_continues = false;  ///< whether a backslash at the end of a line continues it on the next
  };

  /// Starts at the begin of `text`. `first_line`: number of its first line.
  TextScanner(std::string_view text, Dialect dialect, size_t first_line = 1)
      : text_(text), dialect_(dialect), line_(first_line) {}

  /// Returns the next word of this line, empty at its end.
  [[nodiscard]] std::string_view word();
  /// Returns the next word of this line or a later one, empty at the end of the text.
  [[nodiscard]] std::string_view word_anywhere();
  /// Returns the rest of this line without blanks at its ends, but with comments: names may have blanks and `#`.
  [[nodiscard]] std::string_view rest_of_line();
  /// Returns the next word of this line as a number. Throws `ParseError` if there is none.
  [[nodiscard]] float coordinate();
  [[nodiscard]] int64_t integer();

  /// Moves to the next line with a word. Returns false at the end of the text.
  bool next_line();
  /// Moves to the next word, on this line or a later one. Returns false at the end of the text.
  bool to_word();

  /// Returns the bytes from the start of the text to the end of this line, including its line feed.
  [[nodiscard]] size_t end_of_line() const;
  /// Returns the bytes between the current place and the end of the text.
  [[nodiscard]] size_t remaining() const { return text_.size() - position_; }

  /// Returns the number of the current line.
  [[nodiscard]] size_t line() const { return line_; }

  /// Throws `ParseError` with a message that starts with the number of the line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void skip_blanks();
  [[nodiscard]] bool at_line_end() const { return position_ == text_.size() || text_[position_] == '\n'; }
  /// Returns the length of a backslash and the line end it escapes, or 0.
  [[nodiscard]] size_t continuation() const;

  std::string_view text_;
  Dialect dialect_;
  size_t position_ = 0;
  size_t line_;
};

/// Returns the start of a word for a message: short, in quotes, without control characters.
[[nodiscard]] std::string quoted(std::string_view word);

}  // namespace papilio::client
