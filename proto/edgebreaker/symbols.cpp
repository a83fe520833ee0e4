#include "proto/edgebreaker/symbols.h"

#include <draco/compression/entropy/rans_symbol_encoder.h>
#include <draco/compression/entropy/symbol_encoding.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/core/varint_encoding.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "papilio/buffer.h"
#include "proto/edgebreaker/logarithm.h"

namespace papilio::proto::edgebreaker {
namespace {

constexpr int max_raw_bits = 18;  ///< largest bit length of a symbol in raw coding

/// Frequencies of symbols, and of the bit lengths of values.
struct SymbolStatistics {
  std::vector<uint64_t> counts;            ///< [largest symbol + 1]
  std::array<uint64_t, 33> bit_lengths{};  ///< [bits] number of values whose largest component has that bit length
};

uint32_t bit_length(uint32_t symbol) { return static_cast<uint32_t>(std::bit_width(symbol | 1U)); }

/// Histogram of numbers, of which a few are frequent. Each number has four counters, used in rotation: an increment
/// depends on the previous increment of the same counter.
class Histogram {
 public:
  explicit Histogram(size_t size) : counts_(size, Counters{}) {}
  void add(uint32_t number, size_t index) { ++counts_[number][index % counters]; }
  [[nodiscard]] uint64_t count(size_t number) const {
    const Counters& c = counts_[number];
    return uint64_t{c[0]} + c[1] + c[2] + c[3];
  }

 private:
  static constexpr size_t counters = 4;
  using Counters = std::array<uint32_t, counters>;
  Buffer<Counters> counts_;
};

/// Returns the bit length of a value's largest component.
uint32_t value_bit_length(const uint32_t* value, uint32_t components) {
  uint32_t bits = 0;
  for (uint32_t k = 0; k < components; ++k) bits |= value[k];
  return bit_length(bits);
}

SymbolStatistics count_symbols(std::span<const uint32_t> symbols, uint32_t components, uint32_t largest) {
  SymbolStatistics statistics;
  Histogram bit_lengths(statistics.bit_lengths.size());
  size_t value = 0;
  for (size_t i = 0; i < symbols.size(); i += components)
    bit_lengths.add(value_bit_length(&symbols[i], components), value++);
  for (size_t i = 0; i < statistics.bit_lengths.size(); ++i) statistics.bit_lengths[i] = bit_lengths.count(i);

  Histogram counts(size_t{largest} + 1);
  for (size_t i = 0; i < symbols.size(); ++i) counts.add(symbols[i], i);
  statistics.counts.resize(size_t{largest} + 1);
  for (uint32_t i = 0; i <= largest; ++i) statistics.counts[i] = counts.count(i);
  return statistics;
}

/// Estimates the bits of the coded symbols and of their table, with libdraco's formula. Sets `different` to the number
/// of symbols that occur.
template <class Counts>
int64_t estimate_bits(const Counts& counts, size_t symbols, int table_size, int& different) {
  double bits = 0;
  different = 0;
  for (const auto count : counts) {
    if (count == 0) continue;
    ++different;
    bits += static_cast<double>(count) * logarithm_to_base_2(static_cast<double>(count) / static_cast<double>(symbols));
  }
  return static_cast<int64_t>(-bits) +
         draco::ApproximateRAnsFrequencyTableBits(table_size < 0 ? different : table_size, different);
}

/// Table of probabilities of a rANS coder, and its transition from state to state.
class RansTable {
 public:
  /// Probabilities are in units of 2^-precision_bits.
  explicit RansTable(int precision_bits) : precision_(1U << precision_bits) {}

  /// Writes the table with libdraco and reads it back.
  template <int unique_bits>
  void make(std::span<const uint64_t> counts, draco::EncoderBuffer& out) {
    const size_t start = out.size();
    draco::RAnsSymbolEncoder<unique_bits> maker;
    if (!maker.Create(counts.data(), static_cast<int>(counts.size()), &out))
      throw std::runtime_error("Draco's entropy coder refuses the symbols");
    read_table(std::span(out.data() + start, out.size() - start));
  }

  [[nodiscard]] uint32_t min_state() const { return 4 * precision_; }

