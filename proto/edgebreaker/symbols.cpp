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

#include "core/array.h"
#include "core/base/logarithm.h"

namespace papilio::proto::edgebreaker {
namespace {

constexpr int most_raw_bits = 18;  ///< of the number of different symbols; above, their values are written as bits

/// How often each symbol occurs.
struct Census {
  std::vector<uint64_t> counts;            ///< [largest symbol + 1]
  std::array<uint64_t, 33> bit_lengths{};  ///< [bits] of how many values the largest component has so many
};

uint32_t bit_length(uint32_t symbol) { return static_cast<uint32_t>(std::bit_width(symbol | 1U)); }

/// Counts numbers. Most are the same few: by turns in one of four places, as an increment waits for the one before it.
class Counter {
 public:
  explicit Counter(size_t count) : counts_(count, Turns{}) {}
  void add(uint32_t number, size_t turn) { ++counts_[number][turn % turns]; }
  [[nodiscard]] uint64_t count(size_t number) const {
    const Turns& c = counts_[number];
    return uint64_t{c[0]} + c[1] + c[2] + c[3];
  }

 private:
  static constexpr size_t turns = 4;
  using Turns = std::array<uint32_t, turns>;
  List<Turns> counts_;
};

/// Bits of a value's largest component.
uint32_t value_bit_length(const uint32_t* value, uint32_t components) {
  uint32_t bits = 0;
  for (uint32_t k = 0; k < components; ++k) bits |= value[k];
  return bit_length(bits);
}

Census take_census(std::span<const uint32_t> symbols, uint32_t components, uint32_t largest) {
  Census census;
  Counter bit_lengths(census.bit_lengths.size());
  size_t turn = 0;
  for (size_t i = 0; i < symbols.size(); i += components)
    bit_lengths.add(value_bit_length(&symbols[i], components), turn++);
  for (size_t i = 0; i < census.bit_lengths.size(); ++i) census.bit_lengths[i] = bit_lengths.count(i);

  Counter counts(size_t{largest} + 1);
  for (size_t i = 0; i < symbols.size(); ++i) counts.add(symbols[i], i);
  census.counts.resize(size_t{largest} + 1);
  for (uint32_t i = 0; i <= largest; ++i) census.counts[i] = counts.count(i);
  return census;
}

/// As Draco estimates it: the bits of the symbols' entropy and of their table.
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

/// What becomes of the state at each symbol, from the probabilities.
class Table {
 public:
  /// `precision_bits`: probabilities are shares of 2 to that.
  explicit Table(int precision_bits) : precision_(1U << precision_bits) {}

  /// Has libdraco make the table and write it; reads it from there.
  template <int unique_bits>
  void make(std::span<const uint64_t> counts, draco::EncoderBuffer& out) {
    const size_t start = out.size();
    draco::RAnsSymbolEncoder<unique_bits> maker;
    if (!maker.Create(counts.data(), static_cast<int>(counts.size()), &out))
      throw std::runtime_error("Draco's entropy coder refuses the symbols");
    read_table(std::span(out.data() + start, out.size() - start));
  }

  [[nodiscard]] uint32_t least_state() const { return 4 * precision_; }

  /// The state after the symbol; bytes that it gives away go to `at`. All that may become of it is computed at once:
  /// each state waits for the one before.
  [[nodiscard]] uint64_t put(uint32_t number, uint64_t state, uint8_t*& at) const {
    const Symbol& symbol = symbols_[number];
    const uint64_t limit = symbol.limit;
    const bool gives_one = state >= limit;
    const bool gives_two = state >= limit << 8U;
    const bool gives_three = state >= limit << 16U;
    const auto bytes = static_cast<uint32_t>(state);
    std::memcpy(at, &bytes, sizeof bytes);
    at += int{gives_one} + int{gives_two} + int{gives_three};
    const uint64_t none_given = next(symbol, state);
    const uint64_t one_given = next(symbol, state >> 8U);
    const uint64_t two_given = next(symbol, state >> 16U);
    if (__builtin_expect(static_cast<int64_t>(gives_three), 0) != 0) return next(symbol, state >> 24U);
    // No branches: nobody can guess which way they go.
    return none_given ^ ((none_given ^ one_given) & all_if(gives_one)) ^ ((one_given ^ two_given) & all_if(gives_two));
  }
  static constexpr size_t most_bytes_a_symbol = 3;

