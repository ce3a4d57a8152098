// SPDX-License-Identifier: GPL-3.0-or-later
//
// The parts that are run again and again, each alone, by Google Benchmark:
//   bench_kernels --mesh=FILE [Google Benchmark's own options]
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <string_view>
#include <vector>

#include "benchmarks/our_mesh.hpp"
#include "contact/answer.hpp"
#include "contact/options.hpp"
#include "contact/sweep_columns.hpp"
#include "contact/trace_problem.hpp"
#include "contact/uzawa.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"
#include "jobs/event_log.hpp"
#include "operators/mesh_operator.hpp"
#include "support/silent_observer.hpp"

namespace anticrack::benchmarks {
namespace {

using anticrack::testing::Silent;

/// One mesh, taken apart as the solver has it.
class Bench {
 public:
  explicit Bench(const std::string& path)
      : plain(read_plain_mesh(path)),
        mesh(to_mesh(plain)),
        decomposition(ddm::cut(*mesh)),
        whole(operators::MeshOperator::factorise(mesh, 1, {})) {
    for (const ddm::Subdomain& part : decomposition.subdomains) operators.emplace_back(part);
  }

  std::vector<fem::Load> loads(int count) const {
    std::vector<fem::Load> result;
    for (int k = 0; k < count; ++k) result.push_back(nodal_load(plain, k));
    return result;
  }
  std::vector<operators::PreparedLoad> prepared(int count) const {
    const std::vector<fem::Load> all = loads(count);
    std::vector<const fem::Load*> pointers;
    for (const fem::Load& load : all) pointers.push_back(&load);
    std::vector<operators::PreparedLoad> result;
    for (auto& load : whole->prepare(pointers)) {
      result.push_back(std::get<operators::PreparedLoad>(std::move(load)));
    }
    return result;
  }

  const PlainMesh plain;
  const std::shared_ptr<const mesh::Mesh> mesh;
  const ddm::Decomposition decomposition;
  std::vector<ddm::SubdomainOperator> operators;
  const std::shared_ptr<const operators::MeshOperator> whole;
};

int columns_of(const benchmark::State& state) { return static_cast<int>(state.range(0)); }

/// An iteration of Algorithm 2 for so many loads at once.
void uzawa_iteration(benchmark::State& state, const Bench& bench) {
  const int columns = columns_of(state);
  const contact::TraceProblem problem(bench.decomposition, bench.operators);
  contact::Uzawa uzawa(problem, contact::Mass::lumped, columns);
  std::vector<std::vector<ddm::CondensedLoad>> loads(static_cast<std::size_t>(columns));
  for (int c = 0; c < columns; ++c) {
    std::vector<ddm::CondensedLoad>& load = loads[static_cast<std::size_t>(c)];
    for (std::size_t s = 0; s < bench.operators.size(); ++s) {
      const ddm::Subdomain& part = bench.decomposition.subdomains[s];
      const auto nodes = static_cast<Eigen::Index>(part.node.size());
      load.push_back(std::move(
          bench.operators[s]
              .condense(Eigen::VectorXd::Constant(nodes, 1.0 / static_cast<double>(nodes + c)),
                        Eigen::VectorXd::Zero(static_cast<Eigen::Index>(part.dirichlet)))
              .front()));
    }
    uzawa.start(c, load, 0.97 * problem.theta_star(contact::Mass::lumped), 1e5);
  }
  for (auto _ : state) uzawa.step(columns);
  state.SetItemsProcessed(state.iterations() * columns);
}

/// Forward solves of both subdomains: L_II^-1 f_I and the condensed load.
void forward_solve(benchmark::State& state, const Bench& bench) {
  std::vector<Eigen::MatrixXd> loads;
  for (const ddm::Subdomain& part : bench.decomposition.subdomains) {
    loads.push_back(
        Eigen::MatrixXd::Random(static_cast<Eigen::Index>(part.free()), columns_of(state)));
  }
  for (auto _ : state) {
    for (std::size_t s = 0; s < loads.size(); ++s) {
      benchmark::DoNotOptimize(bench.operators[s].factor().forward(loads[s]).data());
    }
  }
  state.SetItemsProcessed(state.iterations() * columns_of(state));
}

/// A load that is condensed already: active set, refinement and the answer's traces.
void active_set(benchmark::State& state, const Bench& bench) {
  const std::vector<operators::PreparedLoad> loads = bench.prepared(16);
  Silent nobody;
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        bench.whole->solve(loads[next], contact::ActiveSetOptions{}, false, nobody).energy);
    next = (next + 1) % loads.size();
  }
  state.SetItemsProcessed(state.iterations());
}

