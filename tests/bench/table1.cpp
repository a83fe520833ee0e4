#include <cstdio>
#include <iostream>
#include <optional>

#include "papilio/refine.h"
#include "server/samples/models.h"
#include "tests/bench/head.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/mesh_figures.h"
#include "tests/bench/report.h"

// The paper's Table 1, measured on substitutes for its models, with the paper's figures.

namespace papilio::bench {
namespace {

struct Counts {
  size_t vertices = 0, faces = 0;
};

struct Model {
  std::string name, stand_in;
  TriangleMesh coarse;
  int levels;
  std::vector<double> thresholds;
  std::optional<View> view;
  Counts paper_uniform, paper_adaptive, paper_view;
};

struct NamedScheme {
  const char* name;
  Scheme scheme;
};

/// Distances in percent of the coarse model's diagonal, the angle in degrees.
struct Shape {
  double rms, largest, smallest_angle;
};

std::vector<Model> models() {
  const TriangleMesh spock = head();
  return {{.name = "mug",
           .stand_in = "mug, made by program",
           .coarse = server::mug(),
           .levels = 2,
           .thresholds = {0.6, 0.78},
           .view = {},
           .paper_uniform = {2752, 5504},
           .paper_adaptive = {1403, 2806},
           .paper_view = {}},
          {.name = "wheel",
           .stand_in = "wheel, made by program",
           .coarse = server::wheel(),
           .levels = 4,
           .thresholds = {0.6, 0.7, 0.8, 0.9},
           .view = {},
           .paper_uniform = {37138, 74240},
           .paper_adaptive = {18489, 36942},
           .paper_view = {}},
          {.name = "head",
           .stand_in = "head, a mannequin's for Spock's",
           .coarse = spock,
           .levels = 2,
           .thresholds = {0.8, 0.9},
           .view = front_view(spock),
           .paper_uniform = {16738, 33472},
           .paper_adaptive = {9274, 18544},
           .paper_view = {2519, 5034}}};
}

/// Options of the plain Modified Butterfly scheme: the paper's tension factors are unknown.
Options options_of(const Model& model, Scheme scheme) {
  Options options;
  options.levels = model.levels;
  options.scheme = scheme;
  options.tension = Tension::off;
  return options;
}

TriangleMesh refined(const TriangleMesh& coarse, const Options& options) {
  return refine(build_mesh(coarse), options).mesh.triangles();
}

Counts counts_of(const TriangleMesh& mesh) { return {mesh.positions.size(), mesh.triangles.size()}; }

std::string text_of(Counts counts) {
  return counts.faces == 0 ? "" : std::to_string(counts.vertices) + "/" + std::to_string(counts.faces);
}

double saving(Counts adaptive, Counts uniform) {
  return 100 * (1 - static_cast<double>(adaptive.faces) / static_cast<double>(uniform.faces));
}

/// Both tables and rows of --json, model by model.
class Table1 {
 public:
  void add(const Model& model) {
    const TriangleMesh uniform = refined(model.coarse, options_of(model, Scheme::in_place));
    add_counts_of_paper(model);
    add_shape(model.name + ", coarse", model.coarse, {"", ""});
    add_shape(model.name + ", uniform", uniform, {"0", "0"});
    const Shape paper = add(model, {"in-place", Scheme::in_place}, uniform);
    const Shape ours = add(model, {"red-green", Scheme::red_green}, uniform);
    add_rows("table1/" + model.name + "/red-green, peer: in-place", ours, paper);
  }

  void print() const {
    std::printf("Vertices/faces. Saving: faces of the uniform result that the adaptive one does without.\n\n");
    counts_.print();
    std::printf(
        "\nDistances: from the uniform result's vertices to the surface, %% of the coarse model's diagonal. "
        "Valences: %% of the vertices.\n\n");
    shapes_.print();
  }

  [[nodiscard]] const std::vector<ReportRow>& rows() const { return rows_; }

 private:
  void add_counts_of_paper(const Model& model) {
    counts_.add({"**" + model.stand_in + "**", "", "", "", "", ""});
    counts_.add({"the paper", text_of(counts_of(model.coarse)), text_of(model.paper_uniform),
                 text_of(model.paper_adaptive), fixed(saving(model.paper_adaptive, model.paper_uniform), 1) + " %",
                 text_of(model.paper_view)});
  }

  Shape add(const Model& model, const NamedScheme& scheme, const TriangleMesh& uniform) {
    Options options = options_of(model, scheme.scheme);
    options.flatness = model.thresholds;
    const TriangleMesh adaptive = refined(model.coarse, options);
    Counts seen;
    if (model.view) {
      options.view = model.view;
      seen = counts_of(refined(model.coarse, options));
    }
    const Counts counts = counts_of(adaptive);
    counts_.add({scheme.name, text_of(counts_of(model.coarse)), text_of(counts_of(uniform)), text_of(counts),
                 fixed(saving(counts, counts_of(uniform)), 1) + " %", text_of(seen)});
    const SurfaceError error = surface_error(uniform, adaptive);
    const double percent = 100 / bounding_box(model.coarse.positions).diagonal();
    add_shape(model.name + ", " + scheme.name, adaptive,
              {fixed(percent * error.rms, 3), fixed(percent * error.largest, 2)});

    const std::string name = "table1/" + model.name + "/" + scheme.name;
    add_rows(name + "/adaptive", counts, model.paper_adaptive);
    if (model.view) add_rows(name + "/view", seen, model.paper_view);
    rows_.push_back({name + "/adaptive/saving", saving(counts, counts_of(uniform)),
                     saving(model.paper_adaptive, model.paper_uniform), "%"});
    return {percent * error.rms, percent * error.largest, smallest_angle(adaptive)};
  }

  /// The paper has no such figures: its scheme is the baseline.
  void add_rows(const std::string& name, const Shape& ours, const Shape& paper) {
    rows_.push_back({name + "/rms", ours.rms, paper.rms, "% of the diagonal"});
    rows_.push_back({name + "/largest", ours.largest, paper.largest, "% of the diagonal"});
    rows_.push_back({name + "/smallest angle", ours.smallest_angle, paper.smallest_angle, "degrees"});
  }

  void add_rows(const std::string& name, Counts ours, Counts paper) {
    rows_.push_back(
        {name + "/vertices", static_cast<double>(ours.vertices), static_cast<double>(paper.vertices), "vertices"});
    rows_.push_back({name + "/faces", static_cast<double>(ours.faces), static_cast<double>(paper.faces), "faces"});
  }

  struct ErrorText {
    std::string rms, largest;
  };
  void add_shape(const std::string& name, const TriangleMesh& mesh, const ErrorText& error) {
    std::vector<std::string> row{name, error.rms, error.largest, fixed(smallest_angle(mesh), 1) + "°"};
    for (double share : valence_shares(mesh)) row.push_back(fixed(100 * share, 1));
    shapes_.add(row);
  }

  MarkdownTable counts_{{"", "coarse", "uniform", "adaptive", "saving", "in view, 10 px"}};
  MarkdownTable shapes_{
      {"", "RMS distance", "largest", "smallest angle", "valence 3", "4", "5", "6", "7", "8", "9 or more"}};
  std::vector<ReportRow> rows_;
};

std::vector<ReportRow> print_table1() {
  Table1 table;
  for (const Model& model : models()) {
    std::cerr << "table1: " << model.stand_in << '\n';
    table.add(model);
  }
  table.print();
  return table.rows();
}

}  // namespace

void add_table1() { add(Report{"table1", print_table1}); }

}  // namespace papilio::bench
