#include <array>

#include "proto/parameters.h"

namespace papilio::proto {
namespace {

using Values = std::vector<double>;

constexpr double any = coordinate_limit;

View& view_of(Parameters& p) { return p.options.view ? *p.options.view : p.options.view.emplace(); }
View view_of(const Parameters& p) { return p.options.view.value_or(View{}); }

Values values(Vec3d v) { return {v.x, v.y, v.z}; }
Vec3d vector(const Values& v) { return {v[0], v[1], v[2]}; }

const std::array table{
    ParameterInfo{.name = "levels",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = 10,
                  .description = "How many times to subdivide; a uniform level multiplies the faces by four",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.levels)}; },
                  .set = [](Parameters& p, const Values& v) { p.options.levels = static_cast<int>(v[0]); }},
    ParameterInfo{.name = "scheme",
                  .type = ParameterType::choice,
                  .description = "What a level works on; in-place, the paper's: the mesh that the level before left",
                  .choices = {"in-place"},
                  .get = [](const Parameters&) { return Values{0}; },
                  .set = [](Parameters&, const Values&) {}},
    ParameterInfo{.name = "flatness",
                  .type = ParameterType::numbers,
                  .least = 1,
                  .most = 10,
                  .min = -1,
                  .max = 1,
                  .default_text = "none: everywhere",
                  .description = "Split edges whose faces' unit normals have a product below this; one threshold a "
                                 "level, the last repeats; higher is finer",
                  .get = [](const Parameters& p) { return p.options.flatness; },
                  .set = [](Parameters& p, const Values& v) { p.options.flatness = v; }},
    ParameterInfo{.name = "growth",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = 2,
                  .description = "How far flatness spreads: 0 not at all, 1 to the other edges of the two faces, 2 to "
                                 "all edges at the two ends",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.growth)}; },
                  .set = [](Parameters& p, const Values& v) { p.options.growth = static_cast<Growth>(v[0]); }},
    ParameterInfo{.name = "w",
                  .type = ParameterType::number,
                  .min = -0.0625,
                  .max = 0.125,
                  .description = "Free parameter of the ten-point butterfly rule; 0 is the eight-point rule",
                  .get = [](const Parameters& p) { return Values{p.options.w}; },
                  .set = [](Parameters& p, const Values& v) { p.options.w = v[0]; }},
    ParameterInfo{.name = "view.eye",
                  .type = ParameterType::numbers,
                  .least = 3,
                  .most = 3,
                  .min = -any,
                  .max = any,
                  .unit = "mesh units",
                  .description = "Where the viewer is; any view parameter turns view-dependence on",
                  .get = [](const Parameters& p) { return values(view_of(p).eye); },
                  .set = [](Parameters& p, const Values& v) { view_of(p).eye = vector(v); }},
    ParameterInfo{.name = "view.target",
                  .type = ParameterType::numbers,
                  .least = 3,
                  .most = 3,
                  .min = -any,
                  .max = any,
                  .unit = "mesh units",
                  .description = "The point looked at",
                  .get = [](const Parameters& p) { return values(view_of(p).target); },
                  .set = [](Parameters& p, const Values& v) { view_of(p).target = vector(v); }},
    ParameterInfo{.name = "view.up",
                  .type = ParameterType::numbers,
                  .least = 3,
                  .most = 3,
                  .min = -any,
                  .max = any,
                  .description = "The direction that is up in the picture",
                  .get = [](const Parameters& p) { return values(view_of(p).up); },
                  .set = [](Parameters& p, const Values& v) { view_of(p).up = vector(v); }},
    ParameterInfo{.name = "view.fov_y",
                  .type = ParameterType::number,
                  .min = 0.01,
                  .max = 179,
                  .unit = "degrees",
                  .description = "Vertical field of view",
                  .get = [](const Parameters& p) { return Values{view_of(p).fov_y}; },
                  .set = [](Parameters& p, const Values& v) { view_of(p).fov_y = v[0]; }},
    ParameterInfo{.name = "view.viewport",
                  .type = ParameterType::numbers,
                  .least = 2,
                  .most = 2,
                  .min = 1,
                  .max = 1e6,
                  .unit = "pixels",
                  .description = "Width and height of the picture",
                  .get =
                      [](const Parameters& p) {
                        const View view = view_of(p);
                        return Values(view.viewport.begin(), view.viewport.end());
                      },
                  .set =
                      [](Parameters& p, const Values& v) {
                        view_of(p).viewport = {v[0], v[1]};
                      }},
    ParameterInfo{.name = "view.near",
                  .type = ParameterType::number,
                  .min = 0,
                  .max = any,
                  .unit = "mesh units",
                  .default_text = "0: a thousandth of the distance to the target",
                  .description = "Distance of the near plane",
                  .get = [](const Parameters& p) { return Values{view_of(p).near}; },
                  .set = [](Parameters& p, const Values& v) { view_of(p).near = v[0]; }},
    ParameterInfo{.name = "view.edge_pixels",
                  .type = ParameterType::number,
                  .min = 0,
                  .max = 1e6,
                  .unit = "pixels",
                  .description = "Edges that look shorter than this stay whole; 0 splits them however short",
                  .get = [](const Parameters& p) { return Values{view_of(p).edge_pixels}; },
                  .set = [](Parameters& p, const Values& v) { view_of(p).edge_pixels = v[0]; }},
    ParameterInfo{.name = "view.projection",
                  .type = ParameterType::choice,
                  .description = "Orthographic shows at every depth what perspective shows at the target",
                  .choices = {"perspective", "orthographic"},
                  .get = [](const Parameters& p) { return Values{static_cast<double>(view_of(p).projection)}; },
                  .set = [](Parameters& p, const Values& v) { view_of(p).projection = static_cast<Projection>(v[0]); }},
    ParameterInfo{.name = "output.position_bits",
                  .type = ParameterType::integer,
                  .min = 8,
                  .max = 16,
                  .unit = "bits",
                  .description = "Grid of the answer's positions: 2^bits steps along the coarse mesh's longest side "
                                 "and a quarter more",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.output.position_bits)}; },
                  .set = [](Parameters& p, const Values& v) { p.output.position_bits = static_cast<int>(v[0]); }},
    ParameterInfo{.name = "output.speed",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = 10,
                  .description = "Draco's encoding speed: lower is smaller and slower",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.output.speed)}; },
                  .set = [](Parameters& p, const Values& v) { p.output.speed = static_cast<int>(v[0]); }},
    ParameterInfo{.name = "output.normals",
                  .type = ParameterType::boolean,
                  .description = "Adds the vertices' unit normals to the answer",
                  .get = [](const Parameters& p) { return Values{p.output.normals ? 1.0 : 0.0}; },
                  .set = [](Parameters& p, const Values& v) { p.output.normals = v[0] != 0; }},
};

}  // namespace

std::span<const ParameterInfo> parameter_table() { return table; }

}  // namespace papilio::proto
