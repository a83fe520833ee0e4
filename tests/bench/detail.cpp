#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <stdexcept>

#include "client/mesh_file/mesh_file.h"
#include "papilio/detail.h"
#include "papilio/refine.h"
#include "proto/detail/pack.h"
#include "tests/bench/detail_picture.h"
#include "tests/bench/markdown_table.h"
#include "tests/bench/pairs.h"
#include "tests/bench/report.h"
#include "tests/support/decoded_detail.h"
#include "tests/support/detail_baseline.h"
#include "tests/support/real_mesh.h"

// Bytes at equal distance: size of a fine original encoded within an RMS distance. All models of libcgal-demo above
// 20,000 faces are measured.

namespace papilio::bench {
namespace {

using test::DetailMethod;
using test::DetailSubject;
using test::RatePoint;

constexpr size_t fewest_faces = 20'000;
constexpr double distances[] = {0.05, 0.02, 0.01, 0.005};  // RMS, % of the diagonal

/// Returns the length of the binary chunk of a file.
double chunk_bytes(const std::string& glb) {
  const auto number_at = [&](size_t at) {
    uint32_t number = 0;
    std::memcpy(&number, glb.data() + at, sizeof(number));  // little-endian, as this machine
    return number;
  };
  return number_at(20 + number_at(12));
}

/// Packs the model for each distance, as the command line does: the file has levels, or a simplified mesh, or plain
/// Draco. Counts the binary chunk, table included, without the container, which other methods lack too.
std::vector<RatePoint> packed_points(const DetailSubject& subject) {
  std::vector<RatePoint> points;
  for (const double rms : distances) {
    const auto packed = proto::detail::pack(subject.original, {.rms = rms / 100, .simplifies = true});
    TriangleMesh decoded;
    if (packed.model)
      decoded = test::decoded_triangles(packed.model->base, packed.model->streams());
    else
      decoded = proto::detail::read_plain_draco(packed.glb, {}).value().mesh;
    const test::SampledDistance distance = subject.surface.distance_to(decoded);
    points.push_back({chunk_bytes(packed.glb), distance.rms, distance.largest});
    const bool is_simplified = !packed.model && packed.simplified && packed.simplified->bytes == packed.glb.size();
    std::cerr << "\ndetail: " << subject.name << ", " << rms << " %: " << fixed(points.back().bytes, 0) << " bytes, "
              << (packed.model    ? std::to_string(packed.folds) + " faces turned over"
                  : is_simplified ? "simplified; " + packed.reason
                                  : "plain Draco; " + packed.reason);
  }
  return points;
}

/// The last method is compared with the best of the methods before it.
std::vector<DetailMethod> methods() {
  std::vector<DetailMethod> all = test::detail_baselines();
  all.push_back({"papilio pack", packed_points});
  return all;
}

struct Model {
  std::string name, kind;
  TriangleMesh mesh;
};

/// Returns a description such as "open, 2 of 3 parts mechanical".
std::string kind_of(const Mesh& mesh, const BuildReport& found) {
  const ShapeReport shape = shape_of(mesh);
  std::string kind = found.boundary_edges > 0 ? "open" : "closed";
  if (found.non_manifold_edges + found.misoriented_edges + found.pinched_vertices > 0) kind += ", not manifold";
  if (shape.mechanical == 0) return kind + ", organic";
  if (shape.mechanical == shape.components) return kind + ", mechanical";
  return kind + ", " + std::to_string(shape.mechanical) + " of " + std::to_string(shape.components) +
         " parts mechanical";
}

/// Returns nothing if the file has too few faces or is no triangle mesh.
std::optional<Model> load(const std::filesystem::path& file) {
  try {
    const TriangleMesh read = client::read_triangles(file, client::format_of(file));
    BuildReport found;
    const Mesh mesh = build_mesh({read.positions, read.triangles}, &found);
    if (mesh.topology.face_count() <= fewest_faces) return std::nullopt;
    return Model{file.stem().string(), kind_of(mesh, found), mesh.triangles()};
  } catch (const client::FileError&) {
  } catch (const Error&) {
  }
  return std::nullopt;
}

std::string text_of(const std::optional<RatePoint>& point) {
  return point ? fixed(point->bytes, 0) + " / " + fixed(point->largest, 3) : "-";
}

double bytes_of(const std::optional<RatePoint>& point) {
  return point ? point->bytes : std::numeric_limits<double>::infinity();
}

/// Table, picture and rows of --json.
class Detail {
 public:
  explicit Detail(std::vector<DetailMethod> methods) : methods_(std::move(methods)), table_(header()) {}

