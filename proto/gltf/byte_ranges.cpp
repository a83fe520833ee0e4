#include "proto/gltf/byte_ranges.h"

#include <algorithm>

namespace papilio::proto::gltf {
namespace {

constexpr uint64_t range_alignment = 16;

/// Returns the union of ranges, in ascending order, without empty ones.
std::vector<ByteRange> merged(std::vector<ByteRange> ranges) {
  std::ranges::sort(ranges, {}, &ByteRange::begin);
  std::vector<ByteRange> out;
  for (const ByteRange& range : ranges) {
    if (range.begin >= range.end) continue;
    if (!out.empty() && range.begin <= out.back().end)
      out.back().end = std::max(out.back().end, range.end);
    else
      out.push_back(range);
  }
  return out;
}

/// Returns what is in `a` and not in `b`, both merged.
std::vector<ByteRange> difference(const std::vector<ByteRange>& a, const std::vector<ByteRange>& b) {
  std::vector<ByteRange> out;
  size_t next = 0;
  for (ByteRange range : a) {
    while (next < b.size() && b[next].end <= range.begin) ++next;
    for (size_t i = next; i < b.size() && b[i].begin < range.end; ++i) {
      if (b[i].begin > range.begin) out.push_back({range.begin, b[i].begin});
      range.begin = std::max(range.begin, b[i].end);
    }
    if (range.begin < range.end) out.push_back(range);
  }
  return out;
}

bool is_padding(const ByteRange& range, const std::vector<ByteRange>& live, std::string_view bytes) {
  if (range.end - range.begin >= range_alignment) return false;
  const auto touches = [&](const ByteRange& other) { return other.begin < range.end && other.end > range.begin; };
  if (std::ranges::any_of(live, touches)) return false;
  return bytes.empty() || std::ranges::all_of(bytes.substr(range.begin, range.end - range.begin),
                                              [](char byte) { return byte == '\0'; });
}

}  // namespace

uint64_t KeptBytes::moved(uint64_t offset) const {
  const auto after = std::ranges::upper_bound(ranges, offset, {}, [](const KeptRange& r) { return r.old.begin; });
  if (after == ranges.begin()) return offset;
  const KeptRange& range = *(after - 1);
  return offset <= range.old.end ? range.begin + (offset - range.old.begin) : offset;
}

KeptBytes keep_bytes(uint64_t size, std::vector<ByteRange> removed, std::vector<ByteRange> live,
                     std::string_view bytes) {
  live = merged(std::move(live));
  const std::vector<ByteRange> dead = difference(merged(std::move(removed)), live);
  KeptBytes kept;
  for (const ByteRange& range : difference({{0, size}}, dead)) {
    if (!dead.empty() && is_padding(range, live, bytes)) continue;
    const uint64_t shift = (range.begin + range_alignment - kept.size % range_alignment) % range_alignment;
    kept.ranges.push_back({range, kept.size + shift});
    kept.size += shift + (range.end - range.begin);
  }
  return kept;
}

}  // namespace papilio::proto::gltf
