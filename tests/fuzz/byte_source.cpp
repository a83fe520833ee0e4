#include "tests/fuzz/byte_source.h"

namespace papilio::fuzz {

uint32_t ByteSource::up_to(uint32_t most) {
  const uint32_t number = most < 256 ? raw<uint8_t>() : raw<uint32_t>();
  return most == UINT32_MAX ? number : number % (most + 1);
}

double ByteSource::between(double low, double high) {
  const auto kind = raw<uint8_t>();
  if (kind < 16) return low;
  if (kind < 32) return high;
  if (kind < 64) return low + (high - low) * 1e-6 * raw<uint16_t>();  // usual values are close to the lower bound
  return low + (high - low) * raw<uint16_t>() / 65535;
}

float ByteSource::coordinate() {
  const auto kind = raw<uint8_t>();
  if (kind < 160) return static_cast<float>(kind % 16) - 8;
  if (kind < 240) return static_cast<float>(raw<int16_t>()) / 1024;
  return raw<float>();
}

std::string_view ByteSource::rest() {
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  bytes_ = {};
  return text;
}

}  // namespace papilio::fuzz
