// SPDX-License-Identifier: GPL-3.0-or-later
//
// Everything between a mesh and the iteration, kept open for tests.
#pragma once

#include <string>
#include <vector>

#include "contact/trace_problem.hpp"
#include "ddm/decomposition.hpp"
#include "ddm/subdomain_operator.hpp"
#include "fem/load_vector.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::testing {

struct TraceSpace {
  explicit TraceSpace(const mesh::Mesh& mesh) : decomposition(ddm::cut(mesh)) {
    for (const ddm::Subdomain& subdomain : decomposition.subdomains) {
      operators.emplace_back(subdomain);
    }
  }

  std::vector<ddm::CondensedLoad> condense(const fem::Force& force,
                                           const std::string& boundary = "") const {
    std::vector<ddm::CondensedLoad> loads;
    for (std::size_t s = 0; s < operators.size(); ++s) {
      const ddm::Subdomain& subdomain = decomposition.subdomains[s];
      loads.push_back(operators[s]
                          .condense(fem::load_vector(subdomain.part, force, subdomain.name),
                                    fem::boundary_values(subdomain.part, boundary, subdomain.free(),
                                                         subdomain.dirichlet))
                          .front());
    }
    return loads;
  }

  ddm::Decomposition decomposition;
  std::vector<ddm::SubdomainOperator> operators;
};

}  // namespace anticrack::testing
