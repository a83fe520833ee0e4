#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>

#include "papilio/refine.h"
#include "tests/bench/equal_size.h"
#include "tests/bench/head.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/mesh_figures.h"
#include "tests/bench/report.h"
#include "tests/support/collapse_optimally.h"
#include "tests/support/real_mesh.h"
#include "tests/support/simplify.h"

// Quality at equal size: distance of results of equal face count from the uniform result of the last level. The paper's
// method, in-place by flatness, sets the sizes. The baseline is Garland and Heckbert's simplification of the uniform
// result with optimal placement: it requires the whole uniform result and may move every vertex.

namespace papilio::bench {
namespace {

struct Case {
  std::string name;
  TriangleMesh coarse;
  int levels;
  std::vector<double> thresholds;  ///< flatness of the middle size
};

/// Sizes of quadrics' results, as shares of the common size, between which those of equal RMS distance are sought.
constexpr double quadrics_sizes[] = {1.2, 1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3};
constexpr size_t common_size = 1;  // of them

/// Factors of the thresholds' angles for the three sizes.
constexpr double size_factors[] = {1.5, 1, 1 / 1.5};

/// Largest relative difference of face counts without a mark.
constexpr double count_tolerance = 0.02;

TriangleMesh simplified(const std::string& name, size_t faces) {
  return test::simplify(test::real_mesh("cgal/" + name + ".off"), faces);
}

std::vector<Case> cases() {
  const TriangleMesh bunny = simplified("bunny00", 600);
  return {{"bunny00, 600 faces, 4 levels", bunny, 4, {0.6, 0.7, 0.8, 0.9}},
          {"bunny00, 600 faces, 2 levels", bunny, 2, {0.8, 0.9}},
          {"refined_elephant, 1500 faces, 3 levels", simplified("refined_elephant", 1500), 3, {0.8, 0.9, 0.95}},
          {"camel, 2000 faces, 3 levels", simplified("camel", 2000), 3, {0.8, 0.9, 0.95}},
          {"armadillo, 3000 faces, 3 levels", simplified("armadillo", 3000), 3, {0.8, 0.9, 0.95}},
          {"head, 2092 faces, 2 levels", head(), 2, {0.8, 0.9}},
          {"rotor_small, 4800 faces, 2 levels", test::real_mesh("cgal/rotor_small.off"), 2, {0.8, 0.9}},
          {"couplingdown, 3714 faces, 2 levels", test::real_mesh("cgal/couplingdown.off"), 2, {0.8, 0.9}},
          {"fandisk, 2000 faces, 2 levels", simplified("fandisk", 2000), 2, {0.8, 0.9}}};
}

/// Result of one method; distances in percent of the coarse mesh's diagonal.
struct Measured {
  size_t faces;
  SurfaceError error;
};

/// Results of the methods at one size.
struct Comparison {
  Measured paper, flatness, tolerance, quadrics;
  double quadrics_faces;  ///< faces of quadrics' result with the RMS distance of `tolerance`
};

/// Returns the number of faces at which a curve of decreasing RMS distances, given by some of its points, has this one:
/// interpolated between logarithms.
double faces_at(const std::vector<Measured>& curve, double rms) {
  size_t i = 1;
  while (i + 1 < curve.size() && curve[i].error.rms > rms) ++i;
  const Measured& coarser = curve[i - 1];
  const Measured& finer = curve[i];
  const double at = std::log(coarser.error.rms / rms) / std::log(coarser.error.rms / finer.error.rms);
  const auto faces = [](const Measured& of) { return static_cast<double>(of.faces); };
  return faces(coarser) * std::pow(faces(finer) / faces(coarser), at);
}

bool is_far_off(size_t faces, size_t wanted) {
  return std::abs(static_cast<double>(faces) / static_cast<double>(wanted) - 1) > count_tolerance;
}

/// Returns whether the ratio is valid: a method with more faces than the others has an advantage, one with fewer has
/// none.
bool is_fair(const Comparison& c) {
  return c.tolerance.faces <= c.paper.faces || !is_far_off(c.tolerance.faces, c.paper.faces);
}

/// A case with its uniform result. All use the plain Modified Butterfly scheme.
class Subject {
 public:
  explicit Subject(const Case& the_case) : case_(the_case), coarse_(build_mesh(the_case.coarse)) {
    uniform_ = refine(coarse_, options(Scheme::in_place)).mesh.triangles();
  }