/// Rows of a sweep over so many basis loads.
void sweep_rows(benchmark::State& state, const Bench& bench) {
  constexpr std::size_t rows = 256;
  const std::vector<fem::Load> loads = bench.loads(columns_of(state));
  std::vector<const fem::Load*> pointers;
  for (const fem::Load& load : loads) pointers.push_back(&load);
  const auto basis = bench.whole->basis(pointers);
  std::vector<double> coefficients;
  for (std::size_t k = 0; k < rows; ++k) {
    for (int j = 0; j < columns_of(state); ++j) {
      coefficients.push_back(combination(static_cast<int>(k), j));
    }
  }
  contact::SweepColumns columns(rows, bench.mesh->inclusions.size(),
                                bench.whole->contact_nodes().size());
  for (auto _ : state) {
    std::vector<char> start;
    bench.whole->sweep(*basis, coefficients, contact::ActiveSetOptions{}, columns, start);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(rows));
}

jobs::Event sample(int iteration) {
  jobs::SampleEvent event;
  event.sample.iteration = iteration;
  event.sample.energy = 1.0 / iteration;
  return event;
}

void event_log_append(benchmark::State& state) {
  jobs::EventLog log(64 << 20);
  int iteration = 0;
  for (auto _ : state) log.append(sample(++iteration));
  state.SetItemsProcessed(state.iterations());
}

/// As a watcher reads it: so many events at a time.
void event_log_read(benchmark::State& state) {
  constexpr int events = 100'000;
  jobs::EventLog log(std::numeric_limits<std::size_t>::max());
  for (int i = 1; i <= events; ++i) log.append(sample(i));
  std::uint64_t after = 0;
  for (auto _ : state) {
    const std::vector<jobs::NumberedEvent> read =
        log.read(after, static_cast<std::size_t>(columns_of(state)));
    after = read.empty() || read.back().sequence == log.latest() ? 0 : read.back().sequence;
  }
  state.SetItemsProcessed(state.iterations() * columns_of(state));
}

void enrol(const Bench& bench) {
  const auto with = [&bench](void (*kernel)(benchmark::State&, const Bench&)) {
    return [kernel, &bench](benchmark::State& state) { kernel(state, bench); };
  };
  for (const int columns : {1, 8, 32}) {
    benchmark::RegisterBenchmark("uzawa_iteration", with(uzawa_iteration))->Arg(columns);
  }
  for (const int columns : {1, 8, 32}) {
    benchmark::RegisterBenchmark("forward_solve", with(forward_solve))->Arg(columns);
  }
  benchmark::RegisterBenchmark("active_set", with(active_set));
  for (const int loads : {1, 8, 32}) {
    benchmark::RegisterBenchmark("sweep_256_rows", with(sweep_rows))->Arg(loads);
  }
  benchmark::RegisterBenchmark("event_log_append", event_log_append);
  benchmark::RegisterBenchmark("event_log_read", event_log_read)->Arg(1024);
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  try {
    benchmark::Initialize(&argc, argv);
    constexpr std::string_view option = "--mesh=";
    if (argc != 2 || std::string_view(argv[1]).substr(0, option.size()) != option) {
      std::fprintf(stderr, "bench_kernels: give --mesh=FILE and options of Google Benchmark\n");
      return 2;
    }
    const anticrack::benchmarks::Bench bench(argv[1] + option.size());
    anticrack::benchmarks::enrol(bench);
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_kernels: %s\n", error.what());
    return 1;
  }
  return 0;
}
