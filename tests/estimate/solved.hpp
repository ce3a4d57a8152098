// SPDX-License-Identifier: GPL-3.0-or-later
//
// A solved random membrane as a flux sees it, and the same twice as fine.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "estimate/cut_mesh.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "fem/triangle_rules.hpp"
#include "mesh/edges.hpp"
#include "mesh/refine_uniform.hpp"
#include "operators/mesh_parts.hpp"
#include "reference/random_laws.hpp"
#include "reference/random_membrane.hpp"
#include "support/silent_observer.hpp"

namespace anticrack::estimate {

struct Solved {
  std::shared_ptr<const mesh::Mesh> mesh;
  operators::MeshOperator::Parts parts;
  const CutMesh cut;
  operators::LoadOnTraces load;
  contact::Answer answer;
  std::vector<double> u, force, traction;

  /// The force has a value for each triangle or, linear between them, for each node; the traction
  /// is constant.
  Solved(const mesh::Mesh& given, fem::Load full, const std::vector<double>& values)
      : mesh(std::make_shared<const mesh::Mesh>(given)),
        parts(mesh, 1, operators::default_condensed_up_to),
        cut(cut_mesh(*mesh, parts.decomposition, 20)) {  // several blocks, and fans between them
    const bool by_triangle = values.size() == mesh->triangle_count();
    full.force = fem::Array{"", by_triangle, std::make_shared<const std::vector<double>>(values)};
    const fem::Load* const one[] = {&full};
    auto condensed = operators::condense_loads(one, *mesh, parts.decomposition, parts.condense(),
                                               parts.neumann, true);
    if (const auto* error = std::get_if<errors::Error>(&condensed.front()))
      throw errors::Error(*error);
    load = std::get<operators::LoadOnTraces>(std::move(condensed.front()));
    testing::Silent silent;
    answer = contact::solve_active_set(*parts.contact, *mesh, loads(), {}, true, silent);
    for (const contact::Field& field : answer.fields)
      u.insert(u.end(), field.u.begin(), field.u.end());
    for (std::size_t t = 0; t < cut.triangle.size(); ++t) {
      const auto triangle = at(cut.triangle[t]);
      for (std::size_t i = 0; i < 3; ++i) {
        const auto value = [&](std::size_t k) {
          return by_triangle ? values[triangle] : values[at(mesh->triangles[3 * triangle + k % 3])];
        };
        force.push_back(area(t) / 12 * (2 * value(i) + value(i + 1) + value(i + 2)));
      }
    }
    for (const fem::TractionParts& part : load.parts.traction)
      traction.insert(traction.end(), part.load.begin(), part.load.end());
  }

  contact::CaseLoads loads() const { return {load.subdomains, load.inclusion_forces}; }
  Balance balance() const { return {u, force, traction}; }
  bool converged() const { return answer.status == contact::Status::converged; }

  double area(std::size_t t) const { return mesh::area(*mesh, at(cut.triangle[t])); }
  double tension(std::size_t t) const { return cut.shapes.tension[t]; }
  /// After the map of the tension, which is constant in a subdomain.
  Vector place(std::size_t corner) const {
    const Vector& x = cut.at[at(cut.copy[corner])];
    const auto subdomain = at(mesh->subdomain[at(cut.triangle[corner / 3])]);
    return parts.decomposition.subdomains[subdomain].tension.isotropic(0)(x[0], x[1]);
  }
  /// Outward, as long as the side.
  Vector normal(std::size_t side) const {
    const std::size_t t = side / 3, i = side % 3;
    const Vector p = place(3 * t + (i + 1) % 3), q = place(3 * t + (i + 2) % 3);
    return {q[1] - p[1], p[0] - q[0]};
  }
  /// Of values in the copies.
  Vector gradient(std::size_t t, const std::vector<double>& values) const {
    Vector result{};
    for (std::size_t i = 3 * t; i < 3 * t + 3; ++i)
      for (std::size_t d = 0; d < 2; ++d)
        result[d] -= values[at(cut.copy[i])] / (2 * area(t)) * normal(i)[d];
    return result;
  }
  double jump(const std::vector<double>& values, const Face& face, std::size_t end) const {
    return values[at(cut.ends(cut.faces[at(face.other)])[1 - end])] -
           values[at(cut.ends(face)[end])];
  }
};

inline std::array<double, 3> barycentric(const Solved& in, std::size_t t, const Vector& x) {
  std::array<double, 3> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector p = in.place(3 * t + (i + 1) % 3), normal = in.normal(3 * t + i);
    result[i] = -(normal[0] * (x[0] - p[0]) + normal[1] * (x[1] - p[1])) / (2 * in.area(t));
  }
  return result;
}

/// 0 but on one side of a line through the middles of two edges of the Dirichlet boundary: linear
/// along the edges of finer meshes, and not along these two.
inline std::string kink(const mesh::Mesh& mesh) {
  const auto middle = [&](std::size_t k, std::size_t axis) {
    const auto& [a, b] = mesh.dirichlet[k];
    return (mesh.xy[2 * at(a) + axis] + mesh.xy[2 * at(b) + axis]) / 2;
  };
  const std::size_t last = mesh.dirichlet.size() / 2;
  const double x = middle(0, 0), y = middle(0, 1), along_x = middle(last, 0) - x,
               along_y = middle(last, 1) - y;
  return fmt::format(" + max(0, {:.17g}*(x - {:.17g}) - {:.17g}*(y - {:.17g}))", along_y / 9, x,
                     along_x / 9, y);
}

