#include <array>
#include <utility>

#include "proto/parameters.h"

namespace papilio::proto {
namespace {

using Values = std::vector<double>;

constexpr double any = 1e18;  // coordinate_limit as an exact decimal

View& view_of(Parameters& p) { return p.options.view ? *p.options.view : p.options.view.emplace(); }
View view_of(const Parameters& p) { return p.options.view.value_or(View{}); }

/// Returns no values for a default that follows from other parameters, else `value`.
Values unless(bool follows, Values value) { return follows ? Values{} : std::move(value); }

/// Returns whether `levels` has its default.
bool has_default_levels(const Options& options) {
  return has_error_target(options) ? options.stop_at_limits : options.levels == Options{}.levels;
}

Values values(Vec3d v) { return {v.x, v.y, v.z}; }
Vec3d vector(const Values& v) { return {v[0], v[1], v[2]}; }

Values values(const std::vector<Vec3d>& list) {
  Values all;
  for (Vec3d v : list) all.insert(all.end(), {v.x, v.y, v.z});
  return all;
}
std::vector<Vec3d> vectors(const Values& v) {
  std::vector<Vec3d> list;
  for (size_t i = 0; i + 2 < v.size(); i += 3) list.push_back({v[i], v[i + 1], v[i + 2]});
  return list;
}

const std::array table{
    ParameterInfo{.name = "levels",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = 10,
                  .default_text = "2; with tolerance or view.error_pixels, as many as required",
                  .description = "Number of subdivisions; a uniform level multiplies the faces by four",
                  .get =
                      [](const Parameters& p) {
                        return unless(has_default_levels(p.options), {static_cast<double>(p.options.levels)});
                      },
                  .set = [](Parameters& p, const Values& v) { p.options.levels = static_cast<int>(v[0]); }},
    ParameterInfo{
        .name = "scheme",
        .type = ParameterType::choice,
        .description =
            "Way to split; red-green: vertices equal those of the uniform result in every view, and angles stay large; "
            "in-place, the paper's: each level refines the mesh of the previous level",
        .choices = {"red-green", "in-place"},
        .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.scheme)}; },
        .set = [](Parameters& p, const Values& v) { p.options.scheme = static_cast<Scheme>(v[0]); }},
    ParameterInfo{.name = "tolerance",
                  .type = ParameterType::number,
                  .min = 0,
                  .max = 1,
                  .default_text = "0: none",
                  .description =
                      "Split where the surface would move by at least this share of the bounding box's diagonal, and "
                      "where such splits require it: 0.001 is fine, 0.01 coarse",
                  .get = [](const Parameters& p) { return Values{p.options.tolerance}; },
                  .set = [](Parameters& p, const Values& v) { p.options.tolerance = v[0]; }},
    ParameterInfo{.name = "max_faces",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = static_cast<double>(face_count_limit),
                  .unit = "faces",
                  .default_text = "0: no limit",
                  .description = "Upper bound of the faces of the result; the largest errors are refined first",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.max_faces)}; },
                  .set = [](Parameters& p, const Values& v) { p.options.max_faces = static_cast<uint64_t>(v[0]); }},
    ParameterInfo{.name = "flatness",
                  .type = ParameterType::numbers,
                  .least = 1,
                  .most = 10,
                  .min = -1,
                  .max = 1,
                  .default_text = "none: everywhere",
                  .description = "Split edges whose faces' unit normals have a dot product below this; one threshold "
                                 "per level, the last repeats; higher is finer",
                  .get = [](const Parameters& p) { return p.options.flatness; },
                  .set = [](Parameters& p, const Values& v) { p.options.flatness = v; }},
    ParameterInfo{.name = "growth",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = 2,
                  .description = "Spread of flatness: 0 none, 1 to the other edges of both faces, 2 to all edges at "
                                 "both ends",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.growth)}; },
                  .set = [](Parameters& p, const Values& v) { p.options.growth = static_cast<Growth>(v[0]); }},
    ParameterInfo{.name = "tension",
                  .type = ParameterType::choice,
                  .description =
                      "Overshoot at sharp edges; soft: none across edges sharper than 60 to 90 degrees; sharp: also "
                      "none along them; off: the plain butterfly, which overshoots there",
                  .choices = {"soft", "off", "sharp"},
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.tension)}; },
                  .set = [](Parameters& p, const Values& v) { p.options.tension = static_cast<Tension>(v[0]); }},
    ParameterInfo{.name = "shape",
                  .type = ParameterType::choice,
                  .description =
                      "What the mesh is taken for; mechanical: flat sides, edges over 31 degrees and outlines of broad "
                      "flats stay as they are; organic: only flats stay flat; auto: decided for each component; plain: "
                      "the published scheme, as always with tension=off",
                  .choices = {"auto", "organic", "mechanical", "plain"},
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.options.shape)}; },
                  .set = [](Parameters& p, const Values& v) { p.options.shape = static_cast<Shape>(v[0]); }},
    ParameterInfo{
        .name = "crease_angle",
        .type = ParameterType::number,
        .min = 0,
        .max = 180,
        .unit = "degrees",
        .default_text = "180: those of shape",
        .description =
            "Edges whose faces' normals differ by more stay sharp; below 180 it replaces the creases of shape and of "
            "the mesh's attribute smoothing_group",
        .get = [](const Parameters& p) { return Values{p.options.crease_angle}; },
        .set = [](Parameters& p, const Values& v) { p.options.crease_angle = v[0]; }},
    ParameterInfo{.name = "simplify_hidden",
                  .type = ParameterType::boolean,
                  .description = "Simplifies invisible parts and leaves the rest bit-identical; requires a view",
                  .get = [](const Parameters& p) { return Values{p.options.simplify_hidden ? 1.0 : 0.0}; },
                  .set = [](Parameters& p, const Values& v) { p.options.simplify_hidden = v[0] != 0; }},
    ParameterInfo{
        .name = "w",
        .type = ParameterType::number,
        .min = -0.0625,
        .max = 0.125,
        .description = "How far new vertices lean towards faces further away: w of the ten-point butterfly rule",
        .get = [](const Parameters& p) { return Values{p.options.w}; },
        .set = [](Parameters& p, const Values& v) { p.options.w = v[0]; }},
    ParameterInfo{
        .name = "view.eye",
        .type = ParameterType::numbers,
        .least = 3,
        .most = 3,
        .min = -any,
        .max = any,
        .unit = "mesh units",
        .default_text = "frames the whole mesh, seen from +z",
        .description = "Position of the viewer; any view parameter enables view dependence. With view.up along z, "
                       "the default looks from -y",
        .get = [](const Parameters& p) { return unless(!p.options.view || p.default_eye, values(view_of(p).eye)); },
        .set =
            [](Parameters& p, const Values& v) {
              view_of(p).eye = vector(v);
              p.default_eye = false;
            }},
    ParameterInfo{
        .name = "view.target",
        .type = ParameterType::numbers,
        .least = 3,
        .most = 3,
        .min = -any,
        .max = any,
        .unit = "mesh units",
        .default_text = "centre of the bounding box",
        .description = "Point in the centre of the picture",
        .get =
            [](const Parameters& p) { return unless(!p.options.view || p.default_target, values(view_of(p).target)); },
        .set =
            [](Parameters& p, const Values& v) {
              view_of(p).target = vector(v);
              p.default_target = false;
            }},
    ParameterInfo{.name = "view.up",
                  .type = ParameterType::numbers,
                  .least = 3,
                  .most = 3,
                  .min = -any,
                  .max = any,
                  .description = "Direction that points up in the picture",
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
                  .default_text = "10; 0 with view.error_pixels",
                  .description = "Lower bound of the screen length of split edges; 0: no bound",
                  .get =
                      [](const Parameters& p) {
                        return unless(view_of(p).edge_pixels == default_edge_pixels(view_of(p)),
                                      {view_of(p).edge_pixels});
                      },
                  .set = [](Parameters& p, const Values& v) { view_of(p).edge_pixels = v[0]; }},
    ParameterInfo{
        .name = "view.error_pixels",
        .type = ParameterType::number,
        .min = 0,
        .max = 1e6,
        .unit = "pixels",
        .default_text = "0: none",
        .description = "Largest distance from the uniform result that the view may show, in pixels: 0.5 is invisible",
        .get = [](const Parameters& p) { return Values{view_of(p).error_pixels}; },
        .set = [](Parameters& p, const Values& v) { view_of(p).error_pixels = v[0]; }},
    ParameterInfo{
        .name = "view.verify",
        .type = ParameterType::boolean,
        .description =
            "Compares what view.error_pixels gives with the uniform surface, and refines until nothing visible "
            "is further from it; false: results are ten to 160 times faster, and a few pixels off in "
            "places. Not with view.edge_pixels or view.lights",
        .get = [](const Parameters& p) { return Values{view_of(p).verify ? 1.0 : 0.0}; },
        .set = [](Parameters& p, const Values& v) { view_of(p).verify = v[0] != 0; }},
    ParameterInfo{.name = "view.two_sided",
                  .type = ParameterType::boolean,
                  .default_text = "false; true for open meshes of a scene with a doubleSided material",
                  .description = "Whether backs of faces are shown too: then none is left coarse for being turned away",
                  .get = [](const Parameters& p) { return Values{view_of(p).two_sided ? 1.0 : 0.0}; },
                  .set = [](Parameters& p, const Values& v) { view_of(p).two_sided = v[0] != 0; }},
    ParameterInfo{.name = "view.lights",
                  .type = ParameterType::numbers,
                  .least = 3,
                  .most = 24,
                  .group = 3,
                  .min = -any,
                  .max = any,
                  .default_text = "none",
                  .description =
                      "Directions towards lights: with view.error_pixels or max_faces, errors have more weight where "
                      "shading changes and on the silhouette",
                  .get = [](const Parameters& p) { return values(view_of(p).lights); },
                  .set = [](Parameters& p, const Values& v) { view_of(p).lights = vectors(v); }},
    ParameterInfo{
        .name = "view.projection",
        .type = ParameterType::choice,
        .description = "Projection; orthographic has at every depth the scale that perspective has at the target",
        .choices = {"perspective", "orthographic"},
        .get = [](const Parameters& p) { return Values{static_cast<double>(view_of(p).projection)}; },
        .set = [](Parameters& p, const Values& v) { view_of(p).projection = static_cast<Projection>(v[0]); }},
    ParameterInfo{.name = "output.position_bits",
                  .type = ParameterType::integer,
                  .min = 8,
                  .max = 16,
                  .unit = "bits",
                  .default_text = "14, or as many as the tolerance needs",
                  .description =
                      "Grid of the result's positions: 2^bits steps along 1.25 times the longest side of the "
                      "coarse mesh's box",
                  .get =
                      [](const Parameters& p) {
                        return unless(p.default_position_bits, Values{static_cast<double>(p.output.position_bits)});
                      },
                  .set =
                      [](Parameters& p, const Values& v) {
                        p.output.position_bits = static_cast<int>(v[0]);
                        p.default_position_bits = false;
                      }},
    ParameterInfo{.name = "output.speed",
                  .type = ParameterType::integer,
                  .min = 0,
                  .max = 10,
                  .description = "Draco's encoding speed: lower is smaller and slower",
                  .get = [](const Parameters& p) { return Values{static_cast<double>(p.output.speed)}; },
                  .set = [](Parameters& p, const Values& v) { p.output.speed = static_cast<int>(v[0]); }},
    ParameterInfo{
        .name = "output.normals",
        .type = ParameterType::boolean,
        .description =
            "Adds unit normals, apart at creases, to a mesh without normals; a mesh's own always become those of the "
            "refined surface, and a packed model has those of its original without being asked",
        .get = [](const Parameters& p) { return Values{p.normals ? 1.0 : 0.0}; },
        .set = [](Parameters& p, const Values& v) { p.normals = v[0] != 0; }},
    ParameterInfo{
        .name = "output.compress",
        .type = ParameterType::choice,
        .description = "Compression of a glTF scene's geometry; same: of each primitive as it came",
        .choices = {gltf::compression_names.begin(), gltf::compression_names.end()},
        .get = [](const Parameters& p) { return Values{static_cast<double>(p.compression)}; },
        .set = [](Parameters& p,
                  const Values& v) { p.compression = static_cast<gltf::Compression>(static_cast<int>(v[0])); }},
    ParameterInfo{
        .name = "split_instances",
        .type = ParameterType::boolean,
        .description =
            "Gives each node of a glTF scene a mesh of its own, as fine as it needs; else nodes that show one "
            "mesh share it, as fine as any of them needs",
        .get = [](const Parameters& p) { return Values{p.splits_instances ? 1.0 : 0.0}; },
        .set = [](Parameters& p, const Values& v) { p.splits_instances = v[0] != 0; }},
};

}  // namespace

std::span<const ParameterInfo> parameter_table() { return table; }

}  // namespace papilio::proto
