// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <string>

#include "fem/triangulation.hpp"

namespace anticrack::fem {

/// Adds int g_N phi_i ds over `edges` (pairs of the subdomain's nodes) to load_i, shape (n), for
/// g_N given as an expression. Right to 1e-10 of int |g_N|: edges are divided where a switch of the
/// expression changes (Tape::switches), then halved as long as that changes anything. Returns the
/// estimated error relative to int |g_N|: above 1e-10 only where a limit was met, infinite where
/// no estimate is possible because the integral may not exist.
/// Throws errors::Error (expression_invalid at "traction" where it is not finite, cancelled).
double add_traction(const Triangulation& part, std::span<const std::array<std::int32_t, 2>> edges,
                    const std::string& traction, Eigen::Ref<Eigen::VectorXd> load,
                    const std::stop_token& stop = {});

}  // namespace anticrack::fem
