#pragma once

#include <span>
#include <string>

#include "proto/draco_writer.h"
#include "proto/output_attribute.h"

// Reference streams of libdraco's encoder, which takes time quadratic in the valence.

namespace papilio::test {

/// Returns libdraco's equivalent of `edgebreaker::write`. Throws std::runtime_error if libdraco fails.
[[nodiscard]] std::string write_with_libdraco(const Mesh& mesh, const proto::QuantizationBox& box,
                                              const proto::OutputOptions& options, uint32_t position_id,
                                              std::span<const proto::OutputAttribute> attributes = {});

/// Returns libdraco's equivalent of `write_draco_exact`.
[[nodiscard]] std::string write_exact_with_libdraco(const TriangleMesh& triangles,
                                                    const proto::MeshFormat& format = {});

}  // namespace papilio::test
