#pragma once

#include <cstdint>

// Thresholds of Draco's encoding speed (0 smallest, 10 fastest), at which libdraco changes its methods.

namespace papilio::proto::edgebreaker {

inline constexpr int max_prediction_degree_speed = 0;     ///< positions in order of their prediction degrees
inline constexpr int min_single_parallelogram_speed = 2;  ///< below: the mean of several parallelograms
inline constexpr int min_position_independent_speed = 4;  ///< below: positions predict normals and texture coordinates
inline constexpr int min_standard_traversal_speed = 5;    ///< below: valence traversal
inline constexpr int min_single_connectivity_speed = 6;   ///< below: connectivity of its own for each attribute
inline constexpr int min_difference_speed = 8;            ///< below: parallelograms
inline constexpr uint32_t min_valence_faces = 1000;       ///< below: standard traversal at any speed
inline constexpr uint32_t min_multi_parallelogram_points = 40;  ///< below: one parallelogram at any speed

}  // namespace papilio::proto::edgebreaker
