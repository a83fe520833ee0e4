#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <numbers>

#include "papilio/refine.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/report.h"
#include "tests/support/rasteriser.h"
#include "tests/support/real_mesh.h"
#include "tests/support/simplify.h"

// Vertices for an equal picture: fewest vertices, over a view's criteria, whose smooth-shaded picture has a PSNR of at
// least 45 dB to the uniform result's, as a share of the vertices that the uniform result adds.

namespace papilio::bench {
namespace {

constexpr double wanted_psnr = 45;  // dB
constexpr int bisections = 8;

struct PictureModel {
  std::string name;
  size_t faces;  ///< of its simplification; 0: not simplified
};
const std::vector<PictureModel>& picture_models() {
  static const std::vector<PictureModel> all{
      {"bunny600.obj", 0},          {"elephant2000.obj", 0}, {"cgal/camel.off", 2000},
      {"cgal/armadillo.off", 3000}, {"cgal/bull.off", 1500}, {"cgal/homer.off", 1500},
      {"cgal/lion-head.off", 2000}, {"cgal/man.off", 2000},  {"cgal/mannequin-devil.off", 2092},
      {"cgal/bear_bis.off", 1500},  {"cgal/hand.off", 1000}, {"cgal/femur.off", 800}};
  return all;
}

/// A criterion with one free parameter.
struct PictureCriterion {
  std::string name;
  double finest, coarsest;
  std::function<void(Options&, double)> set;
};
const std::vector<PictureCriterion>& picture_criteria() {
  static const std::vector<PictureCriterion> all{
      {"error_pixels", 0.003, 8, [](Options& options, double pixels) { options.view->error_pixels = pixels; }},
      {"without verify", 0.003, 8,
       [](Options& options, double pixels) {
         options.view->error_pixels = pixels;
         options.view->verify = false;
       }},
      {"with lights", 0.003, 8,
       [](Options& options, double pixels) {
         options.view->error_pixels = pixels;
         options.view->lights = {Vec3d{0.5, 0.9, 0.8}};
       }},
      {"normals (flatness)", 0.05, 60,
       [](Options& options, double degrees) { options.flatness = {std::cos(degrees * std::numbers::pi / 180)}; }}};
  return all;
}

View view_of(const Mesh& mesh) {
  View view = test::overview(mesh, 640, 480);
  view.edge_pixels = 0;
  return view;
}

/// A coarse mesh with its uniform result and its picture.
class PictureSubject {
 public:
  PictureSubject(const Mesh& coarse, int levels) : coarse_(coarse), levels_(levels), lit_(view_of(coarse)) {
    lit_.lights = {Vec3d{0.5, 0.9, 0.8}};
    const Mesh uniform = refine(coarse_, {.levels = levels_}).mesh;
    added_ = uniform.topology.vertex_count - coarse_.topology.vertex_count;
    picture_ = test::render(uniform, lit_);
  }

  [[nodiscard]] double psnr_of(const Mesh& mesh) const { return test::psnr(test::render(mesh, lit_), picture_); }

  /// Returns the smallest share of the uniform result's new vertices, in percent; 100 if no result is accurate enough.
  [[nodiscard]] double least_share(const PictureCriterion& criterion) const {
    double finest = std::log(criterion.finest);
    double coarsest = std::log(criterion.coarsest);
    uint32_t least = added_;
    for (int step = 0; step < bisections; ++step) {
      const double middle = (finest + coarsest) / 2;
      Options options{.levels = levels_, .view = view_of(coarse_)};
      criterion.set(options, std::exp(middle));
      const Mesh result = refine(coarse_, options).mesh;
      const bool is_near = psnr_of(result) >= wanted_psnr;
      if (is_near) least = std::min(least, result.topology.vertex_count - coarse_.topology.vertex_count);
      (is_near ? finest : coarsest) = middle;
    }
    return 100.0 * least / added_;
  }

 private:
  const Mesh& coarse_;
  int levels_;
  View lit_;
  uint32_t added_ = 0;
  test::Image picture_;
};

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

std::vector<ReportRow> print_pictures() {
  std::vector<std::string> header{"% of the new vertices for 45 dB", "faces", "levels", "coarse, dB"};
  for (const PictureCriterion& criterion : picture_criteria()) header.push_back(criterion.name);
  MarkdownTable table(header);
  std::vector<ReportRow> rows;
  for (int levels = 3; levels <= 5; ++levels) {
    std::vector<std::vector<double>> shares(picture_criteria().size());
    for (const PictureModel& model : picture_models()) {
      std::cerr << "picture: " << model.name << ", " << levels << " levels\n";
      const TriangleMesh mesh = test::real_mesh(model.name);
      const Mesh coarse = build_mesh(model.faces > 0 ? test::simplify(mesh, model.faces) : mesh);
      const PictureSubject subject(coarse, levels);
      std::vector<std::string> row{model.name, std::to_string(coarse.topology.face_count()), std::to_string(levels),
                                   fixed(subject.psnr_of(coarse), 1)};
      for (size_t c = 0; c < picture_criteria().size(); ++c) {
        const double share = subject.least_share(picture_criteria()[c]);
        shares[c].push_back(share);
        row.push_back(fixed(share, 1));
        rows.push_back(
            {"picture/" + model.name + ", " + std::to_string(levels) + " levels/" + picture_criteria()[c].name, share,
             shares[0].back(), "% of the uniform result's new vertices"});
      }
      table.add(row);
    }
    std::vector<std::string> row{"median", "", std::to_string(levels), ""};
    for (const std::vector<double>& of_criterion : shares) row.push_back(fixed(median(of_criterion), 1));
    table.add(row);
  }
  table.print();
  return rows;
}

}  // namespace

void add_picture() { add(Report{"picture", print_pictures}); }

}  // namespace papilio::bench