/// Multiplies the tension of each subdomain by a power of ten, so that they differ by up to so many
/// decades.
template <class Membrane>
void add_contrast(Membrane& membrane, double decades, mesh::Mesh& mesh) {
  if (decades == 0) return;
  for (double& tension : mesh.tension)
    tension *= std::pow(10, membrane.uniform(-decades / 2, decades / 2));
}

/// A random membrane and one cut into four of each triangle, loaded alike; none where nothing
/// holds a part or nothing solves it.
struct Nested {
  std::optional<Solved> coarse, fine;
  fem::Load load;             // but for its force
  std::vector<double> force;  // on the coarse one

  Nested(unsigned seed, bool rich, double decades = 0) {
    reference::RandomMembrane membrane(seed, rich);
    mesh::Mesh mesh = membrane.mesh();
    if (seed % 3 == 0 && decades == 0) reference::add_laws(membrane, false, mesh);
    add_contrast(membrane, decades, mesh);
    const mesh::Mesh finer = mesh::refine_uniform(mesh);
    std::vector<double> finer_force;
    if (seed % 2 == 0) {
      for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        force.push_back(membrane.uniform(-1, 1));
        finer_force.insert(finer_force.end(), 4, force.back());
      }
    } else {
      for (std::size_t i = 0; i < mesh.node_count(); ++i) force.push_back(membrane.uniform(-1, 1));
      finer_force = force;
      mesh::EdgeTable(mesh.triangles).each([&](std::span<const mesh::EdgeUse> uses) {
        finer_force.push_back(0.5 * (force[at(uses[0].low())] + force[at(uses[0].high())]));
      });
    }
    load.name = "random";
    load.boundary_value = std::to_string(membrane.uniform(-1, 1)) + "*x - 0.4*y";
    const std::string traction = std::to_string(membrane.uniform(-1, 1));
    if (reference::has_neumann(mesh)) load.traction = traction;
    const std::vector<char> tilts = reference::tilting(mesh);
    for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
      load.inclusion_forces[mesh.inclusions[j]] = membrane.uniform(-3, 3);
      if (tilts[j] != 0)
        load.inclusion_moments[mesh.inclusions[j]] = {membrane.uniform(-1, 1),
                                                      membrane.uniform(-1, 1)};
    }
    try {
      coarse.emplace(mesh, load, force);
      fine.emplace(finer, load, finer_force);
    } catch (const errors::Error&) {
    }
  }

  bool solved() const { return coarse && fine && coarse->converged() && fine->converged(); }

  /// Triangle of the coarse membrane that has a triangle of the fine one.
  std::vector<std::size_t> parents() const {
    std::vector<std::size_t> number(coarse->cut.triangle_count()), parents;
    for (std::size_t t = 0; t < number.size(); ++t) number[at(coarse->cut.triangle[t])] = t;
    for (const std::int32_t triangle : fine->cut.triangle)
      parents.push_back(number[at(triangle) / 4]);
    return parents;
  }
};

/// Calls each(t, in, place, weight) in points of triangle t of the fine membrane, which is a part
/// of triangle `in` of the coarse one; exact for degree 5.
template <class Each>
void integrate(const Nested& nested, const Each& each) {
  const std::vector<std::size_t> parents = nested.parents();
  const Solved &coarse = *nested.coarse, &fine = *nested.fine;
  for (std::size_t t = 0; t < parents.size(); ++t) {
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double b = fem::rule_5.b[p], c = fem::rule_5.c[p];
      Vector x{};
      for (std::size_t d = 0; d < 2; ++d)
        x[d] = (1 - b - c) * fine.place(3 * t)[d] + b * fine.place(3 * t + 1)[d] +
               c * fine.place(3 * t + 2)[d];
      each(t, parents[t], barycentric(coarse, parents[t], x), fine.area(t) * fem::rule_5.weight[p]);
    }
  }
}

/// int p [u] of the pressure of a flux of the coarse membrane and the jumps of the fine one.
inline double work_of_pressure(const Nested& nested, const EquilibratedFlux& flux) {
  const std::vector<std::size_t> parents = nested.parents();
  const Solved &coarse = *nested.coarse, &fine = *nested.fine;
  double sum = 0;
  for (const Face& face : fine.cut.faces) {
    if (!presses(face.condition)) continue;
    const std::size_t t = at(face.side / 3), i = at(face.side % 3);
    for (std::size_t f = 0; f < coarse.cut.faces.size(); ++f) {
      const Face& whole = coarse.cut.faces[f];
      if (at(whole.side / 3) != parents[t] || !presses(whole.condition)) continue;
      // Half of it, if both ends lie on it.
      const auto off = [&](std::size_t end) {
        return std::abs(barycentric(coarse, parents[t],
                                    fine.place(3 * t + (i + 1 + end) % 3))[at(whole.side % 3)]);
      };
      if (off(0) + off(1) > 1e-9) continue;
      const double through = flux.through_faces()[2 * f] + flux.through_faces()[2 * f + 1];
      sum -= through * (fine.jump(fine.u, face, 0) + fine.jump(fine.u, face, 1)) / 4;
    }
  }
  return sum;
}

}  // namespace anticrack::estimate
