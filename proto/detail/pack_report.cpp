#include <nlohmann/json.hpp>

#include "proto/detail/pack.h"
#include "proto/detail/packed_normals.h"

namespace papilio::proto::detail {
namespace {

using Json = nlohmann::ordered_json;

void add_reach(Json& json, const DetailReach& reach) {
  json["rms"] = reach.rms;
  json["largest"] = reach.largest;
}

Json json_of(const PackedModel& model) {
  Json base{{"vertices", model.base.triangles.positions.size()}, {"faces", model.base.triangles.triangles.size()}};
  base["bytes"] = model.base_bytes;
  if (model.has_texcoords()) base["texcoords"] = true;
  if (model.has_colours()) base["colours"] = true;
  add_reach(base, model.base_reach);
  if (model.normals != NormalStyle::absent) base["normals"] = name_of(model.normals);
  Json levels = Json::array();
  for (const PackedLevel& level : model.levels) {
    Json& json = levels.emplace_back();
    json = {{"new_vertices", level.vertices}, {"faces", level.faces}, {"bytes", level.stream.bytes.size()}};
    json["step"] = level.stream.step;
    if (!level.stream.pieces.empty()) json["pieces"] = level.stream.pieces.size();
    if (level.missing_pieces > 0) json["missing_pieces"] = level.missing_pieces;
    if (level.stream.texcoords.step > 0)
      json["texcoords"] = {{"bytes", level.stream.texcoords.bytes.size()}, {"step", level.stream.texcoords.step}};
    add_reach(json, level.reach);
  }
  return {{"version", detail_version}, {"base", std::move(base)}, {"levels", std::move(levels)}};
}

}  // namespace

std::string describe(const PackedModel& model) { return json_of(model).dump(); }

std::string pack_report(const Packed& packed) {
  Json out{{"format", packed.model ? "packed" : "draco"}};
  if (!packed.reason.empty()) out["reason"] = packed.reason;
  out["bytes"] = packed.glb.size();
  if (packed.wanted_rms > 0) out["wanted_rms"] = packed.wanted_rms;
  out["encodings"] = packed.encodings;
  if (packed.image_bytes > 0) out["image_bytes"] = packed.image_bytes;
  if (packed.model) {
    out["folds"] = packed.folds;
    out["parted"] = packed.parted;
    out.update(json_of(*packed.model));
  }
  out["plain"] = {{"bytes", packed.plain_bytes}, {"position_bits", packed.plain_bits}, {"rms", packed.plain_rms}};
  if (packed.plain_has_normals) out["plain"]["normals"] = true;
  if (packed.simplified) {
    Json& simplified = out["simplified"] = {{"faces", packed.simplified->faces},
                                            {"bytes", packed.simplified->bytes},
                                            {"position_bits", packed.simplified->position_bits}};
    add_reach(simplified, packed.simplified->reach);
  }
  out["ratio"] = static_cast<double>(packed.plain_bytes) / static_cast<double>(packed.glb.size());
  return out.dump(2);
}

}  // namespace papilio::proto::detail
