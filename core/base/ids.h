#pragma once

#include <concepts>
#include <cstdint>

namespace papilio {

/// Number of an element of a mesh. Converts from and to a plain number, but not to the number of another kind of
/// element: a half-edge does not pass as a face. Has no cost at run time.
template <class Kind>
class Id {
 public:
  constexpr Id() = default;
  constexpr Id(uint32_t number) : number_(number) {}  // NOLINT(google-explicit-constructor)
  template <class Other>
  requires(!std::same_as<Other, Kind>) constexpr Id(const Id<Other>&) = delete;
  constexpr operator uint32_t() const { return number_; }  // NOLINT(google-explicit-constructor)
  constexpr Id& operator++() {
    ++number_;
    return *this;
  }

 private:
  uint32_t number_ = 0;
};

struct VertexElement;
struct EdgeElement;
struct FaceElement;
struct HalfEdgeElement;

using VertexId = Id<VertexElement>;
using EdgeId = Id<EdgeElement>;
using FaceId = Id<FaceElement>;

class HalfEdgeId : public Id<HalfEdgeElement> {
 public:
  using Id::Id;

  /// Returns the face on the left of a half-edge.
  [[nodiscard]] constexpr FaceId face() const { return *this / 3; }
  [[nodiscard]] constexpr HalfEdgeId next() const { return *this + 1 - (*this % 3 == 2 ? 3U : 0U); }
  [[nodiscard]] constexpr HalfEdgeId previous() const { return *this - 1 + (*this % 3 == 0 ? 3U : 0U); }
};

}  // namespace papilio
