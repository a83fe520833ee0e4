#include "tests/soak/queries.h"

#include <array>
#include <string_view>

#include "proto/text.h"

namespace papilio::soak {

std::string random_query(std::mt19937& random, int most_levels) {
  constexpr std::array<std::string_view, 10> pieces{
      "scheme=in-place", "tolerance=0.002", "flatness=0.9,0.95",   "growth=2",       "tension=sharp",
      "w=0.01",          "crease_angle=60", "output.normals=true", "output.speed=3", "output.position_bits=11"};
  std::string query = "levels=" + std::to_string(random() % static_cast<unsigned>(most_levels + 1));
  for (const std::string_view piece : pieces)
    if (random() % 4 == 0) query.append("&").append(piece);
  if (random() % 2 == 0) {
    std::uniform_real_distribution<double> place(-3, 3);
    query += "&view.error_pixels=1&view.edge_pixels=0&view.eye=";
    query += proto::format_number(place(random)) + "," + proto::format_number(place(random)) + ",4";
  }
  return query;
}

proto::QueryFields fields_of(const std::string& query) {
  proto::QueryFields fields;
  for (size_t begin = 0; begin < query.size();) {
    const size_t end = std::min(query.find('&', begin), query.size());
    const size_t equals = query.find('=', begin);
    fields.emplace_back(query.substr(begin, equals - begin), query.substr(equals + 1, end - equals - 1));
    begin = end + 1;
  }
  return fields;
}

}  // namespace papilio::soak
