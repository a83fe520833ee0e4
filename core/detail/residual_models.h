#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "detail/expected_residual.h"
#include "detail/mixed_bit.h"
#include "detail/residual_context.h"

namespace papilio {

/// Adaptive models of residuals, shared by encoder and decoder. Functions code through code(bit, probability), which
/// encodes the bit, or ignores it and decodes one. Each returns the coded or decoded value.
class ResidualModels {
 public:
  /// Codes whether a residual has tangential parts.
  template <class Code>
  bool code_freedom(const ResidualContext& context, bool is_free, const Code& code) {
    const size_t at = size_t{level_of(context)} * 5 + context.free_neighbours;
    return code_by(freedom_[at], is_free, code);
  }

  /// Codes the part along the normal.
  template <class Code>
  int32_t code(const ResidualContext& context, int32_t residual, const Code& code) {
    set_context(context);
    // In the direction that is expected, less most of what is expected.
    const int32_t rest = (is_turned_ ? -residual : residual) - shift_;
    const int32_t coded = std::clamp(shift_ + code_rest(rest, code), -largest_residual, largest_residual);
    const int32_t value = is_turned_ ? -coded : coded;
    expected_.update(value);
    return value;
  }

  /// Codes whether the residual of an edge on a curve has a part along it.
  template <class Code>
  bool code_curve_freedom(const CurveContext& context, bool is_free, const Code& code) {
    return code_by(curve_freedom_[std::min(context.level, most_levels - 1)], is_free, code);
  }
  /// Codes the part along the normal of an edge on a curve.
  template <class Code>
  int32_t code_curve_normal(const CurveContext& context, int32_t part, const Code& code) {
    return code_curve_part(curve_at(context, context.sibling, context.parent), context.sibling, part, code);
  }
  /// Codes the part across an edge on a curve, given the coded part along the normal.
  template <class Code>
  int32_t code_curve_across(const CurveContext& context, int32_t normal, int32_t part, const Code& code) {
    const auto magnitude = static_cast<uint32_t>(std::abs(normal));
    return code_curve_part(curve_rows / 2 + curve_at(context, context.sibling_across, magnitude),
                           context.sibling_across, part, code);
  }
  /// Codes a tangential part.
  template <class Code>
  int32_t code_tangential(int32_t part, const Code& code) {
    const uint32_t coded = code_number(tangential_widths_, static_cast<uint32_t>(std::abs(part)), code);
    if (coded == 0) return 0;
    const auto value = static_cast<int32_t>(std::min(coded, static_cast<uint32_t>(largest_residual)));
    return code(part < 0, even) ? -value : value;
  }

 private:
  static constexpr uint32_t unary_limit = 14;
  static constexpr uint32_t curve_classes = 5;
  static constexpr size_t inputs = 4, sign_inputs = 4;
  static constexpr uint32_t most_levels = 12;
  static constexpr uint32_t expectations = 7, shift_classes = 4, spreads = 32, sign_sizes = 4;
  static constexpr uint32_t most_width = 20;
  static constexpr uint32_t even = 1U << 15;
  static constexpr uint32_t curve_rows = 2 * most_levels * (curve_classes + 1) * curve_classes;
  using Models = std::vector<BitModel>;
  using Widths = std::array<BitModel, most_width>;

  static uint32_t level_of(const ResidualContext& c) { return std::min(c.level, most_levels - 1); }
  /// Returns the class of a value: 0 and 1 are their own, then two an octave, at most `spreads` - 1.
  static uint32_t spread_of(uint32_t value) {
    if (value < 2) return value;
    const auto width = static_cast<uint32_t>(std::bit_width(value));
    return std::min(2 * (width - 1) + ((value >> (width - 2)) & 1), spreads - 1);
  }
  /// Returns the class of a value, at most `most`: 0, 1 and 2 are their own; 3 is 3..4, 4 is 5..8, and so on.
  static uint32_t class_of(uint32_t value, uint32_t most) {
    if (value == 0) return 0;
    return std::min(static_cast<uint32_t>(std::bit_width(value - 1)) + 1, most);
  }

  void set_context(const ResidualContext& c);

  template <class Code>
  static bool code_by(BitModel& model, bool bit, const Code& code) {
    const bool coded = code(bit, std::max(model.probability(), 1U));
    model.update(coded);
    return coded;
  }

  /// Codes whether the magnitude is greater than `decision`.
  template <class Code>
  bool code_decision(uint32_t decision, bool bit, const Code& code) {
    std::array<BitModel*, inputs> models;
    for (size_t i = 0; i < inputs; ++i) models[i] = &models_[i][size_t{at_[i]} * unary_limit + decision];
    const bool coded = code(bit, mixer_.mix(models, size_t{level_} * unary_limit + decision));
    mixer_.update(coded);
    return coded;
  }

