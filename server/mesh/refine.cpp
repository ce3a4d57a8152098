// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/refine.hpp"

#include <limits>
#include <sstream>

#include "errors/errors.hpp"
#include "mesh/bisection.hpp"
#include "mesh/edges.hpp"
#include "mesh/midpoints.hpp"
#include "mesh/size_rule.hpp"

namespace anticrack::mesh {
namespace {

constexpr auto index_limit = at(std::numeric_limits<std::int32_t>::max());

[[noreturn]] void refuse_count(const Mesh& base, const Grading& grading, std::size_t limit) {
  std::ostringstream text;
  text << "grading " << base.triangle_count() << " triangles to h0 = " << grading.h0
       << ", m = " << grading.m << " takes more than the " << limit
       << " triangles allowed; raise h0 (twice the size takes a quarter of the triangles), m or "
          "tip_size, or the limit";
  throw errors::Error(errors::Reason::limit_exceeded, text.str()).at("h0");
}

}  // namespace

Mesh grade(const Mesh& base, const Grading& grading, std::size_t max_triangles) {
  return grade(base, tips(base), grading, max_triangles);
}

Mesh grade(const Mesh& base, std::span<const std::int32_t> centres, const Grading& grading,
           std::size_t max_triangles) {
  const SizeRule rule(base, centres, grading);
  if (base.triangle_count() > max_triangles) refuse_count(base, grading, max_triangles);
  Bisection mesh(base, std::min(max_triangles, index_limit));
  // One pass suffices: children of a small enough triangle are small enough, new ones come last.
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    while (rule.too_large(mesh.corners(t)))
      if (!mesh.bisect(t)) refuse_count(base, grading, max_triangles);
  }
  return std::move(mesh).finish();
}

Mesh refine_uniform(const Mesh& base) {
  if (base.triangle_count() > index_limit / 12) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "four times " + std::to_string(base.triangle_count()) +
                            " triangles do not fit 32-bit indices; refine a coarser mesh");
  }
  Mesh mesh = base;
  std::vector<std::array<std::int32_t, 2>> parents;
  const auto first = static_cast<std::int32_t>(base.node_count());
  EdgeTable(base.triangles).each([&](std::span<const EdgeUse> uses) {
    const auto [ax, ay] = position(base, uses[0].low());
    const auto [bx, by] = position(base, uses[0].high());
    mesh.xy.push_back(0.5 * (ax + bx));
    mesh.xy.push_back(0.5 * (ay + by));
    parents.push_back({uses[0].low(), uses[0].high()});
  });
  const Midpoints midpoints(first, parents);

  mesh.triangles.clear();
  mesh.subdomain.clear();
  for (std::size_t t = 0; t < base.triangle_count(); ++t) {
    const std::int32_t a = base.triangles[3 * t];
    const std::int32_t b = base.triangles[3 * t + 1];
    const std::int32_t c = base.triangles[3 * t + 2];
    const std::int32_t ab = midpoints.find(a, b);
    const std::int32_t bc = midpoints.find(b, c);
    const std::int32_t ca = midpoints.find(c, a);
    mesh.triangles.insert(mesh.triangles.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    mesh.subdomain.insert(mesh.subdomain.end(), 4, base.subdomain[t]);
  }
  cut_lines(mesh, midpoints);
  return mesh;
}

}  // namespace anticrack::mesh
