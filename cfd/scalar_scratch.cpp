#include "cfd/scalar_scratch.hpp"

#include <string>

#include "cfd/field_memory.hpp"
#include "cfd/flow_geometry.hpp"

namespace pellicle::cfd {

ScalarScratch::ScalarScratch(const Stencil& stencil)
    : carrier(make_face_field(stencil, "cfd::scalar_scratch::carrier")),
      conductance(make_face_field(stencil, "cfd::scalar_scratch::conductance")),
      correction(make_face_field(stencil, "cfd::scalar_scratch::correction")),
      linear_solver(stencil.cells()) {
  const auto n = static_cast<std::size_t>(stencil.cells());
  for (std::size_t d = 0; d < 6; ++d) {
    near[d] = make_field<Real>("cfd::scalar_scratch::near" + std::to_string(d), n);
  }
  own = make_field<Real>("cfd::scalar_scratch::own", n);
  base = make_field<Real>("cfd::scalar_scratch::base", n);
  rhs = make_field<Real>("cfd::scalar_scratch::rhs", n);
  storage = make_field<Real>("cfd::scalar_scratch::storage", n);
  content_old = make_field<Real>("cfd::scalar_scratch::content_old", n);
  gain = make_field<Real>("cfd::scalar_scratch::gain", n);
}

}  // namespace pellicle::cfd
