#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "client/lib/compare.h"
#include "client/lib/mesh_stream.h"
#include "client/lib/remote.h"
#include "proto/parameters.h"

// Subcommands, one function each. Failures are exceptions, which main() converts to messages and an exit status.

namespace papilio::client {

struct RefineFlags {
  MeshPlace input;       ///< mesh file, folder, or "-"
  MeshPlace output;      ///< mesh file, folder, or "-"; without a path: beside the input
  std::string server;    ///< URL of a server; empty: refine in this process
  RemoteOptions remote;  ///< options of the connection to the server
  int jobs = 1;          ///< upper bound of meshes of a folder refined at once
  bool json = false;     ///< whether to print statistics as JSON to standard output
  proto::Parameters parameters;
};
void refine_command(const RefineFlags& flags);

struct InfoFlags {
  MeshPlace input;
  bool json = false;
};
void info_command(const InfoFlags& flags);

struct ConvertFlags {
  MeshPlace input, output;
  bool exact = false;  ///< whether .drc files keep positions exactly
  proto::OutputOptions options;
};
void convert_command(const ConvertFlags& flags);

struct CompareFlags {
  MeshPlace a, b;
  CompareOptions options;
  bool json = false;
};
void compare_command(const CompareFlags& flags);

struct PackFlags {
  MeshPlace input, output;          ///< mesh file, and .glb file
  std::optional<double> rms{};      ///< target RMS distance, a share of the diagonal
  std::optional<double> largest{};  ///< upper bound of the largest distance, a share of the diagonal
  std::optional<int64_t> bytes{};   ///< upper bound of the file's bytes; at most one of the three goals is set
  int jobs = 1;                     ///< upper bound of concurrent encodings
  uint64_t piece_bytes = DetailOptions{}.piece_bytes;
  bool no_simplify = false;  ///< whether no simplified mesh is compared
  bool json = false;
};
/// Packs a fine mesh into a coarse base and levels of residuals.
void pack_command(const PackFlags& flags);

struct UnpackFlags {
  MeshPlace input, output;
  std::optional<int> levels{};  ///< upper bound of the levels; nothing: all
  bool may_be_cut = false;      ///< whether the file may end inside a level
  /// Whether the mesh has normals; nothing: if it is a scene, or if the original has normals.
  std::optional<bool> normals{};
};
/// Decodes a packed model.
void unpack_command(const UnpackFlags& flags);

struct HealthFlags {
  std::string server = "http://127.0.0.1:8080";
  RemoteOptions remote;
  bool ready = false;  ///< whether to check that the server accepts work, not only that it runs
};
/// Prints the server's answer. Throws unless it is positive.
void health_command(const HealthFlags& flags);

/// Refuses an output that cannot be written, before the work: a name without a known extension, a folder, or binary
/// data to a terminal. Throws `UsageError`, and `FileError` for a folder that does not exist.
void check_output(const MeshPlace& output);

/// Prints warnings to standard error, a line each: the first ten, and the number of the others.
void print_warnings(const std::vector<std::string>& warnings);

/// Warns if a scene has levels of detail but is no packed model: commands then use only its base.
void warn_of_detail(const MeshBytes& file);

/// Error in the program's arguments: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace papilio::client
