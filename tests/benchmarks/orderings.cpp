// SPDX-License-Identifier: GPL-3.0-or-later
//
// Orders of elimination of the subdomains' interiors: ours, approximate minimum degree, METIS. What
// each costs, and the fill and work it leaves in the whole factor, the interface last, as CHOLMOD
// counts them.
#include <cholmod.h>

#include <CLI/CLI.hpp>
#include <Eigen/SparseCore>
#include <cstdio>
#include <exception>
#include <numeric>
#include <stdexcept>

#include "benchmarks/figures.hpp"
#include "benchmarks/our_mesh.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/elimination_order.hpp"
#include "fem/stiffness.hpp"

namespace anticrack::benchmarks {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

struct Part {
  Sparse whole;     // lower triangle of K
  Sparse interior;  // that of K_II
  std::vector<double> xy;
};

/// CHOLMOD's view; it only reads.
cholmod_sparse view(const Sparse& matrix) {
  cholmod_sparse result{};
  result.nrow = static_cast<std::size_t>(matrix.rows());
  result.ncol = static_cast<std::size_t>(matrix.cols());
  result.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  result.p = const_cast<int*>(matrix.outerIndexPtr());
  result.i = const_cast<int*>(matrix.innerIndexPtr());
  result.stype = -1;
  result.itype = CHOLMOD_INT;
  result.xtype = CHOLMOD_PATTERN;
  result.sorted = 1;
  result.packed = 1;
  return result;
}

/// Sums over the subdomains.
struct Ordering {
  Times ordering;
  double entries = 0, operations = 0;

  Figures figures() const {
    Figures result;
    result.set("ordering", ordering);
    result.set("entries", entries);
    result.set("operations", operations);
    return result;
  }
};

class Cholmod {
 public:
  Cholmod() {
    cholmod_start(&_common);
    _common.nmethods = 1;
    _common.print = 0;
  }
  ~Cholmod() { cholmod_finish(&_common); }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  std::vector<int> minimum_degree(const Sparse& lower) {
    return order(lower, [this](cholmod_sparse& matrix, int* permutation) {
      return cholmod_amd(&matrix, nullptr, 0, permutation, &_common);
    });
  }
  std::vector<int> metis(const Sparse& lower) {
    return order(lower, [this](cholmod_sparse& matrix, int* permutation) {
      return cholmod_metis(&matrix, nullptr, 0, 1, permutation, &_common);
    });
  }

  void count(const Sparse& whole, std::vector<int> permutation, Ordering& sums) {
    const auto interior = static_cast<std::ptrdiff_t>(permutation.size());
    permutation.resize(static_cast<std::size_t>(whole.rows()));
    std::iota(permutation.begin() + interior, permutation.end(), static_cast<int>(interior));
    cholmod_sparse matrix = view(whole);
    _common.method[0].ordering = CHOLMOD_GIVEN;
    cholmod_factor* factor = cholmod_analyze_p(&matrix, permutation.data(), nullptr, 0, &_common);
    if (factor == nullptr) throw std::runtime_error("CHOLMOD did not analyse");
    cholmod_free_factor(&factor, &_common);
    sums.entries += _common.lnz;
    sums.operations += _common.fl;
  }

 private:
  template <class Order>
  std::vector<int> order(const Sparse& lower, const Order& ordered) {
    cholmod_sparse matrix = view(lower);
    std::vector<int> permutation(static_cast<std::size_t>(lower.rows()));
    if (ordered(matrix, permutation.data()) == 0) throw std::runtime_error("CHOLMOD did not order");
    return permutation;
  }

  cholmod_common _common{};
};

template <class Order>
Figures measure(const std::vector<Part>& parts, int repetitions, Cholmod& cholmod,
                const Order& order) {
  Ordering sums;
  std::vector<std::vector<int>> orders(parts.size());
  for (int i = 0; i < repetitions; ++i) {
    const Stopwatch watch;
    for (std::size_t s = 0; s < parts.size(); ++s) orders[s] = order(parts[s]);
    watch.stop(sums.ordering);
  }
  for (std::size_t s = 0; s < parts.size(); ++s) {
    cholmod.count(parts[s].whole, std::move(orders[s]), sums);
  }
  return sums.figures();
}

void run(const std::string& path, int repetitions) {
  std::vector<Part> parts;
  for (const ddm::Subdomain& part : ddm::cut(*to_mesh(read_plain_mesh(path))).subdomains) {
    const auto interior = static_cast<Eigen::Index>(part.interior);
    const fem::Stiffness stiffness =
        fem::stiffness(part.part, part.tension, static_cast<Eigen::Index>(part.free()));
    Part result{stiffness.free, stiffness.free.topLeftCorner(interior, interior), part.part.xy};
    result.interior.makeCompressed();
    parts.push_back(std::move(result));
  }
  Cholmod cholmod;
  Figures figures;
  figures.set("nested_dissection", measure(parts, repetitions, cholmod, [](const Part& part) {
                return ddm::elimination_order(part.interior, part.interior.rows(), part.xy);
              }));
  figures.set("minimum_degree", measure(parts, repetitions, cholmod, [&](const Part& part) {
                return cholmod.minimum_degree(part.interior);
              }));
  figures.set("metis", measure(parts, repetitions, cholmod,
                               [&](const Part& part) { return cholmod.metis(part.interior); }));
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  std::string mesh;
  int repetitions = 5;
  CLI::App app("Orders of elimination, compared.", "bench_orderings");
  app.add_option("--mesh", mesh, "Written by bench_meshes")->required();
  app.add_option("--repetitions", repetitions, "Of each")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(mesh, repetitions);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_orderings: %s\n", error.what());
    return 1;
  }
  return 0;
}
