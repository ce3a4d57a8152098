// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/tensor.hpp"

#include <cmath>
#include <numbers>

namespace anticrack::tips {

double root_of_determinant(const Tensor& t) { return std::sqrt(t[0] * t[2] - t[1] * t[1]); }

Law::Law(const mesh::Mesh& mesh, std::size_t subdomain) {
  if (!mesh.tension.empty()) _number = mesh.tension[subdomain];
  if (mesh.tension_laws.empty() || mesh.tension_laws[subdomain].along.empty()) return;
  const mesh::TensionLaw& law = mesh.tension_laws[subdomain];
  const auto take = [&](std::optional<expression::Function>& to, const std::string& text,
                        const char* field) {
    if (text.empty()) return;
    const expression::Tape& tape = to.emplace(text, field).tape();
    _varies = _varies || tape.degree(tape.result()) > 0;
    _may_jump = _may_jump || !tape.switches().empty();
  };
  take(_along, law.along, "along");
  take(_across, law.across, "across");
  const double angle = law.angle * std::numbers::pi / 180;
  _cosine = std::cos(angle);
  _sine = std::sin(angle);
}

Tensor Law::at(const Point& x) const {
  if (!_along) return {_number, 0, _number};
  const double along = (*_along)(x[0], x[1]), across = _across ? (*_across)(x[0], x[1]) : along;
  return {along * _cosine * _cosine + across * _sine * _sine, (along - across) * _cosine * _sine,
          along * _sine * _sine + across * _cosine * _cosine};
}

std::vector<Law> laws_of(const mesh::Mesh& mesh) {
  std::vector<Law> laws;
  for (std::size_t s = 0; s < mesh.subdomains.size(); ++s) laws.emplace_back(mesh, s);
  return laws;
}

}  // namespace anticrack::tips
