// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/lazy.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/flexibility.hpp"
#include "ddm/subdomain_factor.hpp"
#include "fem/stiffness.hpp"

namespace anticrack::ddm {

/// A load of one subdomain, condensed to its trace t. With S the Schur complement, exactly:
///   Pi_i(t)  = t'S t/2 - g't + energy_constant         (the paper's Pi_i, g_D included)
///   |u|_V^2  = t'S t - 2 g_boundary't + norm_constant  (int T |grad u|^2 over the subdomain)
/// T is the tension of the subdomain, a factor of its stiffness.
struct CondensedLoad {
  Eigen::VectorXd z_interior;  ///< L_II^-1 f_I, for `recover`
  Eigen::VectorXd g;           ///< f_G - K_GI K_II^-1 f_I, f_I and f_G including -K_.D g_D
  Eigen::VectorXd g_boundary;  ///< the part of g that comes from g_D
  Eigen::VectorXd dirichlet;   ///< g_D in the Dirichlet nodes
  // Needed by products(), for the constants of combinations:
  Eigen::VectorXd z_boundary;       ///< the part of z_interior from g_D; empty where g_D = 0
  Eigen::VectorXd dirichlet_force;  ///< K_DD g_D
  Eigen::VectorXd on_dirichlet;     ///< int f phi_i of the Dirichlet nodes
  double energy_constant = 0;
  double norm_constant = 0;
};

/// One factorised subdomain. Thread-safe.
class SubdomainOperator {
 public:
  /// Assembles and factorises. Throws errors::Error as SubdomainFactor does.
  explicit SubdomainOperator(const Subdomain& subdomain, int threads = 1);

  /// Condenses one load per column. `loads`: int f phi_i for all nodes of the subdomain;
  /// `dirichlet`: g_D in its Dirichlet nodes. One forward solve each, two if g_D is not zero.
  std::vector<CondensedLoad> condense(const Eigen::Ref<const Eigen::MatrixXd>& loads,
                                      const Eigen::Ref<const Eigen::MatrixXd>& dirichlet) const;

  struct Solved {
    const CondensedLoad& load;
    Eigen::Ref<const Eigen::VectorXd> trace;
    Eigen::Ref<Eigen::VectorXd> u;  ///< on all nodes of the subdomain, overwritten
  };
  /// Computes u of each case by a backward solve, in blocks; the bits do not depend on other cases.
  void recover(std::span<Solved> cases) const;

  const SubdomainFactor& factor() const noexcept { return _factor; }
  /// Null if a part of the subdomain floats, since forces do not determine its position. Computed
  /// at the first call, O(n_G^3). Throws errors::Error as Flexibility does.
  const Flexibility* flexibility() const;
  /// The memory held now, in bytes.
  std::size_t bytes() const noexcept;

 private:
  SubdomainOperator(const Subdomain& subdomain, const fem::Stiffness& stiffness, int threads);

  SubdomainFactor _factor;
  Eigen::SparseMatrix<double> _free_dirichlet;       // [K_ID; K_GD]
  Eigen::SparseMatrix<double> _dirichlet_dirichlet;  // K_DD
  bool _floats = false;
  std::vector<std::int32_t> _rigid;
  std::unique_ptr<const base::Lazy<Flexibility>> _flexibility;
};

/// The constants of a combination sum_j c_j f_j of loads of one subdomain, quadratic forms in c:
/// energy_constant = c' energy c, norm_constant = c' norm c. Shape (loads, loads), symmetric.
struct LoadProducts {
  Eigen::MatrixXd energy;
  Eigen::MatrixXd norm;
};

/// The products of m loads. `condensed`: the interiors are eliminated and their energy is that of
/// z_interior; otherwise the constants are those of the Dirichlet nodes alone. O(n m^2) with n
/// nodes of the subdomain.
LoadProducts products(std::span<const CondensedLoad* const> loads, bool condensed = true);

/// The load sum_j c_j f_j, with z_interior if the loads have it. O((trace + Dirichlet) m).
CondensedLoad combine(std::span<const CondensedLoad* const> loads, const LoadProducts& products,
                      const Eigen::Ref<const Eigen::VectorXd>& coefficients);

}  // namespace anticrack::ddm
