// SPDX-License-Identifier: GPL-3.0-or-later
//
// FreeFEM++ as a witness from outside: our mesh in its format, its answer in our numbers.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ddm/decomposition.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::witness {

/// Parameters of Algorithm 2 and the force, constant in each quadrant of the plane: lower left,
/// lower right, upper left, upper right.
struct Parameters {
  double theta = 2;
  double p = 1e5;
  int iterations = 1;
  std::array<double, 4> force{};
};

struct Answer {
  double a = 0;
  double criterion = 1;
  std::array<std::map<std::int32_t, double>, 2> u;  ///< per subdomain, by node of the mesh
};

/// Path of the program, or nothing where it is not installed.
std::optional<std::string> freefem();

/// Runs algorithm2.edp in `folder` (left full of its files). For a mesh with one interface between
/// subdomain 0 (Omega_1, minus) and 1 (Omega_2, plus), one delaminated inclusion and glue on it,
/// u = 0 on the outer boundary. Throws std::runtime_error with what FreeFEM++ printed where it
/// fails, or is not done within two minutes.
Answer run(const std::string& program, const std::filesystem::path& folder, const mesh::Mesh& mesh,
           const ddm::Decomposition& decomposition, const Parameters& parameters);

}  // namespace anticrack::witness
