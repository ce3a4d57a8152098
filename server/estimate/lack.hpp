// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a flux lacks of equilibrium. Made fan by fan from a u_h that solves its problem only to
// rounding or a little worse, a flux has the right divergence on every triangle, but
//
//   about a node off all faces the rest of the sum goes through one side of one spoke only,
//   the flux through faces that are given, may not be pulled, or have a partner is slightly wrong,
//   the flux out of a body is not quite the force on it.
//
// Each of these errors is an amount times a unit flux from a side, or off a body, and Ways lead it
// to a place where it may leave. So sigma + s is admissible with |s| <= Lack::flux. The bounds are
// those of sigma + s, of which only the norm of s has to be known.
#pragma once

#include <cmath>
#include <span>

#include "estimate/cut_mesh.hpp"
#include "estimate/equilibrated_flux.hpp"

namespace anticrack::estimate {

/// A force on an inclusion, and its moment about the inclusion's middle (ddm::RigidMotion::centre).
struct ForceOn {
  double force = 0;
  Vector moment{};
};

struct Lack {
  /// >= |s|; not finite if Ways lead nowhere.
  double flux = 0;
  /// |l(z) - a(u_h, z) - sum of w [z] over the ends of minus faces| <= work max |z|, z linear; w
  /// are the `reactions`, or without them the flux through the ends.
  double work = 0;
};

/// `traction`: as Balance::traction. `forces`: on each inclusion; empty: 0. `kept`: (faces) the
/// admissible part of the outward flux through a minus face. `reactions`: (faces, 2) the flux that
/// belongs to the ends of minus faces; empty: that of `flux`. O(faces).
Lack lack_of(const CutMesh& cut, const EquilibratedFlux& flux, std::span<const double> traction,
             std::span<const ForceOn> forces, std::span<const double> kept,
             std::span<const double> reactions = {});

/// `kept` for a pressure: the flux through each face, at most 0 on minus faces.
std::vector<double> pressing(const CutMesh& cut, const EquilibratedFlux& flux);

}  // namespace anticrack::estimate
