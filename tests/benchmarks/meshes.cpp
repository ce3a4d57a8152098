// SPDX-License-Identifier: GPL-3.0-or-later
//
// Makes the meshes of the benchmarks, once, by the real helper, and writes them for all programs to
// read: the paper's, and graded ones of so many triangles.
#include <sys/resource.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>

#include "benchmarks/figures.hpp"
#include "benchmarks/our_mesh.hpp"
#include "mesher/helper.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack::benchmarks {
namespace {

constexpr std::size_t most_triangles = 10'000'000;

struct Made {
  mesh::Mesh mesh;
  mesh::MeshOptions options;
  Times times;  ///< of the helper, its start and what travels included
};

/// n x n slits in the square, each with an inclusion that is delaminated from tip to tip.
mesh::Geometry fibres(int n) {
  mesh::Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const double spacing = 2.0 / n;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = -1 + (i + 0.5) * spacing, y = -1 + (j + 0.5) * spacing;
      const mesh::Part part{{x - spacing / 4, y}, {x + spacing / 4, y}};
      const std::string number = std::to_string(i * n + j + 1);
      geometry.interfaces.push_back(
          {"slit-" + number, mesh::Shape::polyline, {part.from, part.to}});
      geometry.inclusions.push_back({"fibre-" + number, part, {part}});
    }
  }
  return geometry;
}

Made make(const std::string& helper, const mesh::MeshOptions& options,
          const mesh::Geometry& geometry = testing::paper_geometry()) {
  mesher::HelperOptions how;
  how.executable = helper;
  how.time_limit = std::chrono::hours(1);
  how.memory_limit = 16ULL << 30;
  const mesh::GenerateRequest request{mesh::plan(geometry, options, most_triangles),
                                      most_triangles};
  Made made{{}, options, {}};
  const Stopwatch watch;
  made.mesh = mesher::run(how, request, {});
  watch.stop(made.times);
  return made;
}

/// A mesh of about so many triangles: a size h makes about c / h^2, and c is found by trying
/// coarser meshes first, which cost little. The tips of a graded one alone take more than a
/// thousand.
Made of_triangles(const std::string& helper, mesh::Preset preset, double triangles) {
  mesh::MeshOptions options;
  options.preset = preset;
  options.size = 0.2;
  double wanted = std::min(triangles, 4'000.0);
  Made made = make(helper, options);
  const auto count = [&made] { return static_cast<double>(made.mesh.triangle_count()); };
  for (int attempt = 0; attempt < 12; ++attempt) {
    const bool close = std::abs(count() / wanted - 1) < 0.05;
    if (close && wanted == triangles) break;
    // What the coarse one taught is used for one 8 times as fine.
    if (close) wanted = std::min(triangles, 8 * wanted);
    options.size = std::min(options.size * std::sqrt(count() / wanted), 0.5);
    made = make(helper, options);
  }
  return made;
}

Figures describe(const std::string& name, const PlainMesh& plain, const Made& made) {
  std::size_t interface_nodes = 0;
  for (const PlainMesh::Chain& chain : plain.chains) interface_nodes += chain.nodes.size();
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  Figures figures;
  figures.set("name", name);
  figures.set("nodes", static_cast<double>(plain.node_count()));
  figures.set("triangles", static_cast<double>(plain.triangle_count()));
  figures.set("interface_nodes", static_cast<double>(interface_nodes));
  figures.set("size", made.options.size);
  figures.set("meshing", made.times);
  figures.set("helper_memory", 1024.0 * static_cast<double>(usage.ru_maxrss));
  return figures;
}

struct Options {
  std::string helper, folder;
  bool paper = false;
  std::vector<double> graded, uniform, fibres;
};

void run(const Options& options) {
  std::vector<Figures> all;
  const auto keep = [&](const std::string& name, const Made& made) {
    const PlainMesh plain = to_plain(made.mesh);
    write(plain, options.folder + "/" + name + ".mesh");
    all.push_back(describe(name, plain, made));
  };
  if (options.paper) keep("paper", make(options.helper, testing::paper_options()));
  const auto keep_all = [&](const std::string& stem, mesh::Preset preset,
                            const std::vector<double>& counts) {
    for (const double triangles : counts) {
      keep(stem + std::to_string(static_cast<long long>(triangles)),
           of_triangles(options.helper, preset, triangles));
    }
  };
  keep_all("graded-", mesh::Preset::graded, options.graded);
  keep_all("uniform-", mesh::Preset::uniform, options.uniform);
  for (const double n : options.fibres) {
    const auto count = static_cast<int>(std::lround(std::sqrt(n)));
    keep("fibres-" + std::to_string(count * count), make(options.helper, {}, fibres(count)));
  }
  Figures figures;
  figures.set("meshes", all);
  figures.print();
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("Makes the meshes of the benchmarks and writes them as NAME.mesh.", "bench_meshes");
  app.add_option("--helper", options.helper, "Path of anticrack-mesher")->required();
  app.add_option("--folder", options.folder, "Where they are written")->required();
  app.add_flag("--paper", options.paper, "The paper's mesh");
  app.add_option("--graded", options.graded, "Graded meshes of about so many triangles")
      ->check(CLI::Range(2'000.0, 9e6));
  app.add_option("--uniform", options.uniform, "Uniform meshes of about so many triangles")
      ->check(CLI::Range(100.0, 9e6));
  app.add_option("--fibres", options.fibres, "Default meshes of so many fibres in a square grid")
      ->check(CLI::Range(1.0, 1000.0));
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_meshes: %s\n", error.what());
    return 1;
  }
  return 0;
}
