// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstring>
#include <random>

namespace anticrack::testing {

inline Eigen::MatrixXd random_spd(std::mt19937& random, Eigen::Index n, double ridge) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
  return a * a.transpose() + ridge * Eigen::MatrixXd::Identity(n, n);
}

inline Eigen::VectorXd random_vector(std::mt19937& random, Eigen::Index n) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
}

inline bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

}  // namespace anticrack::testing
