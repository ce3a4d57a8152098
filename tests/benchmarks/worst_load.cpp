// SPDX-License-Identifier: GPL-3.0-or-later
//
// Looks for the expression that is the most expensive to integrate: random texts, then changes of
// the worst of them, on a mesh of the benchmarks.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "benchmarks/figures.hpp"
#include "benchmarks/our_mesh.hpp"
#include "errors/errors.hpp"
#include "fem/adaptive_load.hpp"
#include "fem/load_vector.hpp"
#include "support/random_expression.hpp"

namespace anticrack::benchmarks {
namespace {

struct Options {
  std::string mesh;
  double seconds = 60;
  unsigned seed = 1;
};

struct Found {
  double seconds;
  double error;
  std::string text;

  bool operator<(const Found& other) const { return seconds > other.seconds; }
};

Found measure(const fem::Triangulation& part, const std::string& text) {
  Times times;
  fem::IntegrationReport report{};
  const Stopwatch watch;
  try {
    fem::load_vector(part, fem::Expression{text}, "a", {.report = &report});
  } catch (const errors::Error&) {  // not finite somewhere: it ended there
  }
  watch.stop(times);
  return {times.cpu.front(), report.proof.relative(), text};
}

void run(const Options& options) {
  const PlainMesh mesh = read_plain_mesh(options.mesh);
  const fem::Triangulation part{mesh.xy, mesh.triangles};
  testing::RandomExpression random(options.seed);
  constexpr std::size_t kept = 10;
  std::multiset<Found> worst;
  double spent = 0;
  for (int tried = 0; spent < options.seconds; ++tried) {
    std::string text;
    if (tried % 2 == 0 || worst.empty()) {
      text = random.any(4);
    } else {  // joined with what was bad already
      auto base = worst.begin();
      std::advance(base, static_cast<long>(tried / 2 % static_cast<int>(worst.size())));
      text = random.joined(base->text);
    }
    if (text.size() > 4096) continue;
    const Found found = measure(part, text);
    spent += found.seconds + 1e-3;
    worst.insert(found);
    if (worst.size() > kept) worst.erase(std::prev(worst.end()));
  }
  std::vector<Figures> list;
  for (const Found& found : worst) {
    Figures one;
    one.set("seconds", found.seconds);
    one.set("relative_error", found.error);
    one.set("expression", found.text);
    list.push_back(one);
  }
  Figures figures;
  figures.set("triangles", static_cast<double>(mesh.triangle_count()));
  figures.set("worst", list);
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("Looks for the most expensive expression.", "bench_worst_load");
  app.add_option("--mesh", options.mesh, "Written by bench_meshes")->required();
  app.add_option("--seconds", options.seconds, "Of looking, CPU time")->check(CLI::Range(0.1, 1e6));
  app.add_option("--seed", options.seed, "Of the random texts");
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_worst_load: %s\n", error.what());
    return 1;
  }
  return 0;
}
