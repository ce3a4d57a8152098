// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/trace_problem.hpp"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <limits>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "fem/interface_mass.hpp"
#include "stop/stop.hpp"

namespace anticrack::contact {
namespace {

/// x -> R' (sum_i B_i F_i B_i') R x, in the form Spectra requires.
class Product {
 public:
  using Scalar = double;

  Product(const ddm::Decomposition& decomposition,
          const std::vector<ddm::SubdomainOperator>& operators,
          const Eigen::SparseMatrix<double>& mass_root)
      : _decomposition(decomposition), _operators(operators), _root(mass_root) {}

  Eigen::Index rows() const { return _root.rows(); }
  Eigen::Index cols() const { return _root.cols(); }

  void perform_op(const double* x_in, double* y_out) const {
    stop::look("computing theta*");
    const Eigen::VectorXd force = _root * Eigen::Map<const Eigen::VectorXd>(x_in, rows());
    std::vector<Eigen::VectorXd> traces;
    for (std::size_t s = 0; s < _operators.size(); ++s)
      traces.push_back(answer(static_cast<std::int32_t>(s), force));
    Eigen::VectorXd jump(rows());
    for (Eigen::Index i = 0; i < rows(); ++i) {
      const ddm::NodePair& pair = _decomposition.pairs[at(i)];
      jump[i] = traces[at(pair.plus)][pair.plus_trace] - traces[at(pair.minus)][pair.minus_trace];
    }
    Eigen::Map<Eigen::VectorXd>(y_out, rows()) = _root.transpose() * jump;
  }

 private:
  Eigen::VectorXd answer(std::int32_t subdomain, const Eigen::VectorXd& force) const {
    const ddm::Flexibility& flexibility = *_operators[at(subdomain)].flexibility();
    Eigen::VectorXd load = Eigen::VectorXd::Zero(flexibility.trace_size());
    for (Eigen::Index i = 0; i < rows(); ++i) {
      const ddm::NodePair& pair = _decomposition.pairs[at(i)];
      if (pair.plus == subdomain) load[pair.plus_trace] += force[i];
      if (pair.minus == subdomain) load[pair.minus_trace] -= force[i];
    }
    Eigen::VectorXd reduced(flexibility.skeleton_size()), skeleton(flexibility.skeleton_size());
    Eigen::VectorXd trace(flexibility.trace_size());
    flexibility.apply(load, reduced, skeleton, trace);
    return trace;
  }

