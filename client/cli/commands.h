#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "client/lib/compare.h"
#include "client/lib/mesh_stream.h"
#include "client/lib/remote.h"
#include "proto/parameters.h"

// What the subcommands do, one function each. Failures are exceptions; `main` turns them into words and an
// exit status.

namespace papilio::client {

struct RefineFlags {
  MeshPlace input;       ///< mesh file, folder, or "-"
  MeshPlace output;      ///< mesh file, folder, or "-"; without a path: beside the input
  std::string server;    ///< URL; empty: refine in this process
  RemoteOptions remote;  ///< how that server is spoken to
  int jobs = 1;          ///< meshes of a folder refined at once
  bool json = false;     ///< statistics as JSON on standard output
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
  bool exact = false;  ///< to .drc: positions to the bit
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
  MeshPlace input, output;          ///< the output is a .glb file
  std::optional<double> rms{};      ///< wanted RMS distance, a share of the diagonal
  std::optional<double> largest{};  ///< largest distance allowed, a share of the diagonal
  std::optional<int64_t> bytes{};   ///< most bytes of the file; at most one of these three is given
  int jobs = 1;                     ///< most encodings at once
  uint64_t piece_bytes = DetailOptions{}.piece_bytes;
  bool no_simplify = false;  ///< whether no simplified mesh is compared
  bool json = false;
};
/// Packs a fine mesh into a coarse base and levels of residuals.
void pack_command(const PackFlags& flags);

struct UnpackFlags {
  MeshPlace input, output;
  std::optional<int> levels{};  ///< at most; nothing: all
  bool may_be_cut = false;      ///< whether the file may end inside a level
  /// Whether the mesh has normals; nothing: in a scene, and where the original has any.
  std::optional<bool> normals{};
};
/// Decodes a packed model.
void unpack_command(const UnpackFlags& flags);

struct HealthFlags {
  std::string server = "http://127.0.0.1:8080";
  RemoteOptions remote;
  bool ready = false;  ///< whether it takes work, not only whether it is alive
};
/// Prints the server's word for it; anything but yes is an exception.
void health_command(const HealthFlags& flags);

/// Refuses an output that cannot be written, before the work: a name without a known extension, a folder, binary data
/// to a terminal. Throws `UsageError`, and `FileError` for a folder that does not exist.
void check_output(const MeshPlace& output);

/// Prints warnings to standard error, a line each: the first ten and how many more there are.
void print_warnings(const std::vector<std::string>& warnings);

/// Warns if a scene has levels of detail but is no packed model: then commands use its base alone.
void warn_of_detail(const MeshBytes& file);

/// A mistake in how the program was called: exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace papilio::client
