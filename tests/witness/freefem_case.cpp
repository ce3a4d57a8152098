// SPDX-License-Identifier: GPL-3.0-or-later
#include "witness/freefem_case.hpp"

#include <unistd.h>

#include <fstream>
#include <iomanip>
#include <stdexcept>

#include "base/at.hpp"
#include "support/process.hpp"

namespace anticrack::witness {
namespace {

constexpr int outer_boundary = 1, gamma_c = 2, gamma_g = 3;  // labels in algorithm2.edp

std::ofstream create(const std::filesystem::path& path) {
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  file << std::setprecision(17);
  return file;
}

struct LabelledEdge {
  std::int32_t a, b;
  int label;
};

/// Edges of the mesh that both end in the subdomain, in its numbers from 1.
std::vector<LabelledEdge> labelled_edges(const mesh::Mesh& mesh, const ddm::Subdomain& subdomain) {
  std::vector<std::int32_t> local(mesh.node_count(), 0);
  for (std::size_t i = 0; i < subdomain.node.size(); ++i) {
    local[at(subdomain.node[i])] = static_cast<std::int32_t>(i + 1);
  }
  std::vector<LabelledEdge> edges;
  const auto add = [&](std::int32_t a, std::int32_t b, int label) {
    if (local[at(a)] != 0 && local[at(b)] != 0) {
      edges.push_back({local[at(a)], local[at(b)], label});
    }
  };
  for (const auto& [a, b] : mesh.dirichlet) {
    add(a, b, outer_boundary);
  }
  const mesh::Interface& interface = mesh.interfaces.at(0);
  for (std::size_t e = 0; e < interface.kind.size(); ++e) {
    add(interface.nodes[e], interface.nodes[e + 1],
        interface.kind[e] == mesh::Kind::delaminated ? gamma_c : gamma_g);
  }
  return edges;
}

void write_mesh(const std::filesystem::path& path, const mesh::Mesh& mesh,
                const ddm::Subdomain& subdomain) {
  const std::vector<LabelledEdge> edges = labelled_edges(mesh, subdomain);
  std::vector<int> label(subdomain.node.size(), 0);
  for (const LabelledEdge& edge : edges) {
    label[at(edge.a - 1)] = label[at(edge.b - 1)] = edge.label;
  }
  std::ofstream file = create(path);
  const std::vector<double>& xy = subdomain.part.xy;
  const std::vector<std::int32_t>& triangles = subdomain.part.triangles;
  file << xy.size() / 2 << ' ' << triangles.size() / 3 << ' ' << edges.size() << '\n';
  for (std::size_t i = 0; i < label.size(); ++i) {
    file << xy[2 * i] << ' ' << xy[2 * i + 1] << ' ' << label[i] << '\n';
  }
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    file << triangles[t] + 1 << ' ' << triangles[t + 1] + 1 << ' ' << triangles[t + 2] + 1
         << " 0\n";
  }
  for (const LabelledEdge& edge : edges) {
    file << edge.a << ' ' << edge.b << ' ' << edge.label << '\n';
  }
}

void write_pairs(const std::filesystem::path& path, const ddm::Decomposition& decomposition) {
  const auto interior = [&](std::int32_t subdomain) {
    return decomposition.subdomains[at(subdomain)].interior;
  };
  std::ofstream file = create(path);
  file << decomposition.pairs.size() << '\n';
  for (const ddm::NodePair& pair : decomposition.pairs) {
    file << interior(pair.minus) + at(pair.minus_trace) << ' '
         << interior(pair.plus) + at(pair.plus_trace) << ' ' << (pair.unilateral() ? 1 : 0) << '\n';
  }
}

Answer read_answer(const std::filesystem::path& path, const ddm::Decomposition& decomposition) {
  std::ifstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  Answer answer;
  file >> answer.a >> answer.criterion;
  for (std::size_t s = 0; s < 2; ++s) {
    for (const std::int32_t node : decomposition.subdomains[s].node) {
      file >> answer.u[s][node];
    }
  }
  return answer;
}

}  // namespace

std::optional<std::string> freefem() {
  for (const char* path : {"/usr/bin/FreeFem++", "/usr/local/bin/FreeFem++"}) {
    if (access(path, X_OK) == 0) {
      return path;
    }
  }
  return std::nullopt;
}

Answer run(const std::string& program, const std::filesystem::path& folder, const mesh::Mesh& mesh,
           const ddm::Decomposition& decomposition, const Parameters& parameters) {
  for (const std::size_t s : {0U, 1U}) {
    write_mesh(folder / ("omega" + std::to_string(s + 1) + ".msh"), mesh,
               decomposition.subdomains.at(s));
  }
  write_pairs(folder / "pairs.txt", decomposition);
  {
    std::ofstream file = create(folder / "parameters.txt");
    file << parameters.theta << ' ' << parameters.p << ' ' << parameters.iterations;
    for (const double value : parameters.force) {
      file << ' ' << value;
    }
    file << '\n';
  }
  testing::Process process(
      {program, "-nw", "-v", "0", ANTICRACK_ALGORITHM_2, folder.string()},
      {"FF_LOADPATH=/usr/lib/freefem++;;", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"});
  const std::optional<int> exit = process.wait(std::chrono::seconds(120));
  if (exit != 0) {
    throw std::runtime_error((exit ? "FreeFEM++ failed: " : "FreeFEM++ is not done in time: ") +
                             process.output() + process.error());
  }
  return read_answer(folder / "answer.txt", decomposition);
}

}  // namespace anticrack::witness
