// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fem/load.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

struct ForceParts;
struct IntegrationReport;

/// Inputs and results of integration besides the values.
struct LoadContext {
  /// Mesh numbers of the subdomain's nodes and triangles: where its entries of an Array are.
  std::span<const std::int32_t> node = {};
  std::span<const std::int32_t> triangle = {};
  /// Receives how well an expression was integrated.
  IntegrationReport* report = nullptr;
  /// Receives the parts of an expression that is integrated (load_parts.hpp); of a force that is
  /// linear on every triangle nothing.
  ForceParts* parts = nullptr;
};

/// Tolerance of the load of an expression, relative to int |f| of the subdomain. The relative error
/// of linear elements is about 1 / triangles at best; this is a tenth of it, at most 1e-5.
constexpr double force_tolerance(std::size_t triangles) {
  return triangles > 10'000 ? 0.1 / static_cast<double>(triangles) : 1e-5;
}
/// Tolerance of a traction relative to int |g_N|.
constexpr double traction_tolerance = 1e-10;

/// b_i = int f phi_i dx for every node of a subdomain, shape (n). Constants and arrays exactly, an
/// expression that is linear exactly, any other adaptively (adaptive_load.hpp).
/// `region` is the subdomain's name. An Array has its values, as many as the mesh has nodes or
/// triangles, and the context's numbers point into them. Throws errors::Error (expression_invalid
/// where the expression is not finite, cancelled). O(m), about 7 evaluations a triangle where the
/// expression is smooth.
Eigen::VectorXd load_vector(const Triangulation& part, const Force& force,
                            const std::string& region, const LoadContext& context = {});

/// load_vector() of arrays given at the nodes of the mesh, a column for each, shape (n, arrays):
/// the same bits, at less than half the time for a dozen, because triangles are walked for several
/// at once. `arrays`: as many values as the mesh has nodes; `node` as in LoadContext. O(m arrays).
Eigen::MatrixXd load_vectors(const Triangulation& part, std::span<const std::int32_t> node,
                             std::span<const double* const> arrays);

/// Whether an expression is a polynomial of degree 0 or 1; empty text is 0. Throws errors::Error
/// (expression_invalid).
bool is_linear(const std::string& text);

/// An expression at points (n,2) row-major, shape (n). Throws errors::Error (expression_invalid
/// where it is not finite).
std::vector<double> values_at(std::span<const double> xy, const std::string& text,
                              const std::string& field);

/// g_D at `count` nodes from number `first` on, shape (count); an empty text is 0. Throws
/// errors::Error (expression_invalid at "boundary_value").
Eigen::VectorXd boundary_values(const Triangulation& part, const std::string& text,
                                std::size_t first, std::size_t count);

}  // namespace anticrack::fem
