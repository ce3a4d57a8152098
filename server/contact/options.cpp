// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/options.hpp"

#include <fmt/core.h>

#include <cmath>

#include "errors/errors.hpp"

namespace anticrack::contact {
namespace {

template <class Value>
void require(bool holds, const char* field, Value value, const std::string& cure) {
  if (!holds) {
    throw errors::Error(errors::Reason::invalid_argument, "{} is {}; it must be {}", field, value,
                        cure)
        .at(field);
  }
}

void check_options(const UzawaOptions& options, int iteration_limit) {
  if (options.theta) {
    require(std::isfinite(*options.theta) && *options.theta > 0, "theta", *options.theta,
            "a finite number above 0, or auto");
  }
  require(std::isfinite(options.epsilon) && options.epsilon > 0, "epsilon", options.epsilon,
          "a finite number above 0");
  require(std::isfinite(options.p) && options.p >= 0, "p", options.p, "finite and not negative");
  require(options.max_iterations >= 1 && options.max_iterations <= iteration_limit,
          "max_iterations", options.max_iterations, fmt::format("from 1 to {}", iteration_limit));
  if (options.kkt_tolerance) {
    require(std::isfinite(*options.kkt_tolerance) && *options.kkt_tolerance > 0, "kkt_tolerance",
            *options.kkt_tolerance, "a finite number above 0");
  }
}

void check_options(const ActiveSetOptions& options, int iteration_limit) {
  require(options.tolerance >= 0 && options.tolerance <= 1e-3, "tolerance", options.tolerance,
          "from 0 to 1e-3");
  require(options.max_steps >= 1 && options.max_steps <= iteration_limit, "max_steps",
          options.max_steps, "from 1 to " + std::to_string(iteration_limit));
}

}  // namespace

void check(const SolverOptions& options, int iteration_limit) {
  try {
    std::visit([&](const auto& of_method) { check_options(of_method, iteration_limit); }, options);
  } catch (errors::Error& error) {
    error.below(std::holds_alternative<UzawaOptions>(options) ? "uzawa" : "active_set");
    throw;
  }
}

}  // namespace anticrack::contact
