// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/grading.hpp"

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "errors/errors.hpp"
#include "mesh/quality.hpp"
#include "mesh/refine.hpp"

namespace anticrack::mesher {
namespace {

/// Below this bound, in degrees, the smallest tip size grows as the bound falls.
constexpr double sound_angle = 10;

/// How far rounding of midpoints may push an angle below the bound at the smallest tip size.
constexpr double angle_slack = 0.05;

/// A field of mesh::Grading as the user knows it.
std::string option_of(const std::string& field) {
  if (field == "h0") return "options.size";
  if (field == "m") return "options.grading";
  return "options." + field;
}

[[noreturn]] void rethrow_in_options(const errors::Error& error) {
  errors::Error renamed(error.reason(), error.what());
  for (const errors::FieldViolation& violation : error.fields()) {
    renamed.at(option_of(violation.field));
  }
  throw errors::Error(renamed);
}

[[noreturn]] void refuse_count(std::size_t base_triangles, const mesh::GradingSpec& spec,
                               std::size_t tip_count, std::size_t limit) {
  std::ostringstream text;
  text << "options.size = " << spec.h0;
  if (spec.m < 1) text << " with options.grading = " << spec.m;
  text << " takes more than the " << limit << " triangles allowed, from a base mesh of "
       << base_triangles << " and towards " << tip_count
       << " tips; raise options.size (twice the size takes a quarter of the triangles)";
  if (spec.m < 1) text << ", or options.tip_size if there are many tips";
  errors::Error error(errors::Reason::limit_exceeded, text.str());
  error.at("options.size");
  if (spec.m < 1) error.at("options.tip_size");
  throw errors::Error(error);
}

[[noreturn]] void refuse_tip_size(double tip_size, double smallest, double bound) {
  std::ostringstream text;
  text << "options.tip_size is " << tip_size
       << "; the base mesh has angles so small (bisection may "
       << "make one of " << bound << " degrees) that " << smallest
       << " is the least that keeps its triangles in shape";
  throw errors::Error(errors::Reason::invalid_argument, text.str()).at("options.tip_size");
}

mesh::Mesh bisected(const mesh::Mesh& base, const std::vector<std::int32_t>& tips,
                    const mesh::GradingSpec& spec, double bound, std::size_t max_triangles) {
  mesh::Grading grading{spec.h0, spec.m, spec.tip_size};
  if (bound > 0 && bound < sound_angle) {
    const double smallest = mesh::smallest_tip_size(base, tips) * (sound_angle / bound);
    if (grading.tip_size == 0) grading.tip_size = smallest;
    if (grading.tip_size < smallest) refuse_tip_size(grading.tip_size, smallest, bound);
  }
  try {
    return mesh::grade(base, tips, grading, max_triangles);
  } catch (const errors::Error& error) {
    if (error.reason() == errors::Reason::limit_exceeded) {
      refuse_count(base.triangle_count(), spec, tips.size(), max_triangles);
    }
    rethrow_in_options(error);
  }
}

}  // namespace

mesh::Mesh graded(mesh::Mesh base, const mesh::GradingSpec& spec, std::size_t max_triangles) {
  if (spec.h0 == 0) return base;
  const double bound = mesh::bisection_bound(base);
  const std::vector<std::int32_t> tips =
      spec.m < 1 ? mesh::tips(base) : std::vector<std::int32_t>();
  mesh::Mesh fine = bisected(base, tips, spec, bound, max_triangles);
  fine.bisection_bound = bound;
  if (const double angle = mesh::minimum_angle(fine); !(angle >= bound * (1 - angle_slack))) {
    std::ostringstream text;
    text << "grading made an angle of " << angle << " degrees, below its bound of " << bound
         << "; choose a larger options.tip_size, and report this mesh";
    throw errors::Error(errors::Reason::internal, text.str());
  }
  return fine;
}

mesh::Mesh graded(mesh::Mesh base, const mesh::MeshOptions& options, std::size_t max_triangles) {
  if (options.preset == mesh::Preset::graded) {
    const double h0 = options.size > 0 ? options.size : mesh::quality(base).largest_diameter;
    return graded(std::move(base), {h0, options.grading, options.tip_size}, max_triangles);
  }
  return graded(std::move(base), {options.size, 1, 0}, max_triangles);
}

}  // namespace anticrack::mesher