  template <class Code>
  int32_t code_rest(int32_t rest, const Code& code) {
    const auto magnitude = static_cast<uint32_t>(std::abs(rest));
    uint32_t coded = 0;
    while (coded < unary_limit && code_decision(coded, magnitude > coded, code)) ++coded;
    if (coded == 0) return 0;
    if (coded == unary_limit) coded += code_number(widths_, magnitude - std::min(magnitude, unary_limit), code);
    return code_sign(rest < 0, coded, code) ? -static_cast<int32_t>(coded) : static_cast<int32_t>(coded);
  }

  template <class Code>
  bool code_sign(bool bit, uint32_t magnitude, const Code& code) {
    const uint32_t size = std::min(magnitude, sign_sizes) - 1;
    const std::array<BitModel*, sign_inputs> models{
        &sign_models_[0][expectation_ * most_levels + level_], &sign_models_[1][expectation_ * sign_sizes + size],
        &sign_models_[2][expectation_ * spreads + spread_], &sign_models_[3][signs_]};
    const bool coded = code(bit, sign_mixer_.mix(models, shift_class_));
    sign_mixer_.update(coded);
    return coded;
  }

  /// Returns the row of the models of a part, by the magnitudes of its sibling and of another part.
  static uint32_t curve_at(const CurveContext& c, int32_t sibling, uint32_t other) {
    const uint32_t near = c.has_sibling ? 1 + class_of(static_cast<uint32_t>(std::abs(sibling)), curve_classes - 1) : 0;
    return (std::min(c.level, most_levels - 1) * (curve_classes + 1) + near) * curve_classes +
           class_of(other, curve_classes - 1);
  }
  template <class Code>
  int32_t code_curve_part(uint32_t row, int32_t sibling, int32_t part, const Code& code) {
    const auto magnitude = static_cast<uint32_t>(std::abs(part));
    uint32_t coded = 0;
    while (coded < unary_limit && code_by(curve_[row * unary_limit + coded], magnitude > coded, code)) ++coded;
    if (coded == 0) return 0;
    if (coded == unary_limit) coded += code_number(curve_widths_, magnitude - std::min(magnitude, unary_limit), code);
    const bool is_negative = code_by(curve_signs_[sibling > 0 ? 1 : sibling < 0 ? 2 : 0], part < 0, code);
    const auto value = static_cast<int32_t>(std::min(coded, static_cast<uint32_t>(largest_residual)));
    return is_negative ? -value : value;
  }
  /// Codes a number of up to `most_width` bits: Exp-Golomb, its width by adaptive models.
  template <class Code>
  static uint32_t code_number(Widths& widths, uint32_t number, const Code& code) {
    const uint32_t width_to_code = static_cast<uint32_t>(std::bit_width(number + 1)) - 1;
    uint32_t width = 0;
    while (width < most_width && code_by(widths[width], width_to_code > width, code)) ++width;
    uint32_t coded = 1;
    for (uint32_t i = width; i-- > 0;) coded = 2 * coded + (code((((number + 1) >> i) & 1) != 0, even) ? 1 : 0);
    return coded - 1;
  }

  ExpectedResidual expected_;
  bool is_turned_ = false;  // whether the expected residual is negative
  int32_t shift_ = 0;       // of the coded value, in the direction that is expected
  uint32_t level_ = 0, expectation_ = 0, shift_class_ = 0, spread_ = 0, signs_ = 0;  // contexts
  std::array<uint32_t, inputs> at_{};
  std::array<Models, inputs> models_{Models(size_t{256} * (most_neighbours + 1) * unary_limit),
                                     Models(size_t{most_levels} * 48 * unary_limit),
                                     Models(size_t{expectations} * spreads * unary_limit),
                                     Models(size_t{shift_classes} * expectations * most_levels * unary_limit)};
  BitMixer<inputs> mixer_{size_t{most_levels} * unary_limit};
  std::array<Models, sign_inputs> sign_models_{Models(expectations * most_levels), Models(expectations* sign_sizes),
                                               Models(expectations* spreads), Models(81)};
  BitMixer<sign_inputs> sign_mixer_{shift_classes};
  Models freedom_{Models(5 * most_levels)};
  Widths widths_{}, tangential_widths_{};
  Models curve_{Models(size_t{curve_rows} * unary_limit)}, curve_signs_{Models(3)}, curve_freedom_{Models(most_levels)};
  Widths curve_widths_{};
};

}  // namespace papilio
