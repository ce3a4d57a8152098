// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/decomposition.hpp"
#include "mesh/at.hpp"

namespace anticrack::ddm {

std::string uzawa_obstacle(const Decomposition& decomposition, const mesh::Mesh& mesh) {
  const std::string cure = "; use the method \"active-set\"";
  std::vector<const Subdomain*> owner(mesh.inclusions.size(), nullptr);
  for (const Subdomain& subdomain : decomposition.subdomains) {
    if (!subdomain.floating.empty()) {
      return "the subdomain \"" + subdomain.name +
             "\" has a part without Dirichlet nodes, so Algorithm 2 cannot solve on it alone" +
             cure;
    }
    for (const std::int32_t inclusion : subdomain.rigid) {
      if (inclusion < 0) continue;
      const auto j = at(inclusion);
      if (owner[j] != nullptr && owner[j] != &subdomain) {
        return "the plus side of the inclusion \"" + mesh.inclusions[j] +
               "\" lies in two subdomains, \"" + owner[j]->name + "\" and \"" + subdomain.name +
               "\", and Algorithm 2 projects on one" + cure;
      }
      owner[j] = &subdomain;
    }
  }
  return {};
}

}  // namespace anticrack::ddm
