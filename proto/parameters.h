#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilio/refine.h"
#include "proto/draco_writer.h"
#include "proto/gltf/compression.h"

// Parameters of a refinement. One table defines them for queries, JSON, the command line and the documentation.

namespace papilio::proto {

/// Percent-decoded names and values in request order.
using QueryFields = std::vector<std::pair<std::string, std::string>>;

/// Parameters of a request.
struct Parameters {
  Options options;  ///< options of the core; `options.view` is set if any view parameter was given
  OutputOptions output;
  bool normals = false;                                     ///< whether a mesh without normals gets them
  gltf::Compression compression = gltf::Compression::same;  ///< compression of a glTF scene
  bool splits_instances = false;      ///< whether each node of a glTF scene gets a mesh of its own
  bool default_eye = false;           ///< whether view.eye is omitted and follows from the mesh
  bool default_target = false;        ///< whether view.target is omitted and is the centre of the mesh's box
  bool default_position_bits = true;  ///< whether output.position_bits is omitted and follows from the tolerance

  friend bool operator==(const Parameters& a, const Parameters& b);
};

enum class ParameterType { integer, number, numbers, boolean, choice };

/// Row of the table. A value is a list of numbers: one for integer, number, boolean (0, 1) and choice (the index),
/// `least` to `most` for numbers, in groups of `group`.
struct ParameterInfo {
  std::string_view name;  ///< with dots for nesting
  ParameterType type;
  size_t least = 1, most = 1;
  size_t group = 1;                 ///< size of a group of numbers
  double min = 0, max = 0;          ///< inclusive; unused for boolean and choice
  std::string_view unit{};          ///< "" for none
  std::string_view default_text{};  ///< explanation of the default; "": its value is printed
  std::string_view description{};
  std::vector<std::string_view> choices{};
  std::vector<double> (*get)(const Parameters&);  ///< empty: follows from other parameters
  void (*set)(Parameters&, const std::vector<double>&);
};

/// Returns the options for a mesh with this bounding box.
[[nodiscard]] Options options_for(const Parameters& parameters, const Box& box);
/// Returns the options for encoding a mesh with this bounding box. By default the grid is fine enough for the
/// tolerance.
[[nodiscard]] OutputOptions output_for(const Parameters& parameters, const Box& box);
/// Returns whether tolerance or view.error_pixels sets a target.
[[nodiscard]] bool has_error_target(const Options& options);
/// Returns the default of view.edge_pixels: 0 with view.error_pixels, else the paper's 10.
[[nodiscard]] double default_edge_pixels(const View& view);

/// Returns all parameters in the order of the documentation.
[[nodiscard]] std::span<const ParameterInfo> parameter_table();

/// Parses query fields. The numbers of a list may be spread over repeated fields. Throws `Problem`: unknown_parameter
/// for an unknown name; bad_parameter for a repeated name, a wrong type, a value out of range or a degenerate view.
[[nodiscard]] Parameters parse_query(const QueryFields& fields);
/// Parses a JSON object, nested where names have dots, with lists as arrays. Throws the same codes as `parse_query`,
/// and bad_request for malformed JSON.
[[nodiscard]] Parameters parse_json(std::string_view text);

/// Returns the canonical form: non-default parameters in table order, numbers in their shortest exact form. Equal
/// parameters give equal fields, and `parse_query` restores the parameters.
[[nodiscard]] QueryFields to_fields(const Parameters& parameters);
/// Returns the canonical form as a percent-encoded query string.
[[nodiscard]] std::string to_query(const Parameters& parameters);

/// Describes the accepted values: "an integer in 0..10", "red-green or in-place".
[[nodiscard]] std::string describe_range(const ParameterInfo& info);
/// Describes the default value.
[[nodiscard]] std::string describe_default(const ParameterInfo& info);
/// Returns the table as Markdown.
[[nodiscard]] std::string parameters_markdown();
/// Returns the table as JSON: an array of objects.
[[nodiscard]] std::string parameters_json();

}  // namespace papilio::proto
