#include "proto/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "papilio/view.h"
#include "proto/name_suggestion.h"
#include "proto/problem.h"
#include "proto/quantization_box.h"
#include "proto/text.h"
#include "proto/url.h"

namespace papilio::proto {
namespace {

using nlohmann::json;

constexpr size_t longest_json = 64 << 10;
constexpr int deepest_json = 4;

/// Collector of the parameters of one request. Detects repeated names.
class Reader {
 public:
  void set(const ParameterInfo& info, const std::vector<double>& values) {
    if (!given_.insert(info.name).second) refuse(info, "is given twice; give it once");
    info.set(parameters_, values);
  }

  Parameters finish() {
    set_dependent_defaults();
    try {
      check_options(options_for(parameters_, any_box));
    } catch (const Error& error) {
      throw Problem(error);
    }
    return parameters_;
  }

  [[noreturn]] static void refuse(const ParameterInfo& info, const std::string& why) {
    throw Problem(Code::bad_parameter, std::string(info.name) + " " + why + ".", std::string(info.name));
  }

 private:
  /// Sets omitted parameters whose defaults depend on others.
  void set_dependent_defaults() {
    Options& options = parameters_.options;
    options.stop_at_limits = has_error_target(options) && !given_.contains("levels");
    if (options.stop_at_limits) options.levels = most_levels;
    if (options.view && !given_.contains("view.edge_pixels"))
      options.view->edge_pixels = default_edge_pixels(*options.view);
  }

  static constexpr int most_levels = 10;
  static constexpr Box any_box{{-1, -1, -1}, {1, 1, 1}};

  Parameters parameters_{.options = {}, .output = {}, .default_eye = true, .default_target = true};
  std::set<std::string_view> given_;
};

/// Describes the number of values: "an integer", "3 numbers", "1 to 8 times 3 numbers".
std::string describe_count(const ParameterInfo& info) {
  if (info.type == ParameterType::integer) return "an integer";
  if (info.type == ParameterType::number) return "a number";
  const auto groups = [&](size_t count) { return std::to_string(count / info.group); };
  const std::string count =
      info.least == info.most ? std::to_string(info.least) : groups(info.least) + " to " + groups(info.most);
  return count + (info.group > 1 ? " times " + std::to_string(info.group) : "") + " numbers";
}

const ParameterInfo& find(const std::string& name) {
  const auto table = parameter_table();
  const auto row = std::ranges::find(table, name, &ParameterInfo::name);
  if (row != table.end()) return *row;
  std::vector<std::string_view> names;
  for (const ParameterInfo& info : table) names.push_back(info.name);
  std::string advice;
  if (const auto meant = suggest_name(name, names)) {
    advice = "Did you mean " + std::string(*meant) + "?";
  } else {
    for (const std::string_view known : names) append_item(advice, ", ", known);
    advice = "The parameters are " + advice + ".";
  }
  throw Problem(Code::unknown_parameter, "Unknown parameter " + quote(name) + ". " + advice, shorten(name));
}

[[noreturn]] void refuse_value(const ParameterInfo& info, const std::string& given) {
  Reader::refuse(info, "must be " + describe_range(info) + ", not " + given);
}

/// Throws for a number out of range. Names the violated bound of a list, or of a range that `describe_range` omits.
void check_bounds(const ParameterInfo& info, double value, const std::string& given) {
  if (value >= info.min && value <= info.max) return;
  const bool is_list = info.type == ParameterType::numbers;
  if (!is_list && info.max < coordinate_limit) refuse_value(info, given);
  const std::string bound =
      value > info.max ? " of at most " + format_number(info.max) : " of at least " + format_number(info.min);
  Reader::refuse(info, "must be " + describe_count(info) + bound + ", not " + (is_list ? format_number(value) : given));
}

void check_numbers(const ParameterInfo& info, const std::vector<double>& values, const std::string& given) {
  if (values.size() < info.least || values.size() > info.most || values.size() % info.group != 0)
    refuse_value(info, given);
  for (const double value : values) check_bounds(info, value, given);
  if (info.type == ParameterType::integer && values[0] != std::floor(values[0])) refuse_value(info, given);
}

std::vector<double> choose(const ParameterInfo& info, const std::string& text) {
  const auto index = [&](const auto& names) -> std::vector<double> {
    const auto found = std::ranges::find(names, text);
    if (found == names.end()) refuse_value(info, quote(text));
    return {static_cast<double>(found - names.begin())};
  };
  static const std::vector<std::string_view> booleans{"false", "true"};
  return index(info.type == ParameterType::boolean ? booleans : info.choices);
}

std::vector<double> parse_text(const ParameterInfo& info, const std::string& text) {
  if (info.type == ParameterType::boolean || info.type == ParameterType::choice) return choose(info, text);
  std::vector<double> values;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t comma = std::min(text.find(',', begin), text.size());
    const std::optional<double> value = parse_number(std::string_view(text).substr(begin, comma - begin));
    if (!value) refuse_value(info, quote(text));
    values.push_back(*value);
    begin = comma + 1;
  }
  check_numbers(info, values, quote(text));
  return values;
}

std::vector<double> parse_json_value(const ParameterInfo& info, const json& value) {
  const auto given = [&] { return shorten(value.dump(-1, ' ', false, json::error_handler_t::replace)); };
  switch (info.type) {
    case ParameterType::boolean:
      if (!value.is_boolean()) break;
      return {value.get<bool>() ? 1.0 : 0.0};
    case ParameterType::choice:
      if (!value.is_string()) break;
      return choose(info, value.get<std::string>());
    case ParameterType::integer:
    case ParameterType::number:
      if (!value.is_number()) break;
      check_numbers(info, {value.get<double>()}, given());
      return {value.get<double>()};
    case ParameterType::numbers: {
      if (!value.is_array() || !std::ranges::all_of(value, [](const json& v) { return v.is_number(); })) break;
      auto values = value.get<std::vector<double>>();
      check_numbers(info, values, given());
      return values;
    }
  }
  Reader::refuse(info, "must be " + describe_range(info) + (info.type == ParameterType::numbers ? " in an array" : "") +
                           ", not " + given());
}

bool is_group(const std::string& name) {
  return std::ranges::any_of(parameter_table(),
                             [&](const ParameterInfo& info) { return info.name.starts_with(name + "."); });
}

void read_object(Reader& reader, const json& object, const std::string& prefix) {
  for (const auto& [key, value] : object.items()) {
    const std::string name = prefix + key;
    if (prefix.empty() && is_group(name)) {
      if (!value.is_object())
        throw Problem(Code::bad_parameter, name + " must be an object, such as {\"" + name + "\": {...}}.", name);
      read_object(reader, value, name + ".");
    } else if (prefix.empty() && key.find('.') != std::string::npos) {
      throw Problem(Code::unknown_parameter,
                    "JSON parameters are nested, not dotted: write " + quote(name) +
                        " as {\"view\": {...}} or {\"output\": {...}}.",
                    shorten(name));
    } else {
      const ParameterInfo& info = find(name);
      reader.set(info, parse_json_value(info, value));
    }
  }
}

/// Parses JSON. Throws for deep nesting, which the library prints recursively, and for repeated keys, of which the
/// library would keep the last.
json parse_document(std::string_view text) {
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > deepest_json)
      throw Problem(Code::bad_request,
                    "The parameters are nested deeper than " + std::to_string(deepest_json) + " levels.");
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      throw Problem(Code::bad_parameter, quote(parsed.get<std::string>()) + " is given twice; give it once.",
                    shorten(parsed.get<std::string>()));
    return true;
  };
  try {
    return json::parse(text, watch);
  } catch (const json::parse_error& error) {
    throw Problem(Code::bad_request, "The parameters are not valid JSON at byte " + std::to_string(error.byte) + ".");
  } catch (const json::exception&) {
    throw Problem(Code::bad_request, "A number in the parameters exceeds the range of a double.");
  }
}

