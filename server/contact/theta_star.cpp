// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/theta_star.hpp"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "errors/errors.hpp"
#include "mesh/at.hpp"

namespace anticrack::contact {
namespace {

/// x -> R' (sum_i B_i F_i B_i') R x, in the form Spectra asks for.
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
                        "theta* could not be computed: Lanczos did not converge in " +
                            std::to_string(restarts) +
                            " restarts; the mesh has triangles that are degenerate");
  }
  return solver.eigenvalues()[0];
}

}  // namespace

double theta_star(const ddm::Decomposition& decomposition,
                  const std::vector<ddm::SubdomainOperator>& operators,
                  const Eigen::SparseMatrix<double>& mass_root) {
  if (mass_root.rows() == 0) return std::numeric_limits<double>::infinity();
  return 2 / largest_eigenvalue(Product(decomposition, operators, mass_root));
}

}  // namespace anticrack::contact
