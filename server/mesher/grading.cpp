// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/grading.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "mesh/quality.hpp"
#include "mesh/refine.hpp"
#include "mesher/messages.hpp"
#include "tips/singular.hpp"

namespace anticrack::mesher {
namespace {

/// Below this bound, in degrees, the smallest tip size grows as the bound falls.
constexpr double sound_angle = 10;

/// How far rounding of midpoints may push an angle below the bound at the smallest tip size.
constexpr double angle_slack = 0.05;

/// The default grading is this part of the least exponent of the solution at a tip, 0.2 of 1/4; but
/// not below `least_grading`, where the smallest triangles decide.
constexpr double below_exponent = 0.8, least_grading = 0.05;

/// The mesh option of a field of mesh::Grading.
std::string option_of(const std::string& field) {
  if (field == "h0") return "options.size";
  if (field == "m") return "options.grading";
  return "options." + field;
}

[[noreturn]] void refuse_count(std::size_t base_triangles, const mesh::GradingSpec& spec,
                               std::size_t tip_count, std::size_t limit) {
  const bool graded = spec.m < 1;
  const std::string text = fmt::format(
      "options.size = {:g}{} takes more than the {} triangles allowed, from a base mesh of {} and "
      "towards {} tips; raise options.size (twice the size takes a quarter of the triangles){}",
      spec.h0, graded ? fmt::format(" with options.grading = {:g}", spec.m) : "", limit,
      base_triangles, tip_count, graded ? ", or options.tip_size if there are many tips" : "");
  errors::Error error(errors::Reason::limit_exceeded, text);
  error.at("options.size");
  if (graded) error.at("options.tip_size");
  throw errors::Error(error);
}

[[noreturn]] void refuse_tip_size(double tip_size, double smallest, double bound) {
  throw errors::Error(errors::Reason::invalid_argument,
                      "options.tip_size is {:g}; the base mesh has such small angles "
                      "(bisection may make one of {:g} degrees) that at least {:g} is "
                      "needed to keep its triangles in shape",
                      tip_size, bound, smallest)
      .at("options.tip_size");
}

mesh::Mesh bisected(const mesh::Mesh& base, const std::vector<std::int32_t>& tips,
                    const mesh::GradingSpec& spec, double bound, std::size_t max_triangles) {
  mesh::Grading grading{spec.h0, spec.m, spec.tip_size, 0};
  if (bound > 0 && bound < sound_angle) {
    const double smallest = mesh::smallest_tip_size(base, tips) * (sound_angle / bound);
    if (grading.tip_size > 0 && grading.tip_size < smallest)
      refuse_tip_size(grading.tip_size, smallest, bound);
    grading.least_tip_size = smallest;
  }
  try {
    return mesh::grade(base, tips, grading, max_triangles);
  } catch (errors::Error& error) {
    if (error.reason() == errors::Reason::limit_exceeded)
      refuse_count(base.triangle_count(), spec, tips.size(), max_triangles);
    error.rename(option_of);
    throw;
  }
}

}  // namespace

mesh::Mesh graded(mesh::Mesh base, const mesh::GradingSpec& asked, std::size_t max_triangles) {
  if (asked.h0 == 0) return base;
  mesh::GradingSpec spec = asked;
  if (spec.m == mesh::GradingSpec().m)
    spec.m = std::clamp(below_exponent * tips::least_exponent(base), least_grading, spec.m);
  const double bound = mesh::bisection_bound(base);
  const std::vector<std::int32_t> tips =
      spec.m < 1 ? mesh::tips(base) : std::vector<std::int32_t>();
  mesh::Mesh fine = bisected(base, tips, spec, bound, max_triangles);
  if (const double angle = mesh::minimum_angle(fine); !(angle >= bound * (1 - angle_slack))) {
    throw errors::Error(errors::Reason::internal,
                        "grading made an angle of {:g} degrees, below its bound of {:g}; "
                        "choose a larger options.tip_size, and report this mesh",
                        angle, bound);
  }
  return fine;
}

mesh::Mesh graded(mesh::Mesh base, const mesh::MeshOptions& options, std::size_t max_triangles) {
  if (mesh::graded(options.preset)) {
    const double h0 = options.size > 0 ? options.size : mesh::longest_edge(base);
    return graded(std::move(base), {h0, options.grading, options.tip_size}, max_triangles);
  }
  return graded(std::move(base), {options.size, 1, 0}, max_triangles);
}

}  // namespace anticrack::mesher
