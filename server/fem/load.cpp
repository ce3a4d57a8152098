// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/load.hpp"

#include <fmt/core.h>

#include <cmath>

#include "errors/errors.hpp"
#include "expression/parse.hpp"

namespace anticrack::fem {
namespace {

void require_finite(double value, const std::string& field, const char* what = "the force") {
  if (!std::isfinite(value)) {
    throw errors::Error(errors::Reason::invalid_argument, "{} is {}; it must be finite", what,
                        value)
        .at(field);
  }
}

void require_count(std::size_t count, std::size_t limit, const char* what,
                   const std::string& field) {
  if (count > limit) {
    throw errors::Error(errors::Reason::limit_exceeded, "{} {}: a load case may have {}", count,
                        what, limit)
        .at(field);
  }
}

void require_expression(const std::string& text, const std::string& field, std::size_t max_bytes) {
  require_length(text, field, max_bytes);
  expression::parse(text, field);
}

struct CheckForce {
  std::size_t max_expression_bytes;

  void operator()(double value) const { require_finite(value, "force.constant"); }
  void operator()(const Expression& expression) const {
    require_expression(expression.text, "force.expression", max_expression_bytes);
  }
  void operator()(const PerRegion& regions) const {
    require_count(regions.values.size(), max_named_forces, "regions", "force.per_region");
    for (const auto& [name, value] : regions.values)
      require_finite(value, "force.per_region[" + name + "]");
  }
  void operator()(const Array& array) const {
    if (array.upload.empty()) {
      throw errors::Error(errors::Reason::invalid_argument,
                          "the array of the force is not named; upload its values first")
          .at("force.array.upload");
    }
  }
};

void check_point_forces(const std::vector<PointForce>& forces) {
  require_count(forces.size(), max_point_forces, "point forces", "point_forces");
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const std::string field = fmt::format("point_forces[{}]", i);
    require_finite(forces[i].x, field + ".at", "x");
    require_finite(forces[i].y, field + ".at", "y");
    require_finite(forces[i].value, field + ".value");
  }
}

}  // namespace

void require_length(const std::string& text, const std::string& field, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return;
  throw errors::Error(errors::Reason::expression_invalid,
                      "the expression is {} bytes long; at most {} are allowed", text.size(),
                      max_bytes)
      .at(field);
}

void check(const Load& load, std::size_t max_expression_bytes) {
  std::visit(CheckForce{max_expression_bytes}, load.force);
  if (!load.boundary_value.empty())
    require_expression(load.boundary_value, "boundary_value", max_expression_bytes);
  if (!load.traction.empty()) require_expression(load.traction, "traction", max_expression_bytes);
  check_point_forces(load.point_forces);
  require_count(load.inclusion_forces.size(), max_named_forces, "forces on inclusions",
                "inclusion_forces");
  for (const auto& [name, value] : load.inclusion_forces)
    require_finite(value, "inclusion_forces[" + name + "]");
  require_count(load.inclusion_moments.size(), max_named_forces, "moments on inclusions",
                "inclusion_moments");
  for (const auto& [name, moment] : load.inclusion_moments) {
    require_finite(moment.x, "inclusion_moments[" + name + "]", "x of the moment");
    require_finite(moment.y, "inclusion_moments[" + name + "]", "y of the moment");
  }
}

}  // namespace anticrack::fem
