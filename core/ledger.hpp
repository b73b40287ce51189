// Balances of what must be conserved, kept over the whole run.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::core {

class CheckpointReader;
class CheckpointWriter;

/// A sum that does not lose small terms: Neumaier (1974), Z. angew. Math. Mech. 54, 39.
class ExactSum {
 public:
  ExactSum() = default;
  explicit ExactSum(Real value) : sum_(value) {}
  void add(Real value) {
    const Real next = sum_ + value;
    const Real larger = std::abs(sum_) >= std::abs(value) ? sum_ : value;
    const Real smaller = std::abs(sum_) >= std::abs(value) ? value : sum_;
    rest_ += (larger - next) + smaller;
    sum_ = next;
  }
  Real value() const { return sum_ + rest_; }
  std::array<Real, 2> parts() const { return {sum_, rest_}; }
  void set_parts(Real sum, Real rest) { sum_ = sum, rest_ = rest; }

 private:
  Real sum_ = 0, rest_ = 0;
};

/// What is conserved; the names in summary.json.
enum class Conserved { gas_mass, momentum, energy, water, solids, particle_mass };
inline constexpr int conserved_count = 6;
inline constexpr std::array<std::string_view, conserved_count> conserved_names{
    "gas_mass", "momentum", "energy", "water", "solids", "particle_mass"};

/// For every conserved quantity: defect = |stock - stock0 - through boundaries - sources| / max(gross exchanged,
/// |stock0|). Scalars use the x component; momentum all three, with the vector's length. Units are the quantity's
/// (kg, N s, J). A quantity that was never opened has no defect.
class Ledger {
 public:
  /// Starts the account of a quantity with what is there at the beginning.
  void open(Conserved quantity, const Vec3& stock);
  void open(Conserved quantity, Real stock) { open(quantity, Vec3{stock, 0, 0}); }
  bool is_open(Conserved quantity) const { return account(quantity).open; }

  /// What came in through the boundaries since the last call: positive into the domain.
  void add_through_boundaries(Conserved quantity, const Vec3& amount);
  void add_through_boundaries(Conserved quantity, Real amount) {
    add_through_boundaries(quantity, Vec3{amount, 0, 0});
  }
  /// What was made (positive) or taken away inside.
  void add_source(Conserved quantity, const Vec3& amount);
  void add_source(Conserved quantity, Real amount) { add_source(quantity, Vec3{amount, 0, 0}); }
  /// The size of what was exchanged, without sign: the scale of the defect.
  void add_gross(Conserved quantity, Real amount);
  /// Running integrals kept by others, in place of what was added before.
  void set_totals(Conserved quantity, const Vec3& through_boundaries, const Vec3& sources, Real gross);

  /// What is there now, from the stored fields.
  void set_stock(Conserved quantity, const Vec3& stock) { account(quantity).stock = stock; }
  void set_stock(Conserved quantity, Real stock) { set_stock(quantity, Vec3{stock, 0, 0}); }

  /// 0 for a quantity that was not opened.
  Real defect(Conserved quantity) const;

  void save(CheckpointWriter& checkpoint) const;
  void load(const CheckpointReader& checkpoint);

 private:
  struct Account {
    bool open = false;
    Vec3 stock0, stock;
    std::array<ExactSum, 3> through_boundaries, sources;
    ExactSum gross;
  };
  Account& account(Conserved quantity) { return accounts_[static_cast<std::size_t>(quantity)]; }
  const Account& account(Conserved quantity) const { return accounts_[static_cast<std::size_t>(quantity)]; }

  std::array<Account, conserved_count> accounts_;
};

}  // namespace pellicle::core
