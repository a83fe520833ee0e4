#include "proto/parameters.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "proto/problem.h"

namespace papilio::proto {
namespace {

struct Refusal {
  Code code = Code::internal;
  std::string parameter, detail;
};

template <class Parse>
Refusal refusal_of(Parse parse) {
  try {
    parse();
  } catch (const Problem& problem) {
    return {problem.code(), problem.parameter(), problem.what()};
  }
  ADD_FAILURE() << "was not refused";
  return {};
}

Refusal query_refusal(const QueryFields& fields) {
  return refusal_of([&] { (void)parse_query(fields); });
}
Refusal json_refusal(const std::string& text) {
  return refusal_of([&] { (void)parse_json(text); });
}

TEST(Parameters, NoParametersAreTheDefaults) {
  EXPECT_EQ(parse_query({}), Parameters{});
  EXPECT_EQ(parse_json("{}"), Parameters{});
  EXPECT_EQ(to_query(Parameters{}), "");
  EXPECT_FALSE(parse_query({}).options.view.has_value());
}

TEST(Parameters, QueryAndJsonGiveEqualParameters) {
  const Parameters query = parse_query({{"levels", "3"},
                                        {"flatness", "0.8,0.9"},
                                        {"growth", "2"},
                                        {"scheme", "in-place"},
                                        {"view.eye", "0,1.5,-3e1"},
                                        {"view.projection", "orthographic"},
                                        {"view.viewport", "640,480"},
                                        {"output.position_bits", "16"},
                                        {"output.normals", "true"}});
  const Parameters json = parse_json(R"({"levels": 3, "flatness": [0.8, 0.9], "growth": 2, "scheme": "in-place",
      "view": {"eye": [0, 1.5, -30], "projection": "orthographic", "viewport": [640, 480]},
      "output": {"position_bits": 16, "normals": true}})");
  EXPECT_EQ(query, json);
  EXPECT_EQ(query.options.levels, 3);
  EXPECT_EQ(query.options.flatness, (std::vector<double>{0.8, 0.9}));
  EXPECT_EQ(query.options.growth, Growth::vertices);
  ASSERT_TRUE(query.options.view);
  EXPECT_EQ(query.options.view->eye, (Vec3d{0, 1.5, -30}));
  EXPECT_EQ(query.options.view->projection, Projection::orthographic);
  EXPECT_EQ(query.options.view->edge_pixels, 10);
  EXPECT_EQ(query.output.position_bits, 16);
  EXPECT_TRUE(query.normals);
}

TEST(Parameters, EqualParametersHaveOneCanonicalFormThatRoundTrips) {
  const Parameters a = parse_query({{"levels", "03"}, {"flatness", "0.90,.5"}, {"view.fov_y", "45"}, {"w", "-0"}});
  const Parameters b = parse_query({{"view.fov_y", "45.0"}, {"flatness", "9e-1,0.5"}, {"levels", "3"}});
  EXPECT_EQ(to_query(a), to_query(b));
  EXPECT_EQ(to_query(a), "levels=3&flatness=0.9,0.5&view.up=0,1,0");
  EXPECT_EQ(parse_query(to_fields(a)), a);
  const Parameters full = parse_query({{"view.eye", "0.1,-2,1e-7"}, {"view.near", "0.25"}, {"output.speed", "3"}});
  EXPECT_EQ(parse_query(to_fields(full)), full);
}

TEST(Parameters, RepeatedFieldsOfAListAreOneList) {
  const Parameters commas = parse_query({{"view.eye", "0,1,3"}, {"levels", "1"}, {"flatness", "0.8,0.9"}});
  const Parameters repeated = parse_query({{"view.eye", "0"},
                                           {"flatness", "0.8"},
                                           {"view.eye", "1"},
                                           {"levels", "1"},
                                           {"flatness", "0.9"},
                                           {"view.eye", "3"}});
  EXPECT_EQ(repeated, commas);
  EXPECT_EQ(to_query(repeated), to_query(commas));
  EXPECT_EQ(parse_query({{"view.eye", "0,1"}, {"view.eye", "3"}, {"levels", "1"}, {"flatness", "0.8,0.9"}}), commas);
  const Refusal twice = query_refusal({{"view.eye", "0,1,3"}, {"view.eye", "0,1,3"}});
  EXPECT_EQ(twice.code, Code::bad_parameter);
  EXPECT_EQ(twice.parameter, "view.eye");
  EXPECT_EQ(query_refusal({{"view.eye", "0"}, {"view.eye", ""}, {"view.eye", "3"}}).parameter, "view.eye");
  EXPECT_EQ(query_refusal({{"w", "0"}, {"w", "0"}}).detail, "w is given twice; give it once.");
}

TEST(Parameters, OmittedLevelsAreTenWithAnErrorTarget) {
  EXPECT_EQ(parse_query({}).options.levels, 2);
  EXPECT_EQ(parse_query({{"max_faces", "5000"}}).options.levels, 2);
  for (const QueryFields& error : {QueryFields{{"tolerance", "0.001"}}, {{"view.error_pixels", "0.5"}}}) {
    const Parameters open = parse_query(error);
    EXPECT_EQ(open.options.levels, 10);
    EXPECT_TRUE(open.options.stop_at_limits);
    EXPECT_EQ(parse_query(to_fields(open)), open);
    QueryFields bounded_fields = error;
    bounded_fields.emplace_back("levels", "2");
    const Parameters bounded = parse_query(bounded_fields);
    EXPECT_EQ(bounded.options.levels, 2);
    EXPECT_FALSE(bounded.options.stop_at_limits);
    EXPECT_EQ(parse_query(to_fields(bounded)), bounded);
    EXPECT_NE(to_query(open), to_query(bounded));
  }
  EXPECT_EQ(to_query(parse_query({{"levels", "2"}})), "");
}

TEST(Parameters, ErrorPixelsSetEdgePixelsToZeroUnlessGiven) {
  EXPECT_EQ(parse_query({{"view.fov_y", "30"}}).options.view->edge_pixels, 10);
  const Parameters by_error = parse_query({{"view.error_pixels", "0.5"}});
  EXPECT_EQ(by_error.options.view->edge_pixels, 0);
  EXPECT_EQ(to_query(by_error), to_query(parse_query({{"view.error_pixels", "0.5"}, {"view.edge_pixels", "0"}})));
  const Parameters both = parse_query({{"view.error_pixels", "0.5"}, {"view.edge_pixels", "10"}});
  EXPECT_EQ(both.options.view->edge_pixels, 10);
  EXPECT_EQ(parse_query(to_fields(both)), both);
}

TEST(Parameters, OmittedEyeAndTargetFrameTheMesh) {
  const Box box{{10, 20, 30}, {12, 24, 36}};
  const View framed = *options_for(parse_query({{"view.error_pixels", "1"}}), box).view;
  EXPECT_EQ(framed.target, (Vec3d{11, 22, 33}));
  EXPECT_EQ(framed.eye.x, 11);
  EXPECT_EQ(framed.eye.y, 22);
  EXPECT_GT(framed.eye.z, 36);
  const View from = *options_for(parse_query({{"view.eye", "0,0,3"}}), box).view;
  EXPECT_EQ(from.eye, (Vec3d{0, 0, 3}));
  EXPECT_EQ(from.target, (Vec3d{11, 22, 33}));
  const View at = *options_for(parse_query({{"view.target", "10,20,30"}}), box).view;
  EXPECT_EQ(at.target, (Vec3d{10, 20, 30}));
  EXPECT_EQ(at.eye.x, 10);
  EXPECT_GT(at.eye.z, framed.eye.z - 3) << "the whole box is in the picture from the side, too";
}

TEST(Parameters, MalformedAndOutOfRangeValuesAreRefusedByParameter) {
  for (const ParameterInfo& info : parameter_table()) {
    const std::string name(info.name);
    if (info.type == ParameterType::choice || info.type == ParameterType::boolean) {
      EXPECT_EQ(query_refusal({{name, "perhaps"}}).parameter, name);
      continue;
    }
    const auto repeated = [&](const std::string& value, size_t times) {
      std::string text = value;
      for (size_t i = 1; i < times; ++i) text += "," + value;
      return text;
    };
    const size_t count = info.least;
    EXPECT_EQ(query_refusal({{name, repeated("1e300", count)}}).code, Code::bad_parameter) << name;
    EXPECT_EQ(query_refusal({{name, repeated("-1e300", count)}}).parameter, name);
    EXPECT_EQ(query_refusal({{name, repeated("nan", count)}}).parameter, name);
    EXPECT_EQ(query_refusal({{name, ""}}).parameter, name);
    EXPECT_EQ(query_refusal({{name, repeated("1", info.most + 1)}}).parameter, name);
    EXPECT_EQ(query_refusal({{name, repeated("1x", count)}}).parameter, name);
    EXPECT_EQ(query_refusal({{name, "1, 2,"}}).parameter, name);
  }
}

TEST(Parameters, RefusalsNameTheParameterAndItsRange) {
  const Refusal range = query_refusal({{"levels", "11"}});
  EXPECT_EQ(range.code, Code::bad_parameter);
  EXPECT_EQ(range.detail, "levels must be an integer in 0..10, not \"11\".");
  EXPECT_EQ(query_refusal({{"levels", "1.5"}}).detail, "levels must be an integer in 0..10, not \"1.5\".");
  const Refusal unknown = query_refusal({{"level", "2"}});
  EXPECT_EQ(unknown.code, Code::unknown_parameter);
  EXPECT_EQ(unknown.parameter, "level");
  EXPECT_NE(unknown.detail.find("levels"), std::string::npos);
  EXPECT_EQ(query_refusal({{"levels", "2"}, {"levels", "2"}}).parameter, "levels");
  EXPECT_EQ(query_refusal({{"scheme", "loop"}}).detail, "scheme must be red-green or in-place, not \"loop\".");
  EXPECT_EQ(query_refusal({{"output.normals", "1"}}).detail, "output.normals must be true or false, not \"1\".");
}

TEST(Parameters, RefusalsNameTheViolatedBound) {
  EXPECT_EQ(query_refusal({{"view.near", "1e300"}}).detail,
            "view.near must be a number of at most 1e+18, not \"1e300\".");
  EXPECT_EQ(query_refusal({{"view.near", "-1"}}).detail, "view.near must be a number of at least 0, not \"-1\".");
  EXPECT_EQ(query_refusal({{"view.eye", "0,1.1e18,0"}}).detail,
            "view.eye must be 3 numbers of at most 1e+18, not 1.1e+18.");
  EXPECT_EQ(query_refusal({{"view.eye", "0,0,-1e19"}}).detail,
            "view.eye must be 3 numbers of at least -1e+18, not -1e+19.");
  EXPECT_EQ(query_refusal({{"view.eye", "1,2"}}).detail, "view.eye must be 3 numbers, not \"1,2\".");
  EXPECT_EQ(query_refusal({{"flatness", "0.5,3"}}).detail, "flatness must be 1 to 10 numbers of at most 1, not 3.");
  EXPECT_EQ(json_refusal("{\"view\": {\"near\": 1e300}}").detail,
            "view.near must be a number of at most 1e+18, not 1e+300.");
  EXPECT_EQ(parse_query({{"view.eye", "1e18,0,0"}}).options.view->eye.x, 1e18);
}

TEST(Parameters, MisspeltNamesGetASuggestion) {
  for (const auto& [typed, meant] : std::vector<std::pair<std::string, std::string>>{
           {"tolerence", "tolerance"}, {"crease-angle", "crease_angle"}, {"eye", "view.eye"}, {"level", "levels"}}) {
    const Refusal refusal = query_refusal({{typed, "1"}});
    EXPECT_EQ(refusal.code, Code::unknown_parameter);
    EXPECT_EQ(refusal.detail, "Unknown parameter \"" + typed + "\". Did you mean " + meant + "?");
  }
  EXPECT_NE(json_refusal("{\"view\": {\"edgePixels\": 1}}").detail.find("Did you mean view.edge_pixels?"),
            std::string::npos);
  EXPECT_NE(query_refusal({{"colour", "1"}}).detail.find("The parameters are levels, "), std::string::npos);
}

TEST(Parameters, DegenerateViewsAreRefusedByParameter) {
  EXPECT_EQ(query_refusal({{"view.eye", "1,2,3"}, {"view.target", "1,2,3"}}).parameter, "view.target");
  EXPECT_EQ(query_refusal({{"view.eye", "0,0,3"}, {"view.target", "0,0,0"}, {"view.up", "0,0,1"}}).parameter,
            "view.up");
  EXPECT_EQ(query_refusal({{"view.up", "0,0,0"}}).parameter, "view.up");
}

TEST(Parameters, MalformedAndMistypedJsonIsRefused) {
  EXPECT_EQ(json_refusal("").code, Code::bad_request);
  EXPECT_EQ(json_refusal("{\"levels\": 2").code, Code::bad_request);
  EXPECT_EQ(json_refusal("[1]").code, Code::bad_request);
  EXPECT_EQ(json_refusal("{\"levels\": \"2\"}").parameter, "levels");
  EXPECT_EQ(json_refusal("{\"levels\": [2]}").parameter, "levels");
  EXPECT_EQ(json_refusal("{\"levels\": null}").parameter, "levels");
  EXPECT_EQ(json_refusal("{\"flatness\": 0.5}").parameter, "flatness");
  EXPECT_EQ(json_refusal("{\"view\": 3}").parameter, "view");
  EXPECT_EQ(json_refusal("{\"view\": {\"eyes\": [0,0,1]}}").parameter, "view.eyes");
  EXPECT_EQ(json_refusal("{\"view.eye\": [0,0,1]}").code, Code::unknown_parameter);
  EXPECT_EQ(json_refusal("{\"levels\": 1, \"levels\": 2}").parameter, "levels");
  EXPECT_EQ(json_refusal("{\"view\": {\"near\": 1, \"near\": 2}}").parameter, "near");
  EXPECT_EQ(json_refusal(std::string(70000, ' ')).code, Code::body_too_large);
  EXPECT_EQ(json_refusal(std::string(60000, '[')).code, Code::bad_request);
  EXPECT_EQ(json_refusal("{\"levels\": " + std::string(30000, '[') + std::string(30000, ']') + "}").code,
            Code::bad_request);
  EXPECT_EQ(json_refusal("{\"levels\": 1e400}").code, Code::bad_request);
  EXPECT_EQ(json_refusal("{\"flatness\": [1e400]}").code, Code::bad_request);
}

TEST(Parameters, MarkdownAndJsonListEveryParameter) {
  const auto rows = nlohmann::json::parse(parameters_json());
  ASSERT_EQ(rows.size(), parameter_table().size());
  const std::string markdown = parameters_markdown();
  for (const auto& row : rows) {
    EXPECT_NE(markdown.find("`" + row["name"].get<std::string>() + "`"), std::string::npos);
    EXPECT_FALSE(row["description"].get<std::string>().empty());
    EXPECT_TRUE(row.contains("default"));
  }
}

TEST(Problem, TableHasEveryCodeInOrder) {
  size_t index = 0;
  for (const ProblemKind& kind : problem_kinds()) {
    EXPECT_EQ(static_cast<size_t>(kind.code), index++);
    EXPECT_GE(kind.status, 400);
    EXPECT_FALSE(kind.title.empty());
  }
  EXPECT_EQ(index, static_cast<size_t>(Code::internal) + 1);
}

TEST(Problem, JsonEscapesAnyDetail) {
  const Problem problem(Code::bad_parameter, "not \"\xff\n<b>\"", "levels");
  const auto document = nlohmann::json::parse(problem.json("id-1"));
  EXPECT_EQ(document["type"], "urn:papilio:problem:bad_parameter");
  EXPECT_EQ(document["code"], "bad_parameter");
  EXPECT_EQ(document["status"], 400);
  EXPECT_EQ(document["parameter"], "levels");
  EXPECT_EQ(document["request_id"], "id-1");
}

}  // namespace
}  // namespace papilio::proto
