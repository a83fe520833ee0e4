#pragma once

#include <span>
#include <string>

#include "proto/draco_writer.h"
#include "proto/output_attribute.h"

// Streams by libdraco's encoder, which takes time quadratic in the valence: what ours are compared with.

namespace papilio::test {

/// What `edgebreaker::write` writes. Throws std::runtime_error where libdraco refuses.
[[nodiscard]] std::string write_with_libdraco(const Mesh& mesh, const proto::QuantizationBox& box,
                                              const proto::OutputOptions& options, uint32_t position_id,
                                              std::span<const proto::OutputAttribute> attributes = {});

/// What `write_draco_exact` writes.
[[nodiscard]] std::string write_exact_with_libdraco(const TriangleMesh& triangles,
                                                    const proto::MeshFormat& format = {});

}  // namespace papilio::test