  const ddm::Decomposition& _decomposition;
  const std::vector<ddm::SubdomainOperator>& _operators;
  const Eigen::SparseMatrix<double>& _root;
};

double largest_eigenvalue_dense(const Product& product) {
  Eigen::MatrixXd matrix(product.rows(), product.cols());
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(product.cols());
  for (Eigen::Index i = 0; i < product.cols(); ++i) {
    unit[i] = 1;
    product.perform_op(unit.data(), matrix.col(i).data());
    unit[i] = 0;
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

double largest_eigenvalue(Product product) {
  constexpr Eigen::Index dense_limit = 64;
  if (product.rows() <= dense_limit) return largest_eigenvalue_dense(product);
  constexpr Eigen::Index basis = 24, restarts = 1000;
  constexpr double tolerance = 1e-12;
  Spectra::SymEigsSolver<Product> solver(product, 1, basis);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, restarts, tolerance);
  if (solver.info() != Spectra::CompInfo::Successful) {
    throw errors::Error(errors::Reason::numerical,
                        "theta* could not be computed: Lanczos did not converge in {} restarts; "
                        "the mesh has triangles that are degenerate",
                        restarts);
  }
  return solver.eigenvalues()[0];
}

/// 2 / lambda_max(R' (sum_i B_i F_i B_i') R) with R R' = M the interface mass, B_i the signed
/// incidence of pairs and traces: the bound of Theorem 4 on theta. Lanczos to 1e-12 relative, by a
/// dense solver up to 64 pairs. Infinite without pairs. Every subdomain must have a flexibility.
/// Throws errors::Error (numerical) when Lanczos does not converge. O(n_G^2) a Lanczos step.
double theta_star(const ddm::Decomposition& decomposition,
                  const std::vector<ddm::SubdomainOperator>& operators,
                  const Eigen::SparseMatrix<double>& mass_root) {
  if (mass_root.rows() == 0) return std::numeric_limits<double>::infinity();
  return 2 / largest_eigenvalue(Product(decomposition, operators, mass_root));
}

/// R with M = R R'; F M and R'F R have the same eigenvalues.
Eigen::SparseMatrix<double> root(const Eigen::SparseMatrix<double>& mass) {
  if (mass.rows() == 0) return {};
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>
      cholesky(mass);
  return cholesky.matrixL();
}

Eigen::SparseMatrix<double> root(const Eigen::VectorXd& mass) {
  if (mass.size() == 0)
    return {};  // Eigen 3.4 writes through a null pointer for a diagonal of size 0
  return Eigen::SparseMatrix<double>(mass.cwiseSqrt().asDiagonal());
}

/// Per unknown: the inclusion whose motion it follows or depends on through conditions, or -1.
std::vector<std::int32_t> inclusions_of(const ddm::Skeleton& skeleton) {
  std::vector<std::int32_t> of_free(skeleton.free, -1), result(skeleton.unknowns, -1);
  for (std::size_t i = 0; i < skeleton.unknowns; ++i)
    if (skeleton.inclusion[i] >= 0)
      for (const ddm::Term& term : skeleton.rows[i].free)
        of_free[at(term.index)] = skeleton.inclusion[i];
  for (std::size_t i = 0; i < skeleton.unknowns; ++i) {
    result[i] = skeleton.inclusion[i];
    for (const ddm::Term& term : skeleton.rows[i].free)
      if (result[i] < 0) result[i] = of_free[at(term.index)];
    for (const ddm::Term& term : skeleton.rows[i].held)
      if (result[i] < 0) result[i] = skeleton.held[at(term.index)].inclusion;
  }
  return result;
}

std::vector<std::vector<std::int32_t>> find_carriers(const ddm::Decomposition& decomposition) {
  const std::vector<std::int32_t> inclusion = inclusions_of(decomposition.skeleton);
  std::vector<std::vector<std::int32_t>> result;
  for (const ddm::Subdomain& subdomain : decomposition.subdomains) {
    std::vector<std::int32_t>& of_trace = result.emplace_back(subdomain.rigid);
    for (std::size_t i = 0; i < of_trace.size(); ++i)
      if (of_trace[i] < 0) of_trace[i] = inclusion[at(subdomain.unknown[i])];
  }
  // If the body has several inclusions, the flux acts on the one at the other side of the pair.
  for (const ddm::NodePair& pair : decomposition.pairs) {
    std::int32_t& minus = result[at(pair.minus)][at(pair.minus_trace)];
    if (pair.inclusion >= 0 && minus >= 0 &&
        decomposition.subdomains[at(pair.minus)].rigid[at(pair.minus_trace)] < 0)
      minus = pair.inclusion;
  }
  return result;
}

template <class OfTrace>
Eigen::VectorXd gather_traces(const ddm::Decomposition& decomposition, std::size_t subdomains,
                              const OfTrace& of_trace) {
  Eigen::VectorXd sum =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(decomposition.skeleton.unknowns));
  for (std::size_t s = 0; s < subdomains; ++s) {
    const std::vector<std::int32_t>& unknown = decomposition.subdomains[s].unknown;
    const Eigen::VectorXd& force = of_trace(s);
    for (Eigen::Index i = 0; i < force.size(); ++i) sum[unknown[at(i)]] += force[i];
  }
  return sum;
}

}  // namespace

TraceProblem::TraceProblem(const ddm::Decomposition& decomposition,
                           const std::vector<ddm::SubdomainOperator>& operators, bool uzawa)
    : _decomposition(decomposition),
      _operators(operators),
      _maps(decomposition.skeleton),
      _lumped(fem::lumped_mass(decomposition.edges, decomposition.pairs.size())),
      _consistent(fem::consistent_mass(decomposition.edges, decomposition.pairs.size())),
      _pair_forces(decomposition, _lumped),
      _contact_length(decomposition, _lumped),
      _carriers(find_carriers(decomposition)),
      _uzawa(uzawa) {}

Eigen::VectorXd TraceProblem::gather(std::span<const Eigen::VectorXd> on_traces) const {
  return gather_traces(_decomposition, on_traces.size(),
                       [&](std::size_t s) -> const Eigen::VectorXd& { return on_traces[s]; });
}

Eigen::VectorXd TraceProblem::gather(std::span<const ddm::CondensedLoad> loads) const {
  return gather_traces(_decomposition, loads.size(),
                       [&](std::size_t s) -> const Eigen::VectorXd& { return loads[s].g; });
}

std::vector<Eigen::VectorXd> TraceProblem::scatter(const Eigen::VectorXd& w) const {
  std::vector<Eigen::VectorXd> traces;
  traces.reserve(_decomposition.subdomains.size());
  for (const ddm::Subdomain& subdomain : _decomposition.subdomains) {
    Eigen::VectorXd& trace = traces.emplace_back(static_cast<Eigen::Index>(subdomain.trace));
    for (Eigen::Index i = 0; i < trace.size(); ++i) trace[i] = w[subdomain.unknown[at(i)]];
  }
  return traces;
}

std::vector<std::vector<std::int32_t>> TraceProblem::chains() const {
  std::vector<char> seen(_decomposition.skeleton.independent, 0);
  std::vector<std::vector<std::int32_t>> result(1);
  const auto cut = [&result] {
    if (!result.back().empty()) result.emplace_back();
  };
  for (const std::vector<ddm::SidePair>& sides : _decomposition.interface_sides) {
    cut();
    for (const ddm::SidePair& side : sides) {
      const std::int32_t contact = side.pair < 0 ? -1 : _decomposition.pairs[at(side.pair)].contact;
      if (contact < 0) cut();
      if (contact < 0 || at(contact) >= seen.size() || seen[at(contact)] != 0) continue;
      seen[at(contact)] = 1;
      result.back().push_back(contact);
    }
  }
  if (result.back().empty()) result.pop_back();
  for (std::size_t c = 0; c < seen.size(); ++c)
    if (seen[c] == 0) result.push_back({static_cast<std::int32_t>(c)});
  return result;
}

double TraceProblem::theta_star(Mass mass) const {
  if (!_uzawa) return 0;
  return lazy_theta_star(mass).get([this, mass] {
    return contact::theta_star(_decomposition, _operators,
                               mass == Mass::lumped ? root(_lumped) : root(_consistent));
  });
}

void TraceProblem::apply_mass(Mass mass, const Eigen::Ref<const Eigen::MatrixXd>& mu,
                              Eigen::Ref<Eigen::MatrixXd> force) const {
  if (mass == Mass::lumped)
    force.noalias() = _lumped.asDiagonal() * mu;
  else
    force.noalias() = _consistent * mu;
}

}  // namespace anticrack::contact
