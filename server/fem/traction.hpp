// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "fem/load_parts.hpp"
#include "fem/load_proof.hpp"
#include "fem/triangulation.hpp"

namespace anticrack::fem {

struct TractionReport {
  /// Estimate from the samples, relative to int |g_N|. It is above traction_tolerance only if the
  /// work was limited, and infinite if no estimate is possible because the integral may not exist.
  double relative_error_estimate = 0;
  Proof proof;
};

/// Adds int g_N phi_i ds over `edges` (pairs of the subdomain's nodes) to load_i, shape (n), for
/// g_N given as an expression. Edges are halved until the error is below traction_tolerance of
/// int |g_N|, towards jumps as far as numbers resolve. What the samples miss is added
/// (edge_proof.hpp). Throws errors::Error (expression_invalid at "traction" if it is not finite,
/// cancelled). `parts`, if given, receives the load edge by edge.
TractionReport add_traction(const Triangulation& part,
                            std::span<const std::array<std::int32_t, 2>> edges,
                            const std::string& traction, Eigen::Ref<Eigen::VectorXd> load,
                            TractionParts* parts = nullptr);

}  // namespace anticrack::fem
