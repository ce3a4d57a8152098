// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/our_mesh.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace anticrack::benchmarks {

PlainMesh to_plain(const mesh::Mesh& mesh) {
  if (std::any_of(mesh.tension.begin(), mesh.tension.end(), [](double t) { return t != 1; })) {
    throw std::runtime_error("a mesh of the benchmarks has tension 1");
  }
  PlainMesh plain{mesh.xy, mesh.triangles, mesh.subdomain, {}, {}};
  for (const auto& [a, b] : mesh.dirichlet) {
    plain.dirichlet.insert(plain.dirichlet.end(), {a, b});
  }
  for (const mesh::Interface& interface : mesh.interfaces) {
    PlainMesh::Chain chain{interface.nodes, {}, interface.inclusion};
    for (const mesh::Kind kind : interface.kind) {
      chain.kind.push_back(static_cast<std::int32_t>(kind));
    }
    plain.chains.push_back(std::move(chain));
  }
  return plain;
}

std::shared_ptr<const mesh::Mesh> to_mesh(const PlainMesh& plain) {
  const auto names = [](const std::string& stem, std::int32_t last) {
    std::vector<std::string> result;
    for (std::int32_t i = 0; i <= last; ++i) result.push_back(stem + std::to_string(i + 1));
    return result;
  };
  auto mesh = std::make_shared<mesh::Mesh>();
  mesh->xy = plain.xy;
  mesh->triangles = plain.triangles;
  mesh->subdomain = plain.subdomain;
  for (std::size_t e = 0; e + 1 < plain.dirichlet.size(); e += 2) {
    mesh->dirichlet.push_back({plain.dirichlet[e], plain.dirichlet[e + 1]});
  }
  std::int32_t last_inclusion = -1;
  for (const PlainMesh::Chain& chain : plain.chains) {
    mesh::Interface interface;
    interface.name = std::string("interface") + std::to_string(mesh->interfaces.size() + 1);
    interface.nodes = chain.nodes;
    interface.inclusion = chain.inclusion;
    for (const std::int32_t kind : chain.kind) {
      interface.kind.push_back(static_cast<mesh::Kind>(kind));
    }
    for (const std::int32_t j : chain.inclusion) last_inclusion = std::max(last_inclusion, j);
    mesh->interfaces.push_back(std::move(interface));
  }
  mesh->inclusions = names("inclusion", last_inclusion);
  mesh->subdomains =
      names("omega", *std::max_element(plain.subdomain.begin(), plain.subdomain.end()));
  mesh::validate(*mesh);
  return mesh;
}

fem::Load nodal_load(const PlainMesh& plain, int number) {
  fem::Load load;
  load.name = std::string("load ") + std::to_string(number);
  fem::Array array;
  array.values = std::make_shared<const std::vector<double>>(nodal_force(plain, number));
  load.force = std::move(array);
  return load;
}

}  // namespace anticrack::benchmarks