  [[nodiscard]] size_t uniform_faces() const { return uniform_.triangles.size(); }

  [[nodiscard]] Comparison compare(double size_factor) const {
    Options paper = options(Scheme::in_place);
    Options ours = options(Scheme::red_green);
    ours.flatness = paper.flatness = scaled_thresholds(case_.thresholds, size_factor);
    const TriangleMesh result = refine(coarse_, paper).mesh.triangles();
    const size_t faces = result.triangles.size();
    const std::vector<Measured> quadrics = quadrics_results(faces);
    const Measured tolerance = measured(tolerance_result(coarse_, ours, faces));
    return {.paper = measured(result),
            .flatness = measured(flatness_result(coarse_, ours, faces)),
            .tolerance = tolerance,
            .quadrics = quadrics[quadrics.size() - 1 - common_size],
            .quadrics_faces = faces_at(quadrics, tolerance.error.rms)};
  }

 private:
  [[nodiscard]] Options options(Scheme scheme) const {
    Options all;
    all.levels = case_.levels;
    all.scheme = scheme;
    all.tension = Tension::off;
    return all;
  }

  /// Returns quadrics' results of the sizes about `faces`, the coarsest first.
  [[nodiscard]] std::vector<Measured> quadrics_results(size_t faces) const {
    std::vector<size_t> sizes;
    for (double share : quadrics_sizes) {
      const auto size = static_cast<size_t>(std::lround(share * static_cast<double>(faces)));
      sizes.push_back(std::min(size, uniform_.triangles.size()));
    }
    std::vector<Measured> results;
    for (const TriangleMesh& result : collapse_to_sizes(uniform_, sizes, Quadrics::accumulated))
      results.push_back(measured(result));
    if (results.size() != sizes.size()) throw std::runtime_error("quadrics cannot make all sizes");
    std::ranges::reverse(results);
    return results;
  }

  [[nodiscard]] Measured measured(const TriangleMesh& result) const {
    const double percent = 100 / bounding_box(coarse_.positions).diagonal();
    const SurfaceError error = surface_error(uniform_, result);
    return {result.triangles.size(), {percent * error.rms, percent * error.largest}};
  }

  const Case& case_;
  Mesh coarse_;
  TriangleMesh uniform_;
};

/// Returns the faces of red-green by tolerance over those of quadrics at equal RMS distance.
double faces_ratio(const Comparison& c) { return static_cast<double>(c.tolerance.faces) / c.quadrics_faces; }

/// Measured ratios.
struct Range {
  double least = std::numeric_limits<double>::infinity(), most = 0;

  void include(double ratio) {
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  [[nodiscard]] std::string text() const { return fixed(least, 2) + " to " + fixed(most, 2); }
};
struct Summary {
  Range to_paper, to_quadrics, faces_to_quadrics;
  int fair = 0, all = 0;

