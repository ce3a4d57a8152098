// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load.hpp"

#include <cmath>

#include "errors/errors.hpp"
#include "fem/expression.hpp"

namespace anticrack::fem {
namespace {

void require_finite(double value, const std::string& field) {
  if (!std::isfinite(value)) {
    throw errors::Error(errors::Reason::invalid_argument,
                        "the force is " + std::to_string(value) + "; it must be finite")
        .at(field);
  }
}

void require_expression(const std::string& text, const std::string& field, std::size_t max_bytes) {
  if (text.size() > max_bytes) {
    throw errors::Error(errors::Reason::expression_invalid,
                        "the expression is " + std::to_string(text.size()) +
                            " bytes long; at most " + std::to_string(max_bytes) + " are allowed")
        .at(field);
  }
  ExpressionFunction(text, field);
}

struct CheckForce {
  std::size_t max_expression_bytes;

  void operator()(double value) const { require_finite(value, "force.constant"); }
  void operator()(const Expression& expression) const {
    require_expression(expression.text, "force.expression", max_expression_bytes);
  }
  void operator()(const PerRegion& regions) const {
    for (const auto& [name, value] : regions.values) {
      require_finite(value, "force.per_region[" + name + "]");
    }
  }
};

}  // namespace

void check(const Load& load, std::size_t max_expression_bytes) {
  std::visit(CheckForce{max_expression_bytes}, load.force);
  if (!load.boundary_value.empty()) {
    require_expression(load.boundary_value, "boundary_value", max_expression_bytes);
  }
}

}  // namespace anticrack::fem
