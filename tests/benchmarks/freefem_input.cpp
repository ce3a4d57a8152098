// SPDX-License-Identifier: GPL-3.0-or-later
//
// A mesh of the benchmarks as peers/algorithm2.edp reads it.
#include <CLI/CLI.hpp>

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <stdexcept>

#include "benchmarks/our_mesh.hpp"
#include "ddm/decomposition.hpp"
#include "fem/interface_mass.hpp"

namespace anticrack::benchmarks {
namespace {

std::ofstream create(const std::filesystem::path& path) {
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file << std::setprecision(17);
  return file;
}

struct LabelledEdge {
  std::int32_t a, b;  ///< nodes of the subdomain
  int label;
};

/// Edges of the mesh that both end in the subdomain: 1 on the outer boundary, 2 on the inclusion.
std::vector<LabelledEdge> labelled_edges(const PlainMesh& mesh, const ddm::Subdomain& part) {
  std::vector<std::int32_t> local(mesh.node_count(), -1);
  for (std::size_t i = 0; i < part.node.size(); ++i) {
    local[at(part.node[i])] = static_cast<std::int32_t>(i);
  }
  std::vector<LabelledEdge> edges;
  const auto add = [&](std::int32_t a, std::int32_t b, int label) {
    if (local[at(a)] >= 0 && local[at(b)] >= 0) {
      edges.push_back({local[at(a)], local[at(b)], label});
    }
  };
  for (std::size_t e = 0; e < mesh.dirichlet.size(); e += 2) {
    add(mesh.dirichlet[e], mesh.dirichlet[e + 1], 1);
  }
  for (const PlainMesh::Chain& chain : mesh.chains) {
    for (std::size_t e = 0; e < chain.kind.size(); ++e) {
      if (chain.kind[e] != kind_glue) add(chain.nodes[e], chain.nodes[e + 1], 2);
    }
  }
  return edges;
}

void write_mesh(const std::filesystem::path& path, const PlainMesh& mesh,
                const ddm::Subdomain& part) {
  const std::vector<LabelledEdge> edges = labelled_edges(mesh, part);
  const std::vector<double>& xy = part.part.xy;
  const std::vector<std::int32_t>& triangles = part.part.triangles;
  std::ofstream file = create(path);
  file << part.node.size() << ' ' << triangles.size() / 3 << ' ' << edges.size() << '\n';
  for (std::size_t i = 0; i < part.node.size(); ++i) {
    file << xy[2 * i] << ' ' << xy[2 * i + 1] << " 0\n";
  }
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    file << triangles[t] + 1 << ' ' << triangles[t + 1] + 1 << ' ' << triangles[t + 2] + 1
         << " 0\n";
  }
  for (const auto& [a, b, label] : edges) file << a + 1 << ' ' << b + 1 << ' ' << label << '\n';
}

void write_pairs(std::ofstream file, const ddm::Decomposition& parts, const ddm::Subdomain& omega1,
                 const ddm::Subdomain& omega2) {
  const Eigen::VectorXd mass = fem::lumped_mass(parts.edges, parts.pairs.size());
  const auto held = std::find_if(omega2.rigid.begin(), omega2.rigid.end(),
                                 [](std::int32_t inclusion) { return inclusion >= 0; });
  file << parts.pairs.size() << ' ' << omega2.interior + at(held - omega2.rigid.begin()) << '\n';
  for (std::size_t k = 0; k < parts.pairs.size(); ++k) {
    const ddm::NodePair& pair = parts.pairs[k];
    file << omega1.interior + at(pair.minus_trace) << ' ' << omega2.interior + at(pair.plus_trace)
         << ' ' << mass[static_cast<Eigen::Index>(k)] << ' ' << (pair.unilateral() ? 0.5 : 0.0)
         << '\n';
  }
}

struct Options {
  std::string mesh, folder;
  double theta = 1.7;
  int loads = 5, repetitions = 1;
};

void run(const Options& options) {
  const PlainMesh plain = read_plain_mesh(options.mesh);
  const std::shared_ptr<const mesh::Mesh> mesh = to_mesh(plain);
  const ddm::Decomposition parts = ddm::cut(*mesh);
  const auto rigid = [](const ddm::Subdomain& part) {
    return std::any_of(part.rigid.begin(), part.rigid.end(), [](std::int32_t j) { return j >= 0; });
  };
  if (parts.subdomains.size() != 2 || mesh->inclusions.size() != 1) {
    throw std::runtime_error("Algorithm 2 is for two subdomains and one inclusion");
  }
  // Omega_1 of the paper is the minus side.
  const std::size_t first = at(parts.pairs.at(0).minus), second = 1 - first;
  const ddm::Subdomain& omega1 = parts.subdomains[first];
  const ddm::Subdomain& omega2 = parts.subdomains[second];
  if (!rigid(omega2)) throw std::runtime_error("the inclusion has to be on the plus side");
  const std::filesystem::path folder = options.folder;
  std::filesystem::create_directories(folder);
  write_mesh(folder / "omega1.msh", plain, omega1);
  write_mesh(folder / "omega2.msh", plain, omega2);
  write_pairs(create(folder / "pairs.txt"), parts, omega1, omega2);
  create(folder / "parameters.txt") << options.theta << " 1e5 1e-12 " << options.loads << ' '
                                    << options.repetitions << " 20000\n";
}

}  // namespace
}  // namespace anticrack::benchmarks

int main(int argc, char** argv) {
  anticrack::benchmarks::Options options;
  CLI::App app("Writes a mesh of the benchmarks for FreeFEM++.", "bench_freefem_input");
  app.add_option("--mesh", options.mesh, "Written by bench_meshes")->required();
  app.add_option("--folder", options.folder, "Where to")->required();
  app.add_option("--theta", options.theta, "Of Algorithm 2");
  app.add_option("--loads", options.loads, "Load cases")->check(CLI::Range(1, 1000));
  app.add_option("--repetitions", options.repetitions, "Of each")->check(CLI::Range(1, 1000));
  CLI11_PARSE(app, argc, argv);
  try {
    anticrack::benchmarks::run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_freefem_input: %s\n", error.what());
    return 1;
  }
  return 0;
}
