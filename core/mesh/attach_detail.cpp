#include <utility>

#include "mesh/connect.h"
#include "papilio/detail.h"
#include "papilio/error.h"

namespace papilio {

void Mesh::attach_detail(std::shared_ptr<const Detail> given) {
  if (given && !given->fits(*this))
    throw Error(Fault::bad_surface, "The detail belongs to another mesh. Attach it to the base that it was made for.");
  if (given) {
    number_edges(topology);
    topology.kind = given->base().kind;
    topology.darts = given->base().darts;
    topology.shape = given->base().shape;
  }
  detail = std::move(given);
}

}  // namespace papilio
