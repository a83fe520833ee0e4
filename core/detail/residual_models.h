#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "detail/mixed_bit.h"

namespace papilio {

/// Upper bound of the magnitude of a residual, in steps.
inline constexpr int32_t largest_residual = (1 << 20) - 1;

/// Coding context of a residual.
struct ResidualContext {
  uint32_t level = 0;                   ///< number; 1 is the first below the base
  bool is_inner = false;                ///< whether its edge lies inside a face of the level before
  std::array<int32_t, 4> neighbours{};  ///< residuals of the other edges of its two faces; 0 if not coded yet
  uint32_t known = 0;                   ///< number of coded neighbours
  uint32_t free_neighbours = 0;         ///< number of coded neighbours with tangential parts
  uint32_t parents = 0;                 ///< mean magnitude round the edge on the level before, in eighths
  uint32_t turn = 0;                    ///< distance of the prediction from the middle of the edge, in eighths of steps
};

/// Coding context of the residual of an edge on a curve.
struct CurveContext {
  uint32_t level = 0;                       ///< number; 1 is the first below the base
  uint32_t parent = 0;                      ///< magnitude at the end that the level before made
  bool has_sibling = false;                 ///< whether the other half of the parent edge is coded
  int32_t sibling = 0, sibling_across = 0;  ///< parts of the other half's residual
};

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
    const auto magnitude = static_cast<uint32_t>(std::abs(residual));
    if (!code_decision(0, magnitude != 0, code)) return 0;
    const bool is_negative = code_sign(residual < 0, code);
    uint32_t coded = 1;
    while (coded < unary_limit && code_decision(coded, magnitude > coded, code)) ++coded;
    if (coded == unary_limit) coded += code_number(widths_, magnitude - std::min(magnitude, unary_limit), code);
    const auto value = static_cast<int32_t>(std::min(coded, static_cast<uint32_t>(largest_residual)));
    return is_negative ? -value : value;
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
  static constexpr size_t inputs = 6, sign_inputs = 3;
  static constexpr uint32_t most_levels = 12;
  static constexpr uint32_t most_width = 20;
  static constexpr uint32_t even = 1U << 15;
  static constexpr uint32_t curve_rows = 2 * most_levels * (curve_classes + 1) * curve_classes;
  using Models = std::vector<BitModel>;
  using Widths = std::array<BitModel, most_width>;

  static uint32_t level_of(const ResidualContext& c) { return std::min(c.level, most_levels - 1); }
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
  bool code_sign(bool bit, const Code& code) {
    std::array<BitModel*, sign_inputs> models;
    for (size_t i = 0; i < sign_inputs; ++i) models[i] = &sign_models_[i][sign_at_[i]];
    const bool coded = code(bit, sign_mixer_.mix(models, 0));
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

  uint32_t level_ = 0;
  std::array<uint32_t, inputs> at_{};
  std::array<uint32_t, sign_inputs> sign_at_{};
  std::array<Models, inputs> models_{
      Models(size_t{most_levels} * 80 * unary_limit), Models(size_t{256} * 5 * unary_limit),
      Models(size_t{most_levels} * 48 * unary_limit), Models(size_t{240} * unary_limit),
      Models(size_t{most_levels} * 16 * unary_limit), Models(size_t{most_levels} * 5 * unary_limit)};
  BitMixer<inputs> mixer_{size_t{most_levels} * unary_limit};
  std::array<Models, sign_inputs> sign_models_{Models(5 * most_levels), Models(81), Models(most_levels)};
  BitMixer<sign_inputs> sign_mixer_{1};
  Models freedom_{Models(5 * most_levels)};
  Widths widths_{}, tangential_widths_{};
  Models curve_{Models(size_t{curve_rows} * unary_limit)}, curve_signs_{Models(3)}, curve_freedom_{Models(most_levels)};
  Widths curve_widths_{};
};

}  // namespace papilio