 private:
  struct Symbol {
    uint64_t inverse;  ///< 2^inverse_bits / probability, rounded up: by it a state is divided
    uint32_t limit;    ///< from here on the state gives bytes away first
    uint32_t rest;     ///< what the probability lacks to one
    uint32_t before;   ///< sum of the probabilities of the symbols before
  };
  /// States to be divided are below the limit: so no product needs more than 62 bits, and none is off by one.
  static constexpr uint32_t inverse_bits = 52;
  static constexpr uint32_t limit_a_share = 4 * 256;

  void read_table(std::span<const char> bytes) {
    draco::DecoderBuffer in;
    in.Init(bytes.data(), bytes.size());
    uint32_t count = 0;
    draco::DecodeVarint(&count, &in);
    uint32_t before = 0;
    const auto add = [&](uint32_t probability) {
      const uint64_t inverse = probability > 0 ? ((uint64_t{1} << inverse_bits) - 1) / probability + 1 : 0;
      symbols_.push_back({inverse, limit_a_share * probability, precision_ - probability, before});
      before += probability;
    };
    while (symbols_.size() < count) {
      uint8_t byte = 0;
      in.Decode(&byte);
      uint32_t value = byte >> 2U;
      const uint32_t more = byte & 3U;
      if (more == 3) {  // that many symbols, and one, do not occur
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

  static uint64_t all_if(bool condition) { return -static_cast<uint64_t>(condition); }
  [[nodiscard]] uint64_t next(const Symbol& symbol, uint64_t state) const {
    const uint64_t quotient = (state * symbol.inverse) >> inverse_bits;
    return state + quotient * symbol.rest + symbol.before;
  }

  uint32_t precision_;
  List<Symbol> symbols_;
};

/// The symbols of a list, last to first, as they are decoded first to last: all in one state, which gives bytes away.
class Stream {
 public:
  Stream(std::span<const uint32_t> symbols, Table table)
      : symbols_(symbols),
        table_(std::move(table)),
        bytes_(symbols.size() * Table::most_bytes_a_symbol + sizeof(uint32_t)),
        at_(bytes_.data()),
        state_(table_.least_state()) {}

  void run() {
    uint64_t state = state_;
    for (size_t i = symbols_.size(); i-- > 0;) state = table_.put(symbols_[i], state, at_);
    state_ = state;
    symbols_ = {};
  }
  /// Goes on with both until one is done: so neither has to wait for itself alone.
  static void run(Stream& a, Stream& b) {
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

  /// Has the list, which the symbols are those of, and bytes that come behind it kept until it is written.
  void keep(List<uint32_t> symbols, Array<uint8_t> behind) {
    kept_ = std::move(symbols);
    behind_ = std::move(behind);
  }

  void write(draco::EncoderBuffer& out) {
    end();
    const auto size = static_cast<size_t>(at_ - bytes_.data());
    draco::EncodeVarint<uint64_t>(size, &out);
    out.Encode(bytes_.data(), size);
    out.Encode(behind_.data(), behind_.size());
  }

 private:
  void advance(size_t count, uint64_t state, uint8_t* at) {
    symbols_ = symbols_.first(symbols_.size() - count);
    state_ = state;
    at_ = at;
  }

  /// The state itself, in as few bytes as it takes.
  void end() {
    auto state = static_cast<uint32_t>(state_ - table_.least_state());
    const uint32_t more = state < 1U << 6U ? 0 : state < 1U << 14U ? 1 : state < 1U << 22U ? 2 : 3;
    state |= more << (8 * more + 6);
    std::memcpy(at_, &state, sizeof state);
    at_ += 1 + more;
  }

  std::span<const uint32_t> symbols_;  ///< still to come
  Table table_;
  Array<uint8_t> bytes_;
  uint8_t* at_;
  uint64_t state_;
  List<uint32_t> kept_;
  Array<uint8_t> behind_;
};

/// Probabilities are finer the more different symbols there are; how much finer is a matter of the level.
int unique_bits_at(int different, int compression_level) {
  int bits = std::bit_width(static_cast<uint32_t>(different));
  if (bits > most_raw_bits) throw std::runtime_error("Draco's entropy coder refuses the symbols: too many differ");
  if (compression_level < 4)
    bits -= 2;
  else if (compression_level < 6)
    bits -= 1;
  else if (compression_level > 9)
    bits += 2;
  else if (compression_level > 7)
    bits += 1;
  return std::clamp(bits, 1, most_raw_bits);
}

/// Calls visit.template operator()<bits>() with the bits, at least 1.
template <int most, class Visit>
void with_constant(int bits, const Visit& visit) {
  if constexpr (most > 1) {
    if (bits < most) return with_constant<most - 1>(bits, visit);
  }
  visit.template operator()<most>();
}

/// How many bits each value's largest component has. [values]
List<uint32_t> find_bit_lengths(std::span<const uint32_t> symbols, uint32_t components) {
  List<uint32_t> lengths(symbols.size() / components);
  for (size_t i = 0; i < lengths.size(); ++i) lengths[i] = value_bit_length(&symbols[i * components], components);
  return lengths;
}

/// The components' bits, one behind the other, the lowest of each first.
Array<uint8_t> pack(std::span<const uint32_t> symbols, uint32_t components, const List<uint32_t>& lengths) {
  Array<uint8_t> bytes(symbols.size() * sizeof(uint32_t) + sizeof(uint64_t));
  uint8_t* at = bytes.data();
  uint64_t bits = 0;
  uint32_t held = 0;
  for (size_t i = 0; i < symbols.size(); ++i) {
    bits |= uint64_t{symbols[i]} << held;
    held += lengths[i / components];
    std::memcpy(at, &bits, sizeof bits);
    at += held / 8;
    bits >>= held / 8 * 8;
    held %= 8;
  }
  bytes.resize(static_cast<size_t>(at - bytes.data()) + (held > 0 ? 1 : 0));
  return bytes;
}

/// How many bits each value has, by a table; and behind it these bits.
Stream prepare_tagged(std::span<const uint32_t> symbols, uint32_t components, const Census& census,
                      draco::EncoderBuffer& out) {
  constexpr int tag_bits = 5;
  out.Encode(static_cast<uint8_t>(draco::SYMBOL_CODING_TAGGED));
  Table table(draco::ComputeRAnsPrecisionFromUniqueSymbolsBitLength(tag_bits));
  table.make<tag_bits>(std::span(census.bit_lengths).first(1U << tag_bits), out);
  List<uint32_t> lengths = find_bit_lengths(symbols, components);
  Array<uint8_t> packed = pack(symbols, components, lengths);
  Stream stream(lengths, std::move(table));
  stream.keep(std::move(lengths), std::move(packed));
  return stream;
}

/// Writes what comes before the stream of the symbols, which is returned; or all of it by libdraco.
std::optional<Stream> prepare(std::span<const uint32_t> symbols, uint32_t components, int compression_level,
                              draco::EncoderBuffer& out) {
  uint32_t largest = 0;
  for (uint32_t symbol : symbols) largest = std::max(largest, symbol);
  if (bit_length(largest) <= most_raw_bits) {
    const Census census = take_census(symbols, components, largest);
    int different = 0;
    int64_t tagged_bits = estimate_bits(census.bit_lengths, symbols.size() / components, -1, different);
    for (uint32_t bits = 1; bits < census.bit_lengths.size(); ++bits)
      tagged_bits += static_cast<int64_t>(bits * census.bit_lengths[bits] * components);
    const int64_t raw_bits = estimate_bits(census.counts, symbols.size(), static_cast<int>(largest), different);
    if (tagged_bits >= raw_bits) {
      const int unique_bits = unique_bits_at(different, compression_level);
      out.Encode(static_cast<uint8_t>(draco::SYMBOL_CODING_RAW));
      out.Encode(static_cast<uint8_t>(unique_bits));
      Table table(draco::ComputeRAnsPrecisionFromUniqueSymbolsBitLength(unique_bits));
      with_constant<most_raw_bits>(unique_bits, [&]<int bits>() { table.make<bits>(census.counts, out); });
      return Stream(symbols, std::move(table));
    }
    return prepare_tagged(symbols, components, census, out);
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
  std::optional<Stream> stream = prepare(symbols, components, compression_level, out);
  if (!stream) return;
  stream->run();
  stream->write(out);
}

void write_symbol_lists(std::span<const List<uint32_t>> lists, draco::EncoderBuffer& out) {
  std::vector<draco::EncoderBuffer> written(lists.size());
  std::vector<std::optional<Stream>> streams(lists.size());
  Stream* running = nullptr;
  for (size_t i = 0; i < lists.size(); ++i) {
    draco::EncodeVarint<uint32_t>(static_cast<uint32_t>(lists[i].size()), &written[i]);
    if (!lists[i].empty()) streams[i] = prepare(lists[i], 1, default_compression_level, written[i]);
    if (!streams[i]) continue;
    if (running != nullptr) Stream::run(*running, *streams[i]);
    if (!streams[i]->is_done()) running = &*streams[i];
  }
  if (running != nullptr) running->run();
  for (size_t i = 0; i < lists.size(); ++i) {
    if (streams[i]) streams[i]->write(written[i]);
    out.Encode(written[i].data(), written[i].size());
  }
}

}  // namespace papilio::proto::edgebreaker
