// SPDX-License-Identifier: GPL-3.0-or-later
//
// Our solver in process, on a mesh of the benchmarks: first answer from nothing but the mesh,
// further load cases, both methods, memory.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/at_once.hpp"
#include "benchmarks/figures.hpp"
#include "benchmarks/our_mesh.hpp"
#include "contact/sweep_columns.hpp"
#include "ddm/decomposition.hpp"
#include "operators/freed_memory.hpp"
#include "operators/mesh_operator.hpp"
#include "support/process_memory.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::benchmarks {
namespace {

using anticrack::testing::Silent;
using operators::MeshOperator;
using Operator = std::shared_ptr<const MeshOperator>;

struct Options {
  std::string mesh;
  int threads = 1;
  int repetitions = 5;
  int loads = 5;
  int block = 32;
  int uzawa_loads = 0;
  int rows = 0;
  double theta = 0;      ///< 0: that of the mesh
  int most = 1'000'000;  ///< iterations
};

/// A, energy and iterations of load cases 0, 1, ...
struct Answers {
  std::vector<double> displacement, energy, iterations;

  void add(const contact::Answer& answer) {
    if (answer.status != contact::Status::converged) {
      throw std::runtime_error(std::string("a load case did not converge: ") + answer.reason);
    }
    keep(answer);
  }
  void keep(const contact::Answer& answer) {
    displacement.push_back(answer.inclusions.at(0).displacement);
    energy.push_back(answer.energy);
    iterations.push_back(answer.iterations);
  }
  void put(Figures& figures) const {
    figures.set("displacement", displacement);
    figures.set("energy", energy);
    figures.set("iterations", iterations);
  }
};

/// From an unfactorised mesh, each time anew. The last one's operators stay.
Operator first_answers(const Options& options, const std::shared_ptr<const mesh::Mesh>& mesh,
                       const fem::Load& load, Figures& figures) {
  Times first, cut, factorise;
  Operator op;
  Silent nobody;
  testing::reset_peak_memory();
  const std::uint64_t before = testing::memory_of("VmHWM");
  for (int i = 0; i < options.repetitions; ++i) {
    op.reset();
    {
      const Stopwatch watch;
      const ddm::Decomposition parts = ddm::cut(*mesh);
      watch.stop(cut);
    }
    const Stopwatch watch;
    op = MeshOperator::factorise(mesh, options.threads, {});
    watch.stop(factorise);
    testing::solve(*op, load, contact::ActiveSetOptions{}, false, nobody);
    watch.stop(first);
  }
  figures.set("first", first);
  figures.set("cut", cut);  // is part of factorising, told apart
  figures.set("factorise", factorise);
  figures.set("memory_mesh", static_cast<double>(before));
  figures.set("memory_peak", static_cast<double>(testing::memory_of("VmHWM")));
  figures.set("operator_bytes", static_cast<double>(op->bytes()));
  return op;
}

/// A load for the fields of its answer, which reads the factors once, and for its bounds.
struct Bounding {
  Times fields, bounds;
};

/// Bounds so many answers at once, on so many threads.
Bounding estimates(const MeshOperator& op, std::span<const fem::Load> loads, std::size_t at_once,
                   int threads) {
  const base::Threads allowed(threads);
  Bounding times;
  Silent nobody;
  for (; loads.size() >= at_once; loads = loads.subspan(at_once)) {
    std::vector<operators::PreparedLoad> prepared;
    std::vector<contact::Answer> answers;
    for (const fem::Load& load : loads.first(at_once)) {
      auto one = op.prepare(std::array{&load});
      prepared.push_back(std::get<operators::PreparedLoad>(std::move(one.front())));
      answers.push_back(
          testing::solve(op, prepared.back(), contact::ActiveSetOptions{}, false, nobody));
    }
    std::vector<MeshOperator::Estimate> all;
    std::vector<const operators::PreparedLoad*> of;
    std::vector<contact::Answer*> to;
    for (std::size_t k = 0; k < at_once; ++k) {
      all.push_back({of.emplace_back(&prepared[k]), to.emplace_back(&answers[k]), {}});
    }
    const Stopwatch recovering;
    op.recover_fields(of, to);
    recovering.stop(times.fields, static_cast<double>(at_once));
    const Stopwatch watch;
    op.estimate(all);
    watch.stop(times.bounds, static_cast<double>(at_once));
    for (const MeshOperator::Estimate& one : all)
      if (one.failure) std::rethrow_exception(one.failure);
  }
  return times;
}

void further_loads(const Options& options, const MeshOperator& op,
                   const std::vector<fem::Load>& loads, Figures& figures) {
  const base::Threads allowed(options.threads);  // as in a job
  Times alone;
  Answers answers;
  Silent nobody;
  for (std::size_t k = 0; k < static_cast<std::size_t>(options.loads); ++k) {
    const Stopwatch watch;
    const contact::Answer answer =
        testing::solve(op, loads[k], contact::ActiveSetOptions{}, false, nobody);
    watch.stop(alone);
    answers.add(answer);
  }
  figures.set("further", alone);
  const Bounding alone_bounded = estimates(
      op, std::span(loads).first(static_cast<std::size_t>(options.loads)), 1, options.threads);
  figures.set("fields", alone_bounded.fields);
  figures.set("estimate", alone_bounded.bounds);
  answers.put(figures);
}

contact::SweepColumns columns(const MeshOperator& op, std::size_t rows) {
  return {rows, op.mesh().inclusions.size(), op.contact_nodes().size()};
}

void require_converged(const contact::SweepColumns& rows) {
  for (const contact::Status status : rows.status) {
    if (status != contact::Status::converged) {
      throw std::runtime_error("a row of a sweep did not converge");
    }
  }
}

/// The same in blocks: condensed together, then rows of a sweep.
void blocks(const Options& options, const MeshOperator& op, const std::vector<fem::Load>& loads,
            Figures& figures) {
  std::vector<const fem::Load*> block;
  for (int k = 0; k < options.block; ++k) block.push_back(&loads[static_cast<std::size_t>(k)]);
  Times whole, condensing;
  contact::SweepColumns rows = columns(op, block.size());
  for (int i = 0; i < options.repetitions; ++i) {
    const Stopwatch watch;
    std::vector<operators::PreparedLoad> prepared;
    for (auto& load : op.prepare(block)) {
      prepared.push_back(std::get<operators::PreparedLoad>(std::move(load)));
    }
    watch.stop(condensing, static_cast<double>(block.size()));
    std::vector<char> start;
    op.sweep(prepared, contact::ActiveSetOptions{}, rows, start);
    watch.stop(whole, static_cast<double>(block.size()));
  }
  require_converged(rows);
  Figures result;
  result.set("columns", static_cast<double>(block.size()));
  result.set("per_load", whole);
  result.set("condensing_per_load", condensing);
  result.set("estimate_per_load", estimates(op, loads, block.size(), options.threads).bounds);
  result.set("displacement", rows.displacement);
  result.set("energy", rows.energy);
  figures.set("block", result);
}

/// Combinations of a few loads whose coefficients change slowly, as designs and seasons do.
void sweep(const Options& options, const MeshOperator& op, const std::vector<fem::Load>& loads,
           Figures& figures) {
  constexpr std::size_t basis_size = 8;
  std::vector<const fem::Load*> pointers;
  for (std::size_t j = 0; j < basis_size; ++j) pointers.push_back(&loads[j]);
  const auto basis = op.basis(pointers);
  const auto count = static_cast<std::size_t>(options.rows);
  std::vector<double> coefficients(count * basis_size);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t j = 0; j < basis_size; ++j) {
      coefficients[k * basis_size + j] = combination(static_cast<int>(k), static_cast<int>(j));
    }
  }
  Times per_row;
  contact::SweepColumns rows = columns(op, count);
  for (int i = 0; i < options.repetitions; ++i) {
    std::vector<char> start;
    const Stopwatch watch;
    op.sweep(*basis, coefficients, contact::ActiveSetOptions{}, rows, start);
    watch.stop(per_row, static_cast<double>(count));
  }
  require_converged(rows);
  double steps = 0, open = 0;
  for (const std::int32_t n : rows.steps) steps += n;
  for (const std::uint8_t closed : rows.contact) open += closed == 0 ? 1 : 0;
  Figures result;
  result.set("rows", static_cast<double>(count));
  result.set("basis", static_cast<double>(basis_size));
  result.set("per_row", per_row);
  result.set("steps_per_row", steps / static_cast<double>(count));
  result.set("open_per_row", open / static_cast<double>(count));
  figures.set("sweep", result);
}

