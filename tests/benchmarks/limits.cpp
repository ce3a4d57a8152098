// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the machine can do at best, and how near the solves with the factors come to it: memory
// bandwidth, the rate of dgemm, forward and backward solves alone and in blocks.
#include <cblas.h>
#include <CLI/CLI.hpp>
#include <Eigen/Core>

#include <cstdio>
#include <exception>
#include <functional>
#include <thread>

#include "benchmarks/figures.hpp"
#include "benchmarks/our_mesh.hpp"
#include "ddm/blas.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"
#include "operators/freed_memory.hpp"

namespace anticrack::benchmarks {
namespace {

struct Options {
  std::string mesh;
  int repetitions = 5;
  int threads = 2;
  int columns = 32;
  std::size_t megabytes = 256;  ///< of each array of the triad: far more than caches hold
  int matrix = 1536;            ///< size of dgemm's
};

double sum_of(const double* a, std::size_t n) {
  constexpr std::size_t lanes = 8;  // enough sums at once to wait for memory only
  double sums[lanes] = {};
  for (std::size_t i = 0; i + lanes <= n; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) sums[k] += a[i + k];
  }
  double sum = 0;
  for (const double s : sums) sum += s;
  return sum;
}

void triad(double* a, const double* b, const double* c, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + 3.0 * c[i];
}

/// `part(first, count)` on each thread's share of n entries, at once.
void in_parallel(int threads, std::size_t n,
                 const std::function<void(std::size_t, std::size_t)>& part) {
  const std::size_t share = n / static_cast<std::size_t>(threads);
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) {
    others.emplace_back(part, static_cast<std::size_t>(t) * share, share);
  }
  part(0, share);
  for (std::thread& thread : others) thread.join();
}

/// Seconds a byte, of reading and of STREAM's triad (24 bytes an entry, as STREAM counts them).
Figures bandwidth(const Options& options, int threads) {
  const std::size_t n = options.megabytes * (std::size_t{1} << 20) / sizeof(double);
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0), sums(n);
  Times reading, writing;
  for (int i = 0; i < options.repetitions; ++i) {
    {
      const Stopwatch watch;
      in_parallel(threads, n, [&](std::size_t first, std::size_t count) {
        sums[first] = sum_of(b.data() + first, count);
      });
      watch.stop(reading, 8.0 * static_cast<double>(n));
    }
    const Stopwatch watch;
    in_parallel(threads, n, [&](std::size_t first, std::size_t count) {
      triad(a.data() + first, b.data() + first, c.data() + first, count);
    });
    watch.stop(writing, 24.0 * static_cast<double>(n));
  }
  if (sums[0] == 0 || a[0] != 7) throw std::runtime_error("the arrays were not read");
  Figures figures;
  figures.set("threads", threads);
  figures.set("read_per_byte", reading);
  figures.set("triad_per_byte", writing);
  return figures;
}

/// Seconds a floating point operation, of n x n matrices; of one with few columns, too.
Figures dgemm(const Options& options, int threads) {
  const int n = options.matrix;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n), b = Eigen::MatrixXd::Random(n, n);
  Eigen::MatrixXd c(n, n);
  openblas_set_num_threads(threads);
  Times square, narrow;
  const auto multiply = [&](int columns, Times& times) {
    const Stopwatch watch;
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, columns, n, 1.0, a.data(), n,
                b.data(), n, 0.0, c.data(), n);
    watch.stop(times, 2.0 * n * n * columns);
  };
  for (int i = 0; i < options.repetitions; ++i) {
    multiply(n, square);
    multiply(options.columns, narrow);
  }
  openblas_set_num_threads(1);
  Figures figures;
  figures.set("threads", threads);
  figures.set("size", n);
  figures.set("columns", options.columns);
  figures.set("per_flop", square);
  figures.set("per_flop_narrow", narrow);
  return figures;
}

/// Solves with one subdomain's factor, into memory that is there.
class Solves {
 public:
  Solves(const ddm::Subdomain& part, Eigen::Index columns)
      : _operator(part),
        _loads(Eigen::MatrixXd::Random(static_cast<Eigen::Index>(part.free()), columns)),
        _u(_loads.rows(), columns) {
    forward(1, _one);
    forward(columns, _block);
  }

