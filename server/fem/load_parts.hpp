// SPDX-License-Identifier: GPL-3.0-or-later
//
// A load triangle by triangle, which an equilibrated flux has to balance.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fem/load.hpp"
#include "fem/load_vector.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// First zero of the Bessel function J_1: |v - mean v| <= diameter / j_11 |grad v| on a triangle
/// (Laugesen & Siudeja, 2009).
inline constexpr double j_11 = 3.8317059702075123;

/// f on the triangles K of a subdomain.
struct ForceParts {
  std::vector<double> load;  ///< (m,3) int_K f phi_i for the corners i, as in the load vector
  /// (m) >= |f - f_h| in the L2 norm, where f_h is the linear function with that load; or a number
  /// that bounds the effect of f - f_h as such a norm would (fem/load_proof.cpp). Empty: f is
  /// linear on every triangle.
  std::vector<double> beyond;
  std::vector<double> unknown;  ///< (m) >= |int_K (f - f_h)|; empty: 0
  /// (m) >= |int_K (f - f_h) z| for linear z with |z| <= 1; as long as `unknown`.
  std::vector<double> moments;
};

/// g_N on the edges of the Neumann boundary of a subdomain.
struct TractionParts {
  std::vector<double> load;     ///< (edges,2) int g phi_i for both ends
  std::vector<double> beyond;   ///< (edges) >= |g - g_h| in the L2 norm, g_h the mean of that load
  std::vector<double> unknown;  ///< (edges) >= |int (g - g_h)|
};

/// Writes ForceParts::load to `room()`, (m,3), of a force that is linear on every triangle: a
/// constant, an array, an expression of degree 0 or 1. Returns false for any other force, whose
/// parts load_vector() gives (LoadContext::parts). `only`: the triangles whose values are written,
/// each once; unset: all. O(m), on base::Threads.
bool linear_load(const Triangulation& part, const Force& force, const std::string& region,
                 const LoadContext& context, const std::function<double*()>& room,
                 std::optional<std::span<const std::int32_t>> only = std::nullopt);

}  // namespace anticrack::fem
