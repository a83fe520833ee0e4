#pragma once

#include <charconv>
#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

namespace papilio::client {

/// Appends a blank and a number, floats with the shortest exact digits.
template <class Number>
requires std::integral<Number> || std::floating_point<Number>
void append_number(std::string& text, Number number, char blank = ' ') {
  char digits[32];
  const auto written = std::to_chars(digits, digits + sizeof digits, number);
  text += blank;
  text.append(digits, written.ptr);
}

/// Appends a line of a keyword and numbers.
template <class Number>
void append_line(std::string& text, std::string_view keyword, std::initializer_list<Number> numbers) {
  text += keyword;
  for (const Number number : numbers) append_number(text, number);
  text += '\n';
}

}  // namespace papilio::client
