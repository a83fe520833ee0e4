#include "proto/gltf/data_uri.h"

#include <array>
#include <cstdint>

namespace papilio::proto::gltf {
namespace {

constexpr std::string_view scheme = "data:";
constexpr std::string_view base64_mark = ";base64";
constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr uint8_t no_digit = 255;

constexpr std::array<uint8_t, 256> digit_values = [] {
  std::array<uint8_t, 256> values{};
  values.fill(no_digit);
  for (size_t i = 0; i < alphabet.size(); ++i)
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<uint8_t>(i);
  return values;
}();

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with(scheme); }

std::optional<std::string> decode_data_uri(std::string_view uri) {
  const size_t comma = uri.find(',');
  if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
  if (!uri.substr(0, comma).ends_with(base64_mark)) return std::nullopt;
  std::string_view text = uri.substr(comma + 1);
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    const uint8_t digit = digit_values[static_cast<unsigned char>(c)];
    if (digit == no_digit) return std::nullopt;
    bits = bits << 6 | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  return bytes;
}

std::string encode_data_uri(std::string_view bytes, std::string_view like) {
  std::string uri = is_data_uri(like) && like.find(',') != std::string_view::npos
                        ? std::string(like.substr(0, like.find(',') + 1))
                        : "data:application/octet-stream;base64,";
  uri.reserve(uri.size() + (bytes.size() + 2) / 3 * 4);
  for (size_t at = 0; at < bytes.size(); at += 3) {
    const size_t group = std::min<size_t>(3, bytes.size() - at);
    uint32_t bits = 0;
    for (size_t i = 0; i < 3; ++i)
      bits = bits << 8 | (i < group ? uint32_t{static_cast<unsigned char>(bytes[at + i])} : 0U);
    for (size_t i = 0; i < 4; ++i) uri += i <= group ? alphabet[bits >> (18 - 6 * i) & 63] : '=';
  }
  return uri;
}

}  // namespace papilio::proto::gltf