  /// Returns the state after the symbol and appends the bytes that it emits at `at`. All possible next states are
  /// computed in parallel, as each state depends on the previous one.
  [[nodiscard]] uint64_t put(uint32_t number, uint64_t state, uint8_t*& at) const {
    const Symbol& symbol = symbols_[number];
    const uint64_t limit = symbol.limit;
    const bool emits_one = state >= limit;
    const bool emits_two = state >= limit << 8U;
    const bool emits_three = state >= limit << 16U;
    const auto bytes = static_cast<uint32_t>(state);
    std::memcpy(at, &bytes, sizeof bytes);
    at += int{emits_one} + int{emits_two} + int{emits_three};
    const uint64_t after_none = next(symbol, state);
    const uint64_t after_one = next(symbol, state >> 8U);
    const uint64_t after_two = next(symbol, state >> 16U);
    if (__builtin_expect(static_cast<int64_t>(emits_three), 0) != 0) return next(symbol, state >> 24U);
    // Branch-free: the number of bytes is unpredictable.
    return after_none ^ ((after_none ^ after_one) & mask_if(emits_one)) ^
           ((after_one ^ after_two) & mask_if(emits_two));
  }
  static constexpr size_t max_bytes_per_symbol = 3;

 private:
  struct Symbol {
    uint64_t inverse;     ///< 2^inverse_bits / probability, rounded up: the reciprocal for divisions of states
    uint32_t limit;       ///< smallest state that emits bytes
    uint32_t complement;  ///< one minus the probability
    uint32_t cumulative;  ///< sum of the probabilities of the symbols before
  };
  /// Divided states are below `limit`, so products need at most 62 bits and quotients are exact.
  static constexpr uint32_t inverse_bits = 52;
  static constexpr uint32_t limit_per_probability = 4 * 256;

  void read_table(std::span<const char> bytes) {
    draco::DecoderBuffer in;
    in.Init(bytes.data(), bytes.size());
    uint32_t count = 0;
    draco::DecodeVarint(&count, &in);
    uint32_t cumulative = 0;
    const auto add = [&](uint32_t probability) {
      const uint64_t inverse = probability > 0 ? ((uint64_t{1} << inverse_bits) - 1) / probability + 1 : 0;
      symbols_.push_back({inverse, limit_per_probability * probability, precision_ - probability, cumulative});
      cumulative += probability;
    };
    while (symbols_.size() < count) {
      uint8_t byte = 0;
      in.Decode(&byte);
      uint32_t value = byte >> 2U;
      const uint32_t more = byte & 3U;
      if (more == 3) {  // value + 1 symbols do not occur
        for (uint32_t i = 0; i <= value; ++i) add(0);
        continue;
      }
      for (uint32_t b = 0; b < more; ++b) {
        in.Decode(&byte);
        value |= uint32_t{byte} << (8 * (b + 1) - 2);
      }
      add(value);
    }
  }

  /// Returns all bits set if the condition holds, else 0.
  static uint64_t mask_if(bool condition) { return -static_cast<uint64_t>(condition); }
  [[nodiscard]] uint64_t next(const Symbol& symbol, uint64_t state) const {
    const uint64_t quotient = (state * symbol.inverse) >> inverse_bits;
    return state + quotient * symbol.complement + symbol.cumulative;
  }

  uint32_t precision_;
  Buffer<Symbol> symbols_;
};

/// rANS coder of a list of symbols. Symbols are coded last to first and decoded first to last.
class RansStream {
 public:
  RansStream(std::span<const uint32_t> symbols, RansTable table)
      : symbols_(symbols),
        table_(std::move(table)),
        bytes_(symbols.size() * RansTable::max_bytes_per_symbol + sizeof(uint32_t)),
        at_(bytes_.data()),
        state_(table_.min_state()) {}

