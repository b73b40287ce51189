#include "core/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"

namespace pellicle::core {

void Ledger::open(Conserved quantity, const Vec3& stock) {
  Account& a = account(quantity);
  a = Account{};
  a.open = true;
  a.stock0 = a.stock = stock;
}

void Ledger::add_through_boundaries(Conserved quantity, const Vec3& amount) {
  for (int axis = 0; axis < 3; ++axis) {
    account(quantity).through_boundaries[static_cast<std::size_t>(axis)].add(amount[axis]);
  }
}

void Ledger::add_source(Conserved quantity, const Vec3& amount) {
  for (int axis = 0; axis < 3; ++axis)
    account(quantity).sources[static_cast<std::size_t>(axis)].add(amount[axis]);
}

void Ledger::add_gross(Conserved quantity, Real amount) { account(quantity).gross.add(std::abs(amount)); }

void Ledger::set_totals(Conserved quantity, const Vec3& through_boundaries, const Vec3& sources, Real gross) {
  Account& a = account(quantity);
  for (int axis = 0; axis < 3; ++axis) {
    a.through_boundaries[static_cast<std::size_t>(axis)] = ExactSum(through_boundaries[axis]);
    a.sources[static_cast<std::size_t>(axis)] = ExactSum(sources[axis]);
  }
  a.gross = ExactSum(gross);
}

Real Ledger::defect(Conserved quantity) const {
  const Account& a = account(quantity);
  if (!a.open) return 0;
  Vec3 unexplained = a.stock - a.stock0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto component = static_cast<std::size_t>(axis);
    // Collected without loss: stock, inflow and outflow may be many times the defect.
    ExactSum rest(a.stock[axis]);
    rest.add(-a.stock0[axis]);
    for (const Real part : a.through_boundaries[component].parts()) rest.add(-part);
    for (const Real part : a.sources[component].parts()) rest.add(-part);
    unexplained[axis] = rest.value();
  }
  const Real scale = std::max(a.gross.value(), norm(a.stock0));
  const Real size = norm(unexplained);
  if (size == 0) return 0;
  return scale > 0 ? size / scale : std::numeric_limits<Real>::infinity();
}

void Ledger::save(CheckpointWriter& checkpoint) const {
  for (std::size_t q = 0; q < accounts_.size(); ++q) {
    const Account& a = accounts_[q];
    if (!a.open) continue;
    std::vector<double> numbers{a.stock0.x, a.stock0.y, a.stock0.z};
    const auto append = [&](const ExactSum& sum) {
      for (const Real part : sum.parts()) numbers.push_back(part);
    };
    for (const auto& sum : a.through_boundaries) append(sum);
    for (const auto& sum : a.sources) append(sum);
    append(a.gross);
    checkpoint.write("ledger/" + std::string(conserved_names[q]), numbers);
  }
}

void Ledger::load(const CheckpointReader& checkpoint) {
  for (std::size_t q = 0; q < accounts_.size(); ++q) {
    const std::string name = "ledger/" + std::string(conserved_names[q]);
    Account& a = accounts_[q];
    a = Account{};
    if (!checkpoint.has(name)) continue;
    std::array<double, 17> numbers{};
    checkpoint.read_into(name, numbers);
    a.open = true;
    a.stock0 = a.stock = {numbers[0], numbers[1], numbers[2]};
    std::size_t next = 3;
    const auto take = [&](ExactSum& sum) {
      sum.set_parts(numbers[next], numbers[next + 1]);
      next += 2;
    };
    for (auto& sum : a.through_boundaries) take(sum);
    for (auto& sum : a.sources) take(sum);
    take(a.gross);
  }
}

}  // namespace pellicle::core
