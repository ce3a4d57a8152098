// SPDX-License-Identifier: GPL-3.0-or-later
//
// The tension as a symmetric matrix, where the means of fem::Tension over triangles do not do.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "expression/function.hpp"
#include "mesh/mesh.hpp"
#include "tips/course.hpp"

namespace anticrack::tips {

/// Txx, Txy, Tyy.
using Tensor = std::array<double, 3>;

/// T v.
inline Point product(const Tensor& t, const Point& v) {
  return {t[0] * v[0] + t[1] * v[1], t[1] * v[0] + t[2] * v[1]};
}
/// sqrt(det T).
double root_of_determinant(const Tensor& t);

/// T of a subdomain at points.
class Law {
 public:
  /// That of a mesh for one of its subdomains.
  Law(const mesh::Mesh& mesh, std::size_t subdomain);

  /// Throws errors::Error (expression_invalid) where an expression is not finite.
  Tensor at(const Point& x) const;
  bool varies() const noexcept { return _varies; }
  /// Whether an expression has places where it may jump or bend.
  bool may_jump() const noexcept { return _may_jump; }

 private:
  double _number = 1;
  std::optional<expression::Function> _along, _across;
  double _cosine = 1, _sine = 0;
  bool _varies = false, _may_jump = false;
};

/// Of all subdomains.
std::vector<Law> laws_of(const mesh::Mesh& mesh);

}  // namespace anticrack::tips
