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

/// Further inputs and results of integration.
struct LoadContext {
  /// Mesh numbers of the subdomain's nodes and triangles: indices of its entries in an Array.
  std::span<const std::int32_t> node = {};
  std::span<const std::int32_t> triangle = {};
  /// Receives the accuracy with which an expression was integrated.
  IntegrationReport* report = nullptr;
  /// Receives the parts of an expression that is integrated (load_parts.hpp); stays empty for a
  /// force that is linear on every triangle.
  ForceParts* parts = nullptr;
};

/// Tolerance of the load of an expression, relative to int |f| of the subdomain. The relative error
/// of linear elements is about 1 / triangles at best; this is a tenth of it, at most 1e-5.
constexpr double force_tolerance(std::size_t triangles) {
  return triangles > 10'000 ? 0.1 / static_cast<double>(triangles) : 1e-5;
}
/// Tolerance of a traction relative to int |g_N|.
constexpr double traction_tolerance = 1e-10;

/// b_i = int f phi_i dx for every node of a subdomain, shape (n). Constants, arrays and linear
/// expressions are integrated exactly, other expressions adaptively (adaptive_load.hpp). `region`
/// is the subdomain's name. An Array must have its values, as many as the mesh has nodes or
/// triangles; the context's numbers are indices into them. Throws errors::Error (expression_invalid
/// if the expression is not finite, cancelled). O(m), with about 7 evaluations a triangle if the
/// expression is smooth.
Eigen::VectorXd load_vector(const Triangulation& part, const Force& force,
                            const std::string& region, const LoadContext& context = {});

/// load_vector() for arrays given at the nodes of the mesh, one column for each, shape (n, arrays).
/// The bits are the same, but a dozen take less than half the time, because several are integrated
/// in one pass over the triangles. `arrays`: each with as many values as the mesh has nodes;
/// `node`: as in LoadContext. O(m arrays).
Eigen::MatrixXd load_vectors(const Triangulation& part, std::span<const std::int32_t> node,
                             std::span<const double* const> arrays);

/// Whether an expression is a polynomial of degree 0 or 1; empty text is 0. Throws errors::Error
/// (expression_invalid).
bool is_linear(const std::string& text);

/// Values of an expression at points (n,2) row-major, shape (n). Throws errors::Error
/// (expression_invalid if one is not finite).
std::vector<double> values_at(std::span<const double> xy, const std::string& text,
                              const std::string& field);

/// g_D at `count` nodes from number `first` on, shape (count); an empty text is 0. Throws
/// errors::Error (expression_invalid at "boundary_value").
Eigen::VectorXd boundary_values(const Triangulation& part, const std::string& text,
                                std::size_t first, std::size_t count);

}  // namespace anticrack::fem
