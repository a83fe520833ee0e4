#pragma once

// Names of supported extensions of geometry and materials.

namespace papilio::proto::gltf {

inline constexpr const char* draco_extension = "KHR_draco_mesh_compression";
inline constexpr const char* meshopt_extension = "EXT_meshopt_compression";
/// Successor of EXT_meshopt_compression with codecs that Debian's meshoptimizer cannot read.
inline constexpr const char* newer_meshopt_extension = "KHR_meshopt_compression";
inline constexpr const char* quantization_extension = "KHR_mesh_quantization";
inline constexpr const char* instancing_extension = "EXT_mesh_gpu_instancing";
inline constexpr const char* texture_transform_extension = "KHR_texture_transform";
/// Residuals of a packed model's levels (proto/detail.md).
inline constexpr const char* detail_extension = "PAPILIO_detail";
inline constexpr const char* emissive_strength_extension = "KHR_materials_emissive_strength";

}  // namespace papilio::proto::gltf
