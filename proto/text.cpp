#include "proto/text.h"

#include <array>
#include <bit>
#include <charconv>

namespace papilio::proto {

std::string format_rounded(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4).ptr;
  return {text.data(), end};
}

std::string shorten(std::string_view text) {
  constexpr size_t longest = 80;
  std::string out;
  for (char c : text.substr(0, longest)) out += c >= ' ' && c <= '~' ? c : '?';
  return text.size() > longest ? out + "..." : out;
}

namespace {

/// Decodes the first character of `text`; nothing for invalid UTF-8. Sets `size` to its bytes, else 1.
std::optional<char32_t> first_character(std::string_view text, size_t& size) {
  size = 1;
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const auto ones = static_cast<size_t>(std::countl_one(byte(0)));
  if (ones == 0) return byte(0);
  if (ones == 1 || ones > 4 || text.size() < ones) return std::nullopt;
  char32_t character = byte(0) & (0x7FU >> ones);
  for (size_t i = 1; i < ones; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return std::nullopt;
    character = character << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  if (character < least[ones] || character > 0x10FFFF || surrogate) return std::nullopt;
  size = ones;
  return character;
}

bool is_control(char32_t c) {
  const bool reverses =
      c == 0x61C || c == 0x200E || c == 0x200F || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
  const bool breaks_line = c == 0x2028 || c == 0x2029;
  return c < 0x20 || (c >= 0x7F && c <= 0x9F) || reverses || breaks_line;
}

/// Appends \xNN or \uNNNN.
void append_escape(std::string& out, char32_t c) {
  constexpr std::string_view digits = "0123456789abcdef";
  out += c < 0x100 ? "\\x" : "\\u";
  for (int shift = c < 0x100 ? 4 : 12; shift >= 0; shift -= 4) out += digits[c >> static_cast<unsigned>(shift) & 15U];
}

}  // namespace

std::string escape_controls(std::string_view text) {
  std::string out;
  for (size_t size = 0; !text.empty(); text.remove_prefix(size)) {
    const std::optional<char32_t> character = first_character(text, size);
    if (!character || is_control(*character))
      append_escape(out, character.value_or(static_cast<unsigned char>(text[0])));
    else
      out += text.substr(0, size);
  }
  return out;
}

void append_item(std::string& list, std::string_view separator, std::string_view item) {
  if (!list.empty()) list += separator;
  list += item;
}

std::string quote(std::string_view text) { return '"' + shorten(text) + '"'; }

}  // namespace papilio::proto
