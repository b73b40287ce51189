#include "cfd/scalar_balance.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "cfd/scalar_transport.hpp"
#include "core/checkpoint.hpp"

namespace pellicle::cfd {

Real ScalarBalance::through_boundaries() const {
  Real sum = 0;
  for (const Real amount : into) sum += amount;
  return sum;
}

Real ScalarBalance::defect() const {
  const Real largest = std::max(gross, std::abs(initial));
  return largest > 0 ? std::abs(stock - initial - through_boundaries() - sources) / largest : 0;
}

// Per second. Gas that leaves has the cell's value, and so has gas that comes back in without a given one.
Real ScalarTransport::out_through(const PieceTerms& terms, std::size_t b) const {
  const Real free_flow = carrier_out_[b] + terms.inflow;
  return (terms.conductance + free_flow) * excess_(boundaries_.pieces[b].cell) -
         (terms.inflow + terms.conductance) * terms.given;
}

void ScalarTransport::add_boundaries_to_balance(const GasFields& fields, Real dt) {
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    const Real in = -dt * out_through(piece_terms(fields, b), b);
    if (piece.patch >= 0) balance_.into[static_cast<std::size_t>(piece.patch)] += in;
    balance_.gross += std::abs(in);
  }
}

// The equation is the balance less the value times continuity; what continuity leaves comes or goes with the value.
void ScalarTransport::add_leftover_to_balance(Real dt) {
  const Stencil& s = geometry_.stencil;
  const HostArray<Real>& residue = base_;  // the equation is solved
  for_rows("cfd::scalar_transport::residue", s, [&](const Index r) {
    const Row row = s.row(r);
    const Index first[3] = {row.x_face, row.y_face, row.z_face};
    for (Index i = 0; i < s.n.x; ++i) {
      const Index c = row.cell + i;
      residue(c) = (content_(c) - content_old_(c)) / dt - gain_(c);
      for (int axis = 0; axis < 3; ++axis) {
        const auto& flux = carrier_[static_cast<std::size_t>(axis)];
        residue(c) += flux(first[axis] + i + s.face_step(axis)) - flux(first[axis] + i);
      }
    }
  });
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    residue(boundaries_.pieces[b].cell) += carrier_out_[b];
  }
  balance_.leftover += dt * sum_("cfd::scalar_transport::leftover", s.cells(),
                                 [&](Index c) { return residue(c) * excess_(c); });
}

void ScalarTransport::update_stock() {
  balance_.stock = sum_("cfd::scalar_transport::stock", geometry_.stencil.cells(),
                        [&](Index c) { return content_(c) * excess_(c); });
}

void ScalarTransport::save(core::CheckpointWriter& writer) const {
  const std::string group = "gas/" + name_ + "/";
  writer.write(group + "excess", excess_);
  writer.write(group + "initial", balance_.initial);
  writer.write(group + "into", balance_.into);
  writer.write(group + "sources", balance_.sources);
  writer.write(group + "leftover", balance_.leftover);
  writer.write(group + "gross", balance_.gross);
}

void ScalarTransport::load(core::CheckpointReader& reader, const GasFields& fields,
                           const ScalarTransport* vapour) {
  const std::string group = "gas/" + name_ + "/";
  reader.read_into(group + "excess", excess_);
  balance_.initial = reader.read_double(group + "initial");
  reader.read_into(group + "into", balance_.into);
  balance_.sources = reader.read_double(group + "sources");
  balance_.leftover = reader.read_double(group + "leftover");
  balance_.gross = reader.read_double(group + "gross");
  publish();
  compute_content(fields, vapour);
  update_stock();
}

}  // namespace pellicle::cfd
