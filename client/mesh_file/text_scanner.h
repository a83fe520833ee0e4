#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace papilio::client {

/// The number that `word` is, whole, whatever the locale; a leading plus is allowed. False if it is no number
/// or too large for the type. One too small for it becomes the nearest that is not, 0 or subnormal.
[[nodiscard]] bool parse_number(std::string_view word, float& value);
[[nodiscard]] bool parse_number(std::string_view word, double& value);
[[nodiscard]] bool parse_number(std::string_view word, int64_t& value);

/// Reads words of a text in which some lines matter: goes forward only, and knows the line for messages.
/// Blanks are space, tab, carriage return, vertical tab and form feed.
class TextScanner {
 public:
  struct Dialect {
    bool hash_comments = false;        ///< `#` begins a comment, up to the end of the line
    bool backslash_continues = false;  ///< a backslash at the end of a line joins the next to it
  };

  /// `first_line` is the number of the first line, where `text` is the rest of a longer one.
  TextScanner(std::string_view text, Dialect dialect, size_t first_line = 1)
      : text_(text), dialect_(dialect), line_(first_line) {}

  /// The next word of this line, empty at its end.
  [[nodiscard]] std::string_view word();
  /// The next word of this line or a later one, empty at the end of the text.
  [[nodiscard]] std::string_view word_anywhere();
  /// What is left of this line without the blanks around it, comments included: names may have blanks and `#`.
  [[nodiscard]] std::string_view rest_of_line();
  /// The next word of this line as a number. Throws `ParseError` if there is none.
  [[nodiscard]] float coordinate();
  [[nodiscard]] int64_t integer();

  /// To the next line that has a word. False at the end of the text.
  bool next_line();
  /// To the first word from here, on this line or a later one. False at the end of the text.
  bool to_word();

  /// Bytes from the start of the text to the end of this line, its line feed included.
  [[nodiscard]] size_t end_of_line() const;
  /// Bytes between the current place and the end of the text.
  [[nodiscard]] size_t remaining() const { return text_.size() - position_; }

  /// The number of the current line.
  [[nodiscard]] size_t line() const { return line_; }

  /// Throws `ParseError` that begins with the number of the line.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void skip_blanks();
  [[nodiscard]] bool at_line_end() const { return position_ == text_.size() || text_[position_] == '\n'; }
  /// The length of a backslash and the line end it hides, or 0.
  [[nodiscard]] size_t continuation() const;

  std::string_view text_;
  Dialect dialect_;
  size_t position_ = 0;
  size_t line_;
};

/// The start of a word as it may be shown in a message: short, in quotes, no control characters.
[[nodiscard]] std::string quoted(std::string_view word);

}  // namespace papilio::client
