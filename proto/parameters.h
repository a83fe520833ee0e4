#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "papilio/refine.h"
#include "proto/draco_writer.h"

// The parameters of a refinement, as users name them. One table says all there is to say of each; the query,
// JSON, the command line and the documentation are made from it.

namespace papilio::proto {

/// Names and values, percent-decoded, in the order in which they came.
using QueryFields = std::vector<std::pair<std::string, std::string>>;

/// What a request asks for.
struct Parameters {
  Options options;  ///< `options.view` is set when any view parameter was given
  OutputOptions output;
  bool frames_eye = false;     ///< view.eye was left out: it follows from the mesh
  bool frames_target = false;  ///< view.target was left out: it is the centre of the mesh's box

  friend bool operator==(const Parameters& a, const Parameters& b);
};

enum class ParameterType { integer, number, numbers, boolean, choice };

/// One row of the table. A value of any type is a list of numbers: one for integer, number, boolean (0, 1)
/// and choice (the index), between `least` and `most` of them for numbers, in groups of `group`.
struct ParameterInfo {
  std::string_view name;  ///< with dots for nesting
  ParameterType type;
  size_t least = 1, most = 1;
  size_t group = 1;                 ///< numbers come in groups of this many
  double min = 0, max = 0;          ///< inclusive; unused for boolean and choice
  std::string_view unit{};          ///< "" when it has none
  std::string_view default_text{};  ///< what stands for the default where its value does not speak for itself, else ""
  std::string_view description{};
  std::vector<std::string_view> choices{};
  std::vector<double> (*get)(const Parameters&);  ///< empty for a default that follows from others
  void (*set)(Parameters&, const std::vector<double>&);
};

/// The options to refine a mesh in this box with.
[[nodiscard]] Options options_for(const Parameters& parameters, const Box& box);
/// Whether an error is asked for: by tolerance or by view.error_pixels.
[[nodiscard]] bool asks_for_error(const Options& options);
/// `View::edge_pixels` where view.edge_pixels is left out: the paper's 10, or 0 where view.error_pixels decides.
[[nodiscard]] double default_edge_pixels(const View& view);

/// All parameters, in the order of the documentation.
[[nodiscard]] std::span<const ParameterInfo> parameter_table();

/// Both refuse, with `Problem`: unknown_parameter for a name that is not in the table, bad_parameter for a
/// name given twice, a value of another type or out of range, and a view that defines no picture; bad_request
/// for JSON that cannot be read. The numbers of a list may be spread over repeated fields.
[[nodiscard]] Parameters parse_query(const QueryFields& fields);
/// `text`: one object, nested where names have dots, lists as arrays.
[[nodiscard]] Parameters parse_json(std::string_view text);

/// The canonical form: what differs from the defaults, in the table's order, numbers in their shortest exact
/// form. Equal parameters give equal fields, and `parse_query` of them gives equal parameters.
[[nodiscard]] QueryFields to_fields(const Parameters& parameters);
/// The same joined to a query string, percent-encoded.
[[nodiscard]] std::string to_query(const Parameters& parameters);

/// Words for the documentation: "integer 0..10", "red-green | in-place".
[[nodiscard]] std::string describe_range(const ParameterInfo& info);
[[nodiscard]] std::string describe_default(const ParameterInfo& info);
/// The table as Markdown and as JSON (an array of objects).
[[nodiscard]] std::string parameters_markdown();
[[nodiscard]] std::string parameters_json();

}  // namespace papilio::proto
