#include "proto/gltf/joint_weights.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace papilio::proto::gltf {
namespace {

constexpr uint32_t influences = 4;  // places of one pair
constexpr const char* joints_prefix = "JOINTS_";
constexpr const char* weights_prefix = "WEIGHTS_";

using Weight = std::pair<double, uint32_t>;  // weight and joint

/// Returns the names of both attributes of the pair that `semantic` may belong to; empty ones for other attributes.
std::pair<std::string, std::string> pair_names(const std::string& semantic) {
  for (const char* prefix : {joints_prefix, weights_prefix})
    if (semantic.starts_with(prefix)) {
      const std::string number = semantic.substr(std::strlen(prefix));
      return {joints_prefix + number, weights_prefix + number};
    }
  return {};
}

bool has_four(const VertexStream* stream) {
  return stream != nullptr && stream->elements.format.components == influences;
}

struct Pair {
  const VertexStream *joints, *weights;
};

std::vector<Pair> pairs_of(const VertexSet& set) {
  std::vector<Pair> pairs;
  for (const VertexStream& stream : set.attributes)
    if (stream.semantic.starts_with(joints_prefix) && is_joint_stream(set, stream.semantic))
      pairs.push_back({&stream, set.find(pair_names(stream.semantic).second)});
  return pairs;
}

/// Adds weights by joint, and returns the `most` largest.
std::vector<Weight> blend(const std::vector<Pair>& pairs, const Combination& of, size_t most) {
  std::vector<Weight> blended;
  for (size_t i = 0; i < 3; ++i) {
    if (of.weight[i] == 0) continue;
    for (const Pair& pair : pairs)
      for (uint32_t k = 0; k < influences; ++k) {
        const double weight = of.weight[i] * pair.weights->elements.number(of.vertex[i], k);
        if (!(weight > 0)) continue;
        const auto joint = static_cast<uint32_t>(pair.joints->elements.number(of.vertex[i], k));
        const auto known = std::ranges::find(blended, joint, &Weight::second);
        if (known == blended.end())
          blended.emplace_back(weight, joint);
        else
          known->first += weight;
      }
  }
  std::ranges::sort(blended, [](const Weight& a, const Weight& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  if (blended.size() > most) blended.resize(most);
  return blended;
}

/// Divides weights by their sum, in units of the type's 1. Rounds integers so that their sum is exact.
void normalize(std::vector<Weight>& weights, const ElementFormat& format) {
  double sum = 0;
  for (const auto& [weight, joint] : weights) sum += weight;
  if (sum <= 0) return;
  const double whole = format.normalized ? highest_number(format.type) : 1;
  for (auto& [weight, joint] : weights) weight *= whole / sum;
  if (!format.normalized) return;
  double left = whole;
  for (auto& [weight, joint] : weights) left -= weight = std::floor(weight + 0.5);
  if (!weights.empty()) weights[0].first += left;  // largest weight
}

}  // namespace

bool is_joint_stream(const VertexSet& set, const std::string& semantic) {
  const auto [joints, weights] = pair_names(semantic);
  return !joints.empty() && has_four(set.find(joints)) && has_four(set.find(weights));
}

std::vector<VertexStream> interpolate_joints(const VertexSet& input, const RefinedVertices& vertices) {
  const std::vector<Pair> pairs = pairs_of(input);
  std::vector<VertexStream> out;
  for (const Pair& pair : pairs)
    for (const VertexStream* stream : {pair.joints, pair.weights})
      out.push_back({stream->semantic, stream->accessor, zero_elements(stream->elements.format, vertices.size())});
  for (size_t i = 0; i < vertices.size() && !pairs.empty(); ++i) {
    const Combination& of = vertices[i].of;
    std::vector<Weight> weights;
    if (!of.is_original()) {
      weights = blend(pairs, of, influences * pairs.size());
      normalize(weights, pairs[0].weights->elements.format);
    }
    for (size_t p = 0; p < pairs.size(); ++p)
      for (uint32_t k = 0; k < influences; ++k) {
        Elements& joints = out[2 * p].elements;
        Elements& values = out[2 * p + 1].elements;
        const size_t place = p * influences + k;
        if (of.is_original()) {
          joints.set_number(i, k, pairs[p].joints->elements.number(of.vertex[0], k));
          values.set_number(i, k, pairs[p].weights->elements.number(of.vertex[0], k));
        } else if (place < weights.size()) {
          joints.set_number(i, k, weights[place].second);
          values.set_number(i, k, weights[place].first);
        }
      }
  }
  return out;
}

}  // namespace papilio::proto::gltf
