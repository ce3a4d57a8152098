// SPDX-License-Identifier: GPL-3.0-or-later
//
// What acts on the membrane in one load case.
#pragma once

#include <map>
#include <string>
#include <variant>

namespace anticrack::fem {

/// An expression in x and y (muParser syntax), e.g. "y > 0 ? 1 : -1".
struct Expression {
  std::string text;
};

/// A constant per subdomain, by name; a subdomain not named has 0.
struct PerRegion {
  std::map<std::string, double> values;
};

/// f of equation (1): force per unit area, positive in the direction of u.
using Force = std::variant<double, Expression, PerRegion>;

struct Load {
  std::string name;
  Force force = 0.0;
  std::string boundary_value;  ///< g_D on the Dirichlet boundary, an expression; empty: 0
};

/// Throws errors::Error (expression_invalid, invalid_argument) with the field at fault:
/// "force.expression", "force.per_region[NAME]", "force.constant", "boundary_value". Checks what
/// can be checked without a mesh: syntax, symbols, length, finite constants.
void check(const Load& load, std::size_t max_expression_bytes);

}  // namespace anticrack::fem