  /// Of its values and pattern, without the Schur complement.
  std::size_t factor_bytes() const {
    const ddm::SubdomainFactor& factor = _operator.factor();
    return factor.bytes() - sizeof(double) * static_cast<std::size_t>(factor.schur().size());
  }

  void forward_one() { forward(1, _one); }
  void forward_block() { forward(_loads.cols(), _block); }
  void backward_one() { backward(_one); }
  void backward_block() { backward(_block); }

 private:
  using Results = std::vector<ddm::SubdomainFactor::Forward>;

  void forward(Eigen::Index columns, Results& results) {
    _operator.factor().forward(_loads.leftCols(columns), results);
  }

  void backward(const Results& results) {
    std::vector<ddm::SubdomainFactor::Backward> columns;
    for (std::size_t j = 0; j < results.size(); ++j) {
      columns.push_back(
          {results[j].z_interior, results[j].g, _u.col(static_cast<Eigen::Index>(j))});
    }
    _operator.factor().recover(columns);
  }

  ddm::SubdomainOperator _operator;
  Eigen::MatrixXd _loads, _u;
  Results _one, _block;
};

/// Of all subdomains, one after the other, on one thread; memory is read between them, because
/// others of a shared machine take of its bandwidth now more, now less.
Figures solves(const Options& options, const ddm::Decomposition& parts) {
  std::vector<Solves> subdomains;
  subdomains.reserve(parts.subdomains.size());
  std::size_t bytes = 0, unknowns = 0;
  for (const ddm::Subdomain& part : parts.subdomains) {
    subdomains.emplace_back(part, options.columns);
    bytes += subdomains.back().factor_bytes();
    unknowns += part.free();
  }
  const std::vector<double> memory(bytes / sizeof(double), 1.0);
  Times reading, single, block, backward, backward_block;
  for (int i = 0; i < options.repetitions; ++i) {
    {
      const Stopwatch watch;
      const double sum = sum_of(memory.data(), memory.size());
      watch.stop(reading);
      if (sum == 0) throw std::runtime_error("the memory was not read");
    }
    {
      const Stopwatch watch;
      for (Solves& subdomain : subdomains) subdomain.forward_one();
      watch.stop(single);
    }
    {
      const Stopwatch watch;
      for (Solves& subdomain : subdomains) subdomain.backward_one();
      watch.stop(backward);
    }
    {
      const Stopwatch watch;
      for (Solves& subdomain : subdomains) subdomain.forward_block();
      watch.stop(block, options.columns);
    }
    const Stopwatch watch;
    for (Solves& subdomain : subdomains) subdomain.backward_block();
    watch.stop(backward_block, options.columns);
  }
  Figures figures;
  figures.set("unknowns", static_cast<double>(unknowns));
  figures.set("factor_bytes", static_cast<double>(bytes));
  figures.set("columns", options.columns);
  figures.set("reading", reading);  // as many bytes
  figures.set("forward", single);
  figures.set("backward", backward);
  figures.set("forward_per_column", block);
  figures.set("backward_per_column", backward_block);
  return figures;
}

void run(const Options& options) {
  ddm::require_threadsafe_blas();  // one thread a caller, as in the server
  operators::set_up_heaps();
  Figures figures;
  figures.set("blas", std::string(openblas_get_config()));
  std::vector<Figures> memory, products;
  for (int threads = 1; threads <= options.threads; threads *= 2) {
    memory.push_back(bandwidth(options, threads));
    products.push_back(dgemm(options, threads));
  }
  figures.set("bandwidth", memory);
  figures.set("dgemm", products);
  figures.set("solves", solves(options, ddm::cut(*to_mesh(read_plain_mesh(options.mesh)))));
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("The machine's limits, and the solves against them.", "bench_limits");
  app.add_option("--mesh", options.mesh, "Written by bench_meshes")->required();
  app.add_option("--repetitions", options.repetitions, "Of everything")->check(CLI::Range(1, 1000));
  app.add_option("--threads", options.threads, "At most")->check(CLI::Range(1, 1024));
  app.add_option("--columns", options.columns, "Of a block")->check(CLI::Range(1, 1024));
  app.add_option("--megabytes", options.megabytes, "Of an array whose reading is timed")
      ->check(CLI::Range(1, 65536));
  app.add_option("--matrix", options.matrix, "Size of dgemm's")->check(CLI::Range(32, 16384));
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_limits: %s\n", error.what());
    return 1;
  }
  return 0;
}
