// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace anticrack::ddm {
namespace {

using Eigen::MatrixXd;

struct Free {
  void operator()(double* values) const { std::free(values); }
};

/// A factor with supernodes of 1 to `widest` columns and random rows below them.
class RandomFactor {
 public:
  RandomFactor(int size, int widest, unsigned seed) : dense(MatrixXd::Zero(size, size)) {
    std::minstd_rand random(seed);
    std::uniform_real_distribution<double> value(-1, 1);
    _super.push_back(0);
    _row_begin.push_back(0);
    _value_begin.push_back(0);
    while (_super.back() < size) {
      const int first = _super.back();
      const int end =
          std::min(size, first + 1 + static_cast<int>(random() % static_cast<unsigned>(widest)));
      std::vector<int> rows;
      for (int i = first; i < size; ++i) {
        if (i < end || random() % 4 == 0) rows.push_back(i);
      }
      for (int j = first; j < end; ++j) {
        for (const int i : rows) {
          // What lies above the diagonal must not be read as part of L.
          const double entry = i < j ? 1e300 : i == j ? 2 + value(random) : value(random) / 4;
          _values.push_back(entry);
          if (i >= j) dense(i, j) = entry;
        }
      }
      _rows.insert(_rows.end(), rows.begin(), rows.end());
      _super.push_back(end);
      _row_begin.push_back(static_cast<int>(_rows.size()));
      _value_begin.push_back(static_cast<int>(_values.size()));
    }
  }

  Supernodes first_columns(int columns) const {
    return {static_cast<int>(_super.size()) - 1,
            columns,
            _super.data(),
            _row_begin.data(),
            _value_begin.data(),
            _rows.data(),
            _values.data()};
  }

  MatrixXd dense;

 private:
  std::vector<int> _super, _row_begin, _value_begin, _rows;
  std::vector<double> _values;
};

using SubstitutionKernel = decltype(Kernels::forward);

MatrixXd solve(SubstitutionKernel kernel, const Supernodes& factor, const MatrixXd& f, int width) {
  const auto rows = f.rows();
  const std::unique_ptr<double, Free> y(static_cast<double*>(std::aligned_alloc(
      64, sizeof(double) * static_cast<std::size_t>(rows * std::max(width, 8)))));
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> block(
      y.get(), rows, width);
  block.setZero();
  block.leftCols(f.cols()) = f;
  kernel(factor, width, y.get());
  return block.leftCols(f.cols());
}

/// y_I <- L_II^-1 y_I, y_G <- y_G - L_GI y_I.
MatrixXd expected(const MatrixXd& l, int columns, MatrixXd y) {
  const auto rest = l.rows() - columns;
  if (columns > 0) {
    l.topLeftCorner(columns, columns)
        .triangularView<Eigen::Lower>()
        .solveInPlace(y.topRows(columns));
    y.bottomRows(rest) -= l.bottomLeftCorner(rest, columns) * y.topRows(columns);
  }
  return y;
}

/// y_I <- L_II'^-1 (y_I - L_GI' y_G).
MatrixXd expected_backward(const MatrixXd& l, int columns, MatrixXd y) {
  const auto rest = l.rows() - columns;
  if (columns > 0) {
    y.topRows(columns) -= l.bottomLeftCorner(rest, columns).transpose() * y.bottomRows(rest);
    l.topLeftCorner(columns, columns)
        .triangularView<Eigen::Lower>()
        .transpose()
        .solveInPlace(y.topRows(columns));
  }
  return y;
}

struct Substitution {
  const char* name;
  SubstitutionKernel Kernels::*kernel;
  MatrixXd (*expected)(const MatrixXd& l, int columns, MatrixXd y);
};

void PrintTo(const Substitution& substitution, std::ostream* out) { *out << substitution.name; }

class Substitutions : public ::testing::TestWithParam<Substitution> {
 protected:
  static std::vector<SubstitutionKernel> kernels() {
    std::vector<SubstitutionKernel> result;
    for (int rank = 0; const Kernels* kernels = supported_kernels(rank); ++rank)
      result.push_back(kernels->*GetParam().kernel);
    return result;
  }
};

TEST_P(Substitutions, StopAtTheLastColumnWithEveryKernel) {
  for (const SubstitutionKernel kernel : kernels()) {
    for (const int widest : {1, 3, 40}) {
      const int size = 150;
      const RandomFactor factor(size, widest, 7);
      for (const int columns : {0, 1, 77, 149, 150}) {  // also in the middle of a supernode
        for (const int width : {1, 4, 8, 16, 24, 32}) {
          std::srand(1);
          const MatrixXd f = MatrixXd::Random(size, width);
          const MatrixXd wanted = GetParam().expected(factor.dense, columns, f);
          const MatrixXd got = solve(kernel, factor.first_columns(columns), f, width);
          EXPECT_LT((got - wanted).cwiseAbs().maxCoeff(), 1e-12 * wanted.cwiseAbs().maxCoeff())
              << widest << ' ' << columns << ' ' << width;
        }
      }
    }
  }
}

TEST_P(Substitutions, GiveAColumnTheSameBitsInAnyCompany) {
  const RandomFactor factor(300, 30, 3);
  const Supernodes l = factor.first_columns(251);
  MatrixXd f = MatrixXd::Random(300, 32);
  f.col(1) = Eigen::VectorXd::Unit(300, 100);  // alone, it skips what stays 0
  for (const SubstitutionKernel kernel : kernels()) {
    for (const int width : {4, 8, 16, 24, 32}) {
      const MatrixXd together = solve(kernel, l, f.leftCols(width), width);
      for (int j = 0; j < width; ++j) {
        EXPECT_EQ(together.col(j), solve(kernel, l, f.col(j), 1).col(0)) << width << ' ' << j;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, Substitutions,
                         ::testing::Values(Substitution{"forward", &Kernels::forward, expected},
                                           Substitution{"backward", &Kernels::backward,
                                                        expected_backward}),
                         [](const auto& both) { return std::string(both.param.name); });

}  // namespace
}  // namespace anticrack::ddm