void uzawa(const Options& options, const MeshOperator& op, const std::vector<fem::Load>& loads,
           Figures& figures) {
  contact::UzawaOptions how;
  how.theta = options.theta > 0 ? std::optional<double>(options.theta) : std::nullopt;
  how.max_iterations = options.most;
  Times per_load, per_iteration;
  Answers answers;
  Silent nobody;
  double theta = 0, converged = 0;
  // The first computes theta* and what each iteration multiplies by, once for all loads.
  testing::solve(op, loads[0], how, false, nobody);
  for (std::size_t k = 0; k < static_cast<std::size_t>(options.uzawa_loads); ++k) {
    const Stopwatch watch;
    const contact::Answer answer = testing::solve(op, loads[k], how, false, nobody);
    watch.stop(per_load);
    watch.stop(per_iteration, answer.iterations);
    theta = answer.theta;
    answers.keep(answer);
    converged += answer.status == contact::Status::converged ? 1 : 0;
  }
  Figures result;
  result.set("per_load", per_load);
  result.set("per_iteration", per_iteration);
  result.set("theta", theta);
  result.set("converged", converged);
  result.set("theta_star", op.theta_star());
  answers.put(result);
  figures.set("uzawa", result);
}

void describe(const mesh::Mesh& mesh, Figures& figures) {
  const ddm::Decomposition parts = ddm::cut(mesh);
  std::size_t unknowns = 0;
  for (const ddm::Subdomain& part : parts.subdomains) unknowns += part.free();
  figures.set("triangles", static_cast<double>(mesh.triangle_count()));
  figures.set("unknowns", static_cast<double>(unknowns));
  figures.set("contacts", static_cast<double>(parts.skeleton.contacts.size()));
}