  void include(const Comparison& c) {
    ++all;
    if (!is_fair(c)) return;
    ++fair;
    to_paper.include(c.tolerance.error.rms / c.paper.error.rms);
    to_quadrics.include(c.tolerance.error.rms / c.quadrics.error.rms);
    faces_to_quadrics.include(faces_ratio(c));
  }
};

/// Returns "RMS / largest", preceded by the number of faces if it differs from the target and by a star if by much.
std::string text_of(const Measured& method, size_t faces) {
  std::string text = fixed(method.error.rms, 4) + " / " + fixed(method.error.largest, 3);
  if (method.faces != faces) text = std::to_string(method.faces) + ": " + text;
  return is_far_off(method.faces, faces) ? "*" + text : text;
}

std::string ratio_text(const Comparison& c, const Measured& other) {
  return is_fair(c) ? fixed(c.tolerance.error.rms / other.error.rms, 2) : "-";
}

/// Table and rows of --json.
class Quality {
 public:
  void add(const std::string& name, size_t uniform_faces, const Comparison& c) {
    const size_t faces = c.paper.faces;
    const double share = 100 * static_cast<double>(faces) / static_cast<double>(uniform_faces);
    table_.add({name, std::to_string(faces), fixed(share, 1) + " %", text_of(c.paper, faces),
                text_of(c.flatness, faces), text_of(c.tolerance, faces), text_of(c.quadrics, faces),
                ratio_text(c, c.paper), ratio_text(c, c.quadrics), is_fair(c) ? fixed(faces_ratio(c), 2) : "-"});
    summary_.include(c);
    const std::string prefix = "quality/" + name + ", " + std::to_string(faces) + "/";
    add_rows(prefix + "flatness, peer: the paper", c.flatness, c.paper);
    if (!is_fair(c)) return;
    add_rows(prefix + "tolerance, peer: the paper", c.tolerance, c.paper);
    add_rows(prefix + "tolerance, peer: quadrics, optimal placement", c.tolerance, c.quadrics);
    rows_.push_back({prefix + "tolerance, peer: quadrics of equal rms/faces", static_cast<double>(c.tolerance.faces),
                     c.quadrics_faces, "faces"});
  }

  void print() const {
    std::printf(
        "RMS / largest distance from the uniform result's vertices, %% of the diagonal. Where a method's number of\n");
    std::printf(
        "faces differs, it stands in front; * where by more than %.0f %%. Ratios: RMS of red-green by tolerance\n",
        100 * count_tolerance);
    std::printf("over that of the other; in the last column, of its faces over those of quadrics at equal RMS.\n\n");
    table_.print();
    std::printf("\nRed-green by tolerance met %d of %d sizes.\n", summary_.fair, summary_.all);
    if (summary_.fair == 0) return;
    std::printf("Its ratios: %s to the paper, %s to quadrics, %s in faces.\n", summary_.to_paper.text().c_str(),
                summary_.to_quadrics.text().c_str(), summary_.faces_to_quadrics.text().c_str());
  }

  [[nodiscard]] const std::vector<ReportRow>& rows() const { return rows_; }

 private:
  void add_rows(const std::string& name, const Measured& ours, const Measured& peer) {
    rows_.push_back({name + "/faces", static_cast<double>(ours.faces), static_cast<double>(peer.faces), "faces"});
    rows_.push_back({name + "/rms", ours.error.rms, peer.error.rms, "% of the diagonal"});
    rows_.push_back({name + "/largest", ours.error.largest, peer.error.largest, "% of the diagonal"});
  }

  MarkdownTable table_{{"", "faces", "of uniform", "in-place by flatness (the paper)", "red-green by flatness",
                        "red-green by tolerance", "quadrics, optimal placement (Garland-Heckbert)", "to the paper",
                        "to quadrics", "in faces"}};
  Summary summary_;
  std::vector<ReportRow> rows_;
};

std::vector<ReportRow> print_quality() {
  Quality quality;
  for (const Case& the_case : cases()) {
    const Subject subject(the_case);
    for (double factor : size_factors) {
      std::cerr << "quality: " << the_case.name << ", thresholds' angles times " << fixed(factor, 2) << '\n';
      quality.add(the_case.name, subject.uniform_faces(), subject.compare(factor));
    }
  }
  quality.print();
  return quality.rows();
}

}  // namespace

void add_quality() { add(Report{"quality", print_quality}); }

}  // namespace papilio::bench