/// Joins repeated fields of a list: `a=1&a=2` to `a=1,2`.
QueryFields join_repeated_lists(const QueryFields& fields) {
  QueryFields joined;
  for (const auto& [name, text] : fields) {
    const bool is_list = find(name).type == ParameterType::numbers;
    const auto first = std::ranges::find(joined, name, &QueryFields::value_type::first);
    if (is_list && first != joined.end())
      first->second += "," + text;
    else
      joined.emplace_back(name, text);
  }
  return joined;
}

std::string value_text(const ParameterInfo& info, const std::vector<double>& values) {
  if (info.type == ParameterType::boolean) return values[0] != 0 ? "true" : "false";
  if (info.type == ParameterType::choice) return std::string(info.choices[static_cast<size_t>(values[0])]);
  std::string text;
  for (double v : values) append_item(text, ",", format_number(v));
  return text;
}

}  // namespace

Options options_for(const Parameters& parameters, const Box& box) {
  Options options = parameters.options;
  if (!options.view) return options;
  if (parameters.default_target) options.view->target = box.centre();
  if (parameters.default_eye) options.view->eye = framing_eye(*options.view, box);
  return options;
}

OutputOptions output_for(const Parameters& parameters, const Box& box) {
  constexpr int most_bits = 16;
  constexpr double most_share = 0.125;  // upper bound of the grid's distance, a share of the tolerance
  OutputOptions output = parameters.output;
  const double most = most_share * parameters.options.tolerance * box.diagonal();
  while (parameters.default_position_bits && most > 0 && output.position_bits < most_bits &&
         grid_distance(box, output.position_bits) > most)
    ++output.position_bits;
  return output;
}

double default_edge_pixels(const View& view) { return view.error_pixels > 0 ? 0 : View{}.edge_pixels; }

bool has_error_target(const Options& options) {
  return options.tolerance > 0 || (options.view && options.view->error_pixels > 0);
}