  void run() {
    uint64_t state = state_;
    for (size_t i = symbols_.size(); i-- > 0;) state = table_.put(symbols_[i], state, at_);
    state_ = state;
    symbols_ = {};
  }
  /// Codes symbols of both streams in turns until one is done. The two chains of dependent states overlap.
  static void run(RansStream& a, RansStream& b) {
    const size_t count = std::min(a.symbols_.size(), b.symbols_.size());
    const uint32_t* of_a = a.symbols_.data() + a.symbols_.size();
    const uint32_t* of_b = b.symbols_.data() + b.symbols_.size();
    uint64_t state_a = a.state_;
    uint64_t state_b = b.state_;
    uint8_t* at_a = a.at_;
    uint8_t* at_b = b.at_;
    for (size_t i = 0; i < count; ++i) {
      state_a = a.table_.put(*--of_a, state_a, at_a);
      state_b = b.table_.put(*--of_b, state_b, at_b);
    }
    a.advance(count, state_a, at_a);
    b.advance(count, state_b, at_b);
  }
  [[nodiscard]] bool is_done() const { return symbols_.empty(); }

  /// Takes ownership of the list of the symbols, and of bytes to write after the stream.
  void own(Buffer<uint32_t> symbols, Buffer<uint8_t> suffix) {
    owned_ = std::move(symbols);
    suffix_ = std::move(suffix);
  }

  void write(draco::EncoderBuffer& out) {
    append_state();
    const auto size = static_cast<size_t>(at_ - bytes_.data());
    draco::EncodeVarint<uint64_t>(size, &out);
    out.Encode(bytes_.data(), size);
    out.Encode(suffix_.data(), suffix_.size());
  }

 private:
  void advance(size_t count, uint64_t state, uint8_t* at) {
    symbols_ = symbols_.first(symbols_.size() - count);
    state_ = state;
    at_ = at;
  }

  /// Appends the final state, in one to four bytes.
  void append_state() {
    auto state = static_cast<uint32_t>(state_ - table_.min_state());
    const uint32_t more = state < 1U << 6U ? 0 : state < 1U << 14U ? 1 : state < 1U << 22U ? 2 : 3;
    state |= more << (8 * more + 6);
    std::memcpy(at_, &state, sizeof state);
    at_ += 1 + more;
  }

