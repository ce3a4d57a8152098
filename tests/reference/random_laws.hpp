// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "mesh/mesh.hpp"
#include "reference/random_membrane.hpp"

namespace anticrack::reference {

/// A law for some of the subdomains: constant, `varies`: also smooth, and with a jump.
inline void add_laws(RandomMembrane& membrane, bool varies, mesh::Mesh& mesh) {
  mesh.tension_laws.resize(mesh.subdomains.size());
  const auto number = [&](double low, double high) {
    return std::to_string(membrane.uniform(low, high));
  };
  for (mesh::TensionLaw& law : mesh.tension_laws) {
    const double which = membrane.uniform(0, varies ? 5 : 2);
    if (which < 0.5) continue;
    law = {number(0.3, 3), number(0.3, 3), membrane.uniform(-180, 180)};
    if (which > 2) law.along += " + " + number(0, 1) + "*sin(" + number(0.1, 1) + "*x + y)^2";
    if (which > 3) law.across = "exp(" + number(-0.2, 0.2) + "*x) + " + number(0, 0.02) + "*y^2";
    if (which > 4) law.along = "x + 0.3*y > " + number(1, 5) + " ? 1.5 : 0.4";
  }
}

}  // namespace anticrack::reference