bool operator==(const Parameters& a, const Parameters& b) {
  return a.options.view.has_value() == b.options.view.has_value() &&
         std::ranges::all_of(parameter_table(), [&](const ParameterInfo& info) { return info.get(a) == info.get(b); });
}

Parameters parse_query(const QueryFields& fields) {
  Reader reader;
  for (const auto& [name, text] : join_repeated_lists(fields)) {
    const ParameterInfo& info = find(name);
    reader.set(info, parse_text(info, text));
  }
  return reader.finish();
}

Parameters parse_json(std::string_view text) {
  if (text.size() > longest_json)
    throw Problem(Code::body_too_large, "The parameters have " + std::to_string(text.size()) + " bytes; the limit is " +
                                            std::to_string(longest_json) + ". Send the mesh in a part of its own.");
  const json document = parse_document(text);
  if (!document.is_object())
    throw Problem(Code::bad_request, "The parameters must be a JSON object, such as {\"levels\": 2}.");
  Reader reader;
  read_object(reader, document, "");
  return reader.finish();
}

QueryFields to_fields(const Parameters& parameters) {
  static const Parameters defaults;
  constexpr std::string_view view_of_defaults = "view.up";  // represents a view with default values only
  const auto differs = [&](const ParameterInfo& info) { return info.get(parameters) != info.get(defaults); };
  const bool has_bare_view =
      parameters.options.view && std::ranges::none_of(parameter_table(), [&](const ParameterInfo& info) {
        return info.name.starts_with("view.") && differs(info);
      });
  QueryFields fields;
  for (const ParameterInfo& info : parameter_table())
    if (differs(info) || (has_bare_view && info.name == view_of_defaults))
      fields.emplace_back(info.name, value_text(info, info.get(parameters)));
  return fields;
}

std::string to_query(const Parameters& parameters) { return join_query(to_fields(parameters)); }

std::string describe_range(const ParameterInfo& info) {
  if (info.type == ParameterType::boolean) return "true or false";
  if (info.type == ParameterType::choice) {
    std::string text;
    for (std::string_view choice : info.choices) append_item(text, " or ", choice);
    return text;
  }
  std::string range;
  if (info.max < coordinate_limit)
    range = " in " + format_number(info.min) + ".." + format_number(info.max);
  else if (info.min > -coordinate_limit)
    range = " of at least " + format_number(info.min);
  return describe_count(info) + range;
}

std::string describe_default(const ParameterInfo& info) {
  return info.default_text.empty() ? value_text(info, info.get(Parameters{})) : std::string(info.default_text);
}

std::string parameters_markdown() {
  std::string text = "| parameter | takes | default | what it does |\n|---|---|---|---|\n";
  for (const ParameterInfo& info : parameter_table()) {
    text += "| `" + std::string(info.name) + "` | " + describe_range(info) +
            (info.unit.empty() ? "" : ", " + std::string(info.unit)) + " | " + describe_default(info) + " | " +
            std::string(info.description) + " |\n";
  }
  return text;
}

namespace {

/// Returns a number, as an integer if it is whole.
nlohmann::ordered_json number_json(double value) {
  return std::abs(value) < 1e15 && value == std::floor(value) ? nlohmann::ordered_json(static_cast<int64_t>(value))
                                                              : nlohmann::ordered_json(value);
}

/// Returns the default value in the JSON type of a request.
nlohmann::ordered_json default_json(const ParameterInfo& info) {
  const std::vector<double> values = info.get(Parameters{});
  if (values.empty() && info.type != ParameterType::numbers) return nullptr;
  if (info.type == ParameterType::boolean) return values[0] != 0;
  if (info.type == ParameterType::choice) return info.choices[static_cast<size_t>(values[0])];
  if (info.type != ParameterType::numbers) return number_json(values[0]);
  auto list = nlohmann::ordered_json::array();
  for (double v : values) list.push_back(number_json(v));
  return list;
}

}  // namespace

std::string parameters_json() {
  static constexpr std::array types{"integer", "number", "numbers", "boolean", "choice"};
  auto rows = nlohmann::ordered_json::array();
  for (const ParameterInfo& info : parameter_table()) {
    nlohmann::ordered_json row{{"name", info.name}, {"type", types.at(static_cast<size_t>(info.type))}};
    if (info.type == ParameterType::choice) {
      row["choices"] = info.choices;
    } else if (info.type != ParameterType::boolean) {
      row["min"] = number_json(info.min);
      row["max"] = number_json(info.max);
    }
    if (info.type == ParameterType::numbers) {
      row["least"] = info.least;
      row["most"] = info.most;
      if (info.group > 1) row["group"] = info.group;
    }
    if (!info.unit.empty()) row["unit"] = info.unit;
    row["default"] = default_json(info);
    if (!info.default_text.empty()) row["default_text"] = info.default_text;
    row["description"] = info.description;
    rows.push_back(std::move(row));
  }
  return rows.dump(2);
}

}  // namespace papilio::proto