  void add(const Model& model) {
    const DetailSubject subject(model.name, model.mesh);
    DetailPanel panel{model.name, {}};
    for (const DetailMethod& method : methods_) panel.curves.push_back(measured(method, subject));
    for (const double rms : distances) add_row(model, panel, rms);
    panels_.push_back(std::move(panel));
  }

  void print() const {
    std::printf(
        "Bytes / largest distance at equal RMS distance. Distances are two-sided, in %% of the diagonal, from\n");
    std::printf("%zu samples of each surface. Ratio: bytes of the best other method over those of %s; of\n",
                test::SampledSurface::default_samples, methods_.back().name.c_str());
    std::printf("largest: its largest distance over that of the best other method.\n\n");
    table_.print();
  }

  [[nodiscard]] const std::vector<ReportRow>& rows() const { return rows_; }
  [[nodiscard]] std::string picture() const { return detail_picture(panels_); }

 private:
  [[nodiscard]] std::vector<std::string> header() const {
    std::vector<std::string> cells{"", "faces", "kind", "RMS %"};
    for (const DetailMethod& method : methods_) cells.push_back(method.name);
    cells.emplace_back("ratio");
    cells.emplace_back("of largest");
    return cells;
  }

  static DetailCurve measured(const DetailMethod& method, const DetailSubject& subject) {
    std::cerr << "detail: " << subject.name << ", " << method.name << std::flush;
    std::vector<RatePoint> points;
    const double time = seconds([&] { points = method.points(subject); });
    std::cerr << ": " << points.size() << " points, " << fixed(time, 1) << " s\n";
    return {method.name, test::lower_envelope(std::move(points))};
  }

  void add_row(const Model& model, const DetailPanel& panel, double rms) {
    const bool is_first = rms == distances[0];
    std::vector<std::string> cells{is_first ? model.name : "",
                                   is_first ? std::to_string(model.mesh.triangles.size()) : "",
                                   is_first ? model.kind : "", fixed(rms, 3)};
    std::optional<RatePoint> last, best_other;
    for (const DetailCurve& curve : panel.curves) {
      if (bytes_of(last) < bytes_of(best_other)) best_other = last;
      last = test::at_rms(curve.envelope, rms);
      cells.push_back(text_of(last));
    }
    const bool both = last && best_other;
    cells.push_back(both ? fixed(best_other->bytes / last->bytes, 2) : "-");
    cells.push_back(both ? fixed(last->largest / best_other->largest, 2) : "-");
    table_.add(cells);
    if (!both) return;
    const std::string name = "detail/" + model.name + "/" + fixed(rms, 3) + "/" + methods_.back().name;
    rows_.push_back({name + "/bytes, peer: the best other", last->bytes, best_other->bytes, "bytes"});
    rows_.push_back({name + "/largest, peer: the best other", last->largest, best_other->largest, "% of the diagonal"});
  }

  std::vector<DetailMethod> methods_;
  MarkdownTable table_;
  std::vector<ReportRow> rows_;
  std::vector<DetailPanel> panels_;
};

bool is_chosen(const std::filesystem::path& file, const std::vector<std::string>& only) {
  return only.empty() || std::ranges::find(only, file.stem().string()) != only.end();
}

void write_picture(const std::string& svg) {
  std::ofstream out(PAPILIO_DETAIL_PICTURE);
  out << svg;
  out.close();
  if (!out) throw std::runtime_error("cannot write " PAPILIO_DETAIL_PICTURE);
  std::cerr << "detail: the curves are in " PAPILIO_DETAIL_PICTURE "\n";
}

std::vector<ReportRow> print_detail(const std::vector<std::string>& only) {
  Detail detail(methods());
  size_t models = 0;
  for (const std::filesystem::path& file : test::cgal_mesh_files()) {
    if (!is_chosen(file, only)) continue;
    const std::optional<Model> model = load(file);
    if (!model) continue;
    ++models;
    detail.add(*model);
  }
  if (models == 0) throw std::runtime_error("no model above 20,000 faces has a name that --only gives");
  detail.print();
  write_picture(detail.picture());
  return detail.rows();
}

}  // namespace

void add_detail(const std::vector<std::string>& only) {
  add(Report{"detail", [only] { return print_detail(only); }});
}

}  // namespace papilio::bench
