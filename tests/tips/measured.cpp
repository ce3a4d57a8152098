// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/measured.hpp"

#include <fmt/core.h>

#include <cmath>
#include <stdexcept>

#include "contact/options.hpp"
#include "fem/load_parts.hpp"
#include "mesh/refine.hpp"
#include "support/silent_observer.hpp"
#include "support/structured_mesh.hpp"

namespace anticrack::testing {

mesh::Mesh cut_square(const std::function<mesh::Kind(double)>& kind) {
  StructuredOptions options;
  options.columns = 8;
  options.kind = kind;
  mesh::Mesh mesh = structured_mesh(options);
  bool rigid = false;
  for (const std::int32_t inclusion : mesh.interfaces[0].inclusion) rigid = rigid || inclusion >= 0;
  if (!rigid) mesh.inclusions.clear();
  return mesh;
}

mesh::Mesh cut_square(mesh::Kind inside, mesh::Kind outside) {
  return cut_square([=](double x) { return std::abs(x) < 0.5 ? inside : outside; });
}

mesh::Mesh fine(const mesh::Mesh& base, double m) {
  constexpr std::size_t wanted = 12'000, most = 1'000'000;
  for (double h0 = 0.2 * mesh::characteristic_length(base);; h0 *= 0.95) {
    mesh::Mesh mesh = mesh::grade(base, {h0, m, 0}, most);
    if (mesh.triangle_count() > wanted) return mesh;
  }
}

mesh::Mesh tilting(mesh::Mesh mesh) {
  mesh.motions.assign(mesh.inclusions.size(), {true, {}});
  return mesh;
}

const contact::TipAnswer& Measured::tip(double x, double y) const {
  for (const contact::TipAnswer& tip : answer.tips)
    if (std::hypot(tip.x - x, tip.y - y) < 1e-9) return tip;
  throw std::runtime_error(fmt::format("no tip at {}, {}", x, y));
}

Measured measure(std::shared_ptr<const operators::MeshOperator> op, const fem::Load& load,
                 bool fields) {
  const fem::Load* const one[] = {&load};
  auto outcome = std::move(op->prepare(one).front());
  if (const auto* error = std::get_if<errors::Error>(&outcome)) throw errors::Error(*error);
  const auto& prepared = std::get<operators::PreparedLoad>(outcome);
  Silent silent;
  Measured measured{op, op->solve(prepared, contact::ActiveSetOptions{}, fields, silent)};
  op->find_tips(prepared, measured.answer);
  return measured;
}

Measured measure(mesh::Mesh mesh, const fem::Load& load, bool fields) {
  return measure(operators::MeshOperator::factorise(
                     std::make_shared<const mesh::Mesh>(std::move(mesh)), 2, {}),
                 load, fields);
}

Prepared::Prepared(mesh::Mesh mesh, const mesh::Mesh& believed)
    : _mesh(std::move(mesh)), _decomposition(ddm::cut(_mesh)), _tips(believed, _decomposition) {}

tips::Integrals Prepared::integrals(std::size_t tip, const contact::Answer& answer,
                                    const fem::Force& force) const {
  std::vector<fem::ForceParts> parts(_decomposition.subdomains.size());
  std::vector<std::span<const double>> loads;
  for (std::size_t s = 0; s < parts.size(); ++s) {
    const ddm::Subdomain& one = _decomposition.subdomains[s];
    const fem::LoadContext context{one.node, one.triangle, nullptr, &parts[s]};
    const auto room = [&] {
      parts[s].load.resize(one.part.triangles.size());
      return parts[s].load.data();
    };
    if (!fem::linear_load(one.part, force, one.name, context, room))
      fem::load_vector(one.part, force, one.name, context);
    loads.emplace_back(parts[s].load);
  }
  return _tips.integrals(tip, {answer, loads, {}});
}

fem::Load with_boundary(const std::string& text) {
  fem::Load load;
  load.name = "case";
  load.boundary_value = text;
  return load;
}

std::string text_of(double value) { return fmt::format("({:.17g})", value); }

Power::Power(double p, double q, const std::string& x, const std::string& y) {
  const auto size = [&](double shift, double power) {
    return fmt::format("((({0}{1:+g})^2 + ({2})^2)^{3})", x, shift, y, text_of(power / 2));
  };
  const auto angle = [&](double shift, double power) {
    return fmt::format("{3}*atan2({2}, {0}{1:+g})", x, shift, y, text_of(power));
  };
  _size = size(0.5, p) + "*" + size(-0.5, q);
  _angle = angle(0.5, p) + " + " + angle(-0.5, q);
}

std::string Power::turned(double angle) const {
  return fmt::format("({}*cos({} + {}))", _size, text_of(angle), _angle);
}

}  // namespace anticrack::testing