void run(const Options& options) {
  operators::set_up_heaps();  // as in the server
  PlainMesh plain = read_plain_mesh(options.mesh);
  const std::shared_ptr<const mesh::Mesh> mesh = to_mesh(plain);
  // Loads take its nodes only; the memory of the first answer is not to count it twice.
  plain.triangles = plain.subdomain = {};
  Figures figures;
  describe(*mesh, figures);
  let_blas_fall_asleep();
  figures.set("threads", options.threads);
  const Operator op = first_answers(options, mesh, nodal_load(plain, 0), figures);
  std::vector<fem::Load> loads;
  const int count = std::max({options.loads, options.block, options.uzawa_loads, 8});
  for (int k = 0; k < count; ++k) loads.push_back(nodal_load(plain, k));
  further_loads(options, *op, loads, figures);
  if (options.block > 0) blocks(options, *op, loads, figures);
  if (options.rows > 0) sweep(options, *op, loads, figures);
  if (options.uzawa_loads > 0) uzawa(options, *op, loads, figures);
  figures.set("memory_end", static_cast<double>(testing::memory_of("VmHWM")));
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("Our solver on a mesh of the benchmarks.", "bench_ours");
  app.add_option("--mesh", options.mesh, "Written by bench_meshes")->required();
  app.add_option("--threads", options.threads, "To factorise with")->check(CLI::Range(1, 1024));
  app.add_option("--repetitions", options.repetitions, "Of what is done anew")
      ->check(CLI::Range(1, 1000));
  app.add_option("--loads", options.loads, "Load cases alone")->check(CLI::Range(1, 100'000));
  app.add_option("--block", options.block, "Load cases at once; 0: leave it out")
      ->check(CLI::Range(0, 1024));
  app.add_option("--rows", options.rows, "Combinations of loads; 0: leave them out")
      ->check(CLI::Range(0, 10'000'000));
  app.add_option("--uzawa-loads", options.uzawa_loads, "Load cases by Algorithm 2")
      ->check(CLI::Range(0, 100'000));
  app.add_option("--most", options.most, "Iterations of Algorithm 2")
      ->check(CLI::Range(1, 1'000'000));
  app.add_option("--theta", options.theta, "Of Algorithm 2; unset: 0.97 theta*");
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_ours: %s\n", error.what());
    return 1;
  }
  return 0;
}
