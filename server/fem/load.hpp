// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loads on the membrane in one load case.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "fields/fields.hpp"

namespace anticrack::fem {

/// An expression in x and y (expression/parse.hpp), e.g. "y > 0 ? 1 : -1".
struct Expression {
  std::string text;
};
ANTICRACK_FIELDS(Expression, text)

/// A constant per subdomain, by name; a subdomain not named has 0.
struct PerRegion {
  std::map<std::string, double> values;
};
ANTICRACK_FIELDS(PerRegion, values)

/// A value per triangle (constant on it) or per node (linear between), in the order of the mesh.
struct Array {
  std::string upload = {};  ///< sha256 of the bytes the values came from
  bool per_triangle = false;
  /// Set when the load is solved; a job that waits has the name only.
  std::shared_ptr<const std::vector<double>> values = nullptr;
};
ANTICRACK_FIELDS(Array, upload, per_triangle, values)

/// f of equation (1): force per unit area, positive in the direction of u.
using Force = std::variant<double, Expression, PerRegion, Array>;

/// A force that acts in one point of the membrane.
struct PointForce {
  double x = 0;
  double y = 0;
  double value = 0;
};
ANTICRACK_FIELDS(PointForce, x, y, value)

/// A moment on an inclusion that tilts, about (x0, y0), the middle of the bounding box of its
/// nodes. Its work is x Bx + y By. A force F at a point p of the inclusion has the moment F (p -
/// (x0, y0)).
struct Moment {
  double x = 0;
  double y = 0;
};
ANTICRACK_FIELDS(Moment, x, y)

struct Load {
  std::string name;
  Force force = 0.0;
  std::string boundary_value = {};  ///< g_D on the Dirichlet boundary, an expression; empty: 0
  std::string traction = {};  ///< g_N = T du/dn on the Neumann boundary, an expression; empty: 0
  std::vector<PointForce> point_forces = {};
  std::map<std::string, double> inclusion_forces = {};   ///< by name of the inclusion
  std::map<std::string, Moment> inclusion_moments = {};  ///< by name of the inclusion, which tilts
};
ANTICRACK_FIELDS(Load, name, force, boundary_value, traction, point_forces, inclusion_forces,
                 inclusion_moments)

/// Most point forces of one load case.
constexpr std::size_t max_point_forces = 10'000;
/// Most regions of a PerRegion, inclusions with a force, and inclusions with a moment.
constexpr std::size_t max_named_forces = 1'000;

/// Why f of both cannot be one force: one is an array, or one is an expression and the other has a
/// value per region; empty: it can.
std::string obstacle_to_sum(const Force& dead, const Force& live);
/// dead + t live on a mesh with these subdomains, by the name of the latter; both without obstacle.
Load sum(const Load& dead, double t, const Load& live, const std::vector<std::string>& subdomains);

/// Throws errors::Error (expression_invalid) if a text is longer.
void require_length(const std::string& text, const std::string& field, std::size_t max_bytes);

/// Throws errors::Error (expression_invalid, invalid_argument, limit_exceeded) with the field at
/// fault: "force.expression", "force.per_region[NAME]", "force.constant", "force.array.upload",
/// "boundary_value", "traction", "point_forces[I].value", "inclusion_forces[NAME]",
/// "inclusion_moments[NAME]", ... Checks what can be checked without a mesh: syntax, symbols,
/// lengths, counts, finite values.
void check(const Load& load, std::size_t max_expression_bytes);

}  // namespace anticrack::fem