  std::span<const uint32_t> symbols_;  ///< symbols not yet coded
  RansTable table_;
  Buffer<uint8_t> bytes_;
  uint8_t* at_;
  uint64_t state_;
  Buffer<uint32_t> owned_;
  Buffer<uint8_t> suffix_;
};

/// Returns the precision of probabilities, in bits: by the number of different symbols and the level.
int unique_bits_at(int different, int compression_level) {
  int bits = std::bit_width(static_cast<uint32_t>(different));
  if (bits > max_raw_bits)
    throw std::runtime_error("Draco's entropy coder cannot code more than 2^18 different symbols");
  if (compression_level < 4)
    bits -= 2;
  else if (compression_level < 6)
    bits -= 1;
  else if (compression_level > 9)
    bits += 2;
  else if (compression_level > 7)
    bits += 1;
  return std::clamp(bits, 1, max_raw_bits);
}

/// Calls visit.template operator()<bits>(). `bits`: 1 to `max`.
template <int max, class Visit>
void with_constant(int bits, const Visit& visit) {
  if constexpr (max > 1) {
    if (bits < max) return with_constant<max - 1>(bits, visit);
  }
  visit.template operator()<max>();
}

/// Returns the bit length of each value's largest component. [values]
Buffer<uint32_t> find_bit_lengths(std::span<const uint32_t> symbols, uint32_t components) {
  Buffer<uint32_t> lengths(symbols.size() / components);
  for (size_t i = 0; i < lengths.size(); ++i) lengths[i] = value_bit_length(&symbols[i * components], components);
  return lengths;
}

/// Packs the bits of all components, lowest bit first. `lengths` [values]: bit length of a component.
Buffer<uint8_t> pack(std::span<const uint32_t> symbols, uint32_t components, const Buffer<uint32_t>& lengths) {
  auto bytes = Buffer<uint8_t>::for_overwrite(symbols.size() * sizeof(uint32_t) + sizeof(uint64_t));
  uint8_t* at = bytes.data();
  uint64_t bits = 0;
  uint32_t bit_count = 0;
  for (size_t i = 0; i < symbols.size(); ++i) {
    bits |= uint64_t{symbols[i]} << bit_count;
    bit_count += lengths[i / components];
    std::memcpy(at, &bits, sizeof bits);
    at += bit_count / 8;
    bits >>= bit_count / 8 * 8;
    bit_count %= 8;
  }
  bytes.resize(static_cast<size_t>(at - bytes.data()) + (bit_count > 0 ? 1 : 0));
  return bytes;
}

/// Writes the header of the tagged coding. Returns the stream of bit lengths with the packed bits behind it.
RansStream prepare_tagged(std::span<const uint32_t> symbols, uint32_t components, const SymbolStatistics& statistics,
                          draco::EncoderBuffer& out) {
  constexpr int tag_bits = 5;
  out.Encode(static_cast<uint8_t>(draco::SYMBOL_CODING_TAGGED));
  RansTable table(draco::ComputeRAnsPrecisionFromUniqueSymbolsBitLength(tag_bits));
  table.make<tag_bits>(std::span(statistics.bit_lengths).first(1U << tag_bits), out);
  Buffer<uint32_t> lengths = find_bit_lengths(symbols, components);
  Buffer<uint8_t> packed = pack(symbols, components, lengths);
  RansStream stream(lengths, std::move(table));
  stream.own(std::move(lengths), std::move(packed));
  return stream;
}

/// Writes the header of the shorter coding and returns its stream. Symbols of more than 18 bits are written by
/// libdraco, and nothing is returned.
std::optional<RansStream> prepare(std::span<const uint32_t> symbols, uint32_t components, int compression_level,
                                  draco::EncoderBuffer& out) {
  uint32_t largest = 0;
  for (uint32_t symbol : symbols) largest = std::max(largest, symbol);
  if (bit_length(largest) <= max_raw_bits) {
    const SymbolStatistics statistics = count_symbols(symbols, components, largest);
    int different = 0;
    int64_t tagged_bits = estimate_bits(statistics.bit_lengths, symbols.size() / components, -1, different);
    for (uint32_t bits = 1; bits < statistics.bit_lengths.size(); ++bits)
      tagged_bits += static_cast<int64_t>(bits * statistics.bit_lengths[bits] * components);
    const int64_t raw_bits = estimate_bits(statistics.counts, symbols.size(), static_cast<int>(largest), different);
    if (tagged_bits >= raw_bits) {
      const int unique_bits = unique_bits_at(different, compression_level);
      out.Encode(static_cast<uint8_t>(draco::SYMBOL_CODING_RAW));
      out.Encode(static_cast<uint8_t>(unique_bits));
      RansTable table(draco::ComputeRAnsPrecisionFromUniqueSymbolsBitLength(unique_bits));
      with_constant<max_raw_bits>(unique_bits, [&]<int bits>() { table.make<bits>(statistics.counts, out); });
      return RansStream(symbols, std::move(table));
    }
    return prepare_tagged(symbols, components, statistics, out);
  }
  draco::Options options;
  draco::SetSymbolEncodingCompressionLevel(&options, compression_level);
  if (!draco::EncodeSymbols(symbols.data(), static_cast<int>(symbols.size()), static_cast<int>(components), &options,
                            &out))
    throw std::runtime_error("Draco's entropy coder refuses the symbols");
  return std::nullopt;
}

}  // namespace

void write_symbols(std::span<const uint32_t> symbols, uint32_t components, int compression_level,
                   draco::EncoderBuffer& out) {
  if (symbols.empty()) return;
  std::optional<RansStream> stream = prepare(symbols, components, compression_level, out);
  if (!stream) return;
  stream->run();
  stream->write(out);
}

void write_symbol_lists(std::span<const Buffer<uint32_t>> lists, draco::EncoderBuffer& out) {
  std::vector<draco::EncoderBuffer> written(lists.size());
  std::vector<std::optional<RansStream>> streams(lists.size());
  RansStream* running = nullptr;
  for (size_t i = 0; i < lists.size(); ++i) {
    draco::EncodeVarint<uint32_t>(static_cast<uint32_t>(lists[i].size()), &written[i]);
    if (!lists[i].empty()) streams[i] = prepare(lists[i], 1, default_compression_level, written[i]);
    if (!streams[i]) continue;
    if (running != nullptr) RansStream::run(*running, *streams[i]);
    if (!streams[i]->is_done()) running = &*streams[i];
  }
  if (running != nullptr) running->run();
  for (size_t i = 0; i < lists.size(); ++i) {
    if (streams[i]) streams[i]->write(written[i]);
    out.Encode(written[i].data(), written[i].size());
  }
}

}  // namespace papilio::proto::edgebreaker
