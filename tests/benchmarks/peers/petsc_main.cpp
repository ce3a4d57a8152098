// SPDX-License-Identifier: GPL-3.0-or-later
//
// What users of PETSc have: first answer from nothing but the mesh, and further load cases.
#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>

#include "benchmarks/figures.hpp"
#include "benchmarks/peers/petsc.hpp"
#include "support/process_memory.hpp"

namespace anticrack::benchmarks {
namespace {

struct Options {
  std::string mesh;
  std::string method = "schur";
  int ordering = 0;
  int repetitions = 5;
  int loads = 5;
};

std::unique_ptr<Peer> make(const Options& options, const PlainMesh& mesh) {
  if (options.method == "snesvi") return snesvi_peer(mesh);
  if (options.method == "tron") return tron_peer(mesh);
  return schur_peer(mesh, options.ordering);
}

void run(const Options& options) {
  const PlainMesh mesh = read_plain_mesh(options.mesh);
  std::vector<std::vector<double>> forces;
  for (int k = 0; k < options.loads; ++k) forces.push_back(nodal_force(mesh, k));

  let_blas_fall_asleep();
  Times first, further;
  std::unique_ptr<Peer> peer;
  for (int i = 0; i < options.repetitions; ++i) {
    peer.reset();
    const Stopwatch watch;
    peer = make(options, mesh);
    peer->solve(forces.front());
    watch.stop(first);
  }
  std::vector<double> displacement, energy, steps;
  for (const std::vector<double>& force : forces) {
    const Stopwatch watch;
    const PeerAnswer answer = peer->solve(force);
    watch.stop(further);
    displacement.push_back(answer.displacement);
    energy.push_back(answer.energy);
    steps.push_back(answer.steps);
  }
  Figures figures;
  figures.set("method", options.method);
  figures.set("ordering", options.ordering);
  figures.set("first", first);
  figures.set("further", further);
  figures.set("displacement", displacement);
  figures.set("energy", energy);
  figures.set("iterations", steps);
  figures.set("memory_peak", static_cast<double>(testing::memory_of("VmHWM")));
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("PETSc on a mesh of the benchmarks.", "bench_petsc");
  app.add_option("--mesh", options.mesh, "Written by bench_meshes")->required();
  app.add_option("--method", options.method, "How")
      ->check(CLI::IsMember({"schur", "snesvi", "tron"}));
  app.add_option(
         "--ordering", options.ordering,
         "Of MUMPS (ICNTL(7)): 0 AMD, 2 AMF, 3 Scotch, 4 PORD, 5 METIS, 6 QAMD, 7 its choice")
      ->check(CLI::Range(0, 7));
  app.add_option("--repetitions", options.repetitions, "Of the first answer")
      ->check(CLI::Range(1, 1000));
  app.add_option("--loads", options.loads, "Load cases")->check(CLI::Range(1, 100'000));
  CLI11_PARSE(app, argc, argv);
  int result = 0;
  if (PetscInitializeNoArguments() != 0) return 1;
  PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_petsc: %s\n", error.what());
    result = 1;
  }
  PetscFinalize();
  return result;
}
