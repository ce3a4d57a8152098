// SPDX-License-Identifier: GPL-3.0-or-later
//
// Tips of solutions in closed form on (-1,1)^2, a = 1/2, f = 0 unless a load says otherwise.
#pragma once

#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "ddm/decomposition.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"
#include "operators/mesh_operator.hpp"
#include "tips/tips.hpp"

namespace anticrack::testing {

/// Of the cracks, as open_crack() has it.
inline constexpr double shear = 0.8;

/// Squares of side 1/4 with one diagonal each, cut by y = 0; `kind` of the edge whose middle is x.
mesh::Mesh cut_square(const std::function<mesh::Kind(double)>& kind);
/// `inside` for |x| < 1/2, else `outside`.
mesh::Mesh cut_square(mesh::Kind inside, mesh::Kind outside = mesh::Kind::glue);
/// Graded to about 12,000 triangles, the default of a mesh, with the exponent m.
mesh::Mesh fine(const mesh::Mesh& base, double m = 0.2);
mesh::Mesh tilting(mesh::Mesh mesh);

struct Measured {
  std::shared_ptr<const operators::MeshOperator> op;
  contact::Answer answer;

  const contact::TipAnswer& tip(double x, double y = 0) const;
  const contact::TipAnswer& right() const { return tip(0.5); }
  const contact::TipAnswer& left() const { return tip(-0.5); }
};

Measured measure(std::shared_ptr<const operators::MeshOperator> op, const fem::Load& load,
                 bool fields = false);
Measured measure(mesh::Mesh mesh, const fem::Load& load, bool fields = false);
/// The integrals of tips of an answer with fields.
class Prepared {
 public:
  explicit Prepared(const mesh::Mesh& mesh) : Prepared(mesh, mesh) {}
  /// A mutant, which takes for the tension what `believed` has, but in the triangles what `mesh`
  /// has.
  Prepared(mesh::Mesh mesh, const mesh::Mesh& believed);

  tips::Integrals integrals(std::size_t tip, const contact::Answer& answer,
                            const fem::Force& force) const;

 private:
  mesh::Mesh _mesh;
  ddm::Decomposition _decomposition;
  tips::Tips _tips;
};

/// f = 0.
fem::Load with_boundary(const std::string& text);

/// A text with values in it: numbers in parentheses, to all digits.
std::string text_of(double value);

/// (z + a)^p (z - a)^q of z = x + iy as texts of x and y, cut between -a and a where p + q is
/// whole.
struct Power {
  Power(double p, double q, const std::string& x = "x", const std::string& y = "y");
  /// Real part of e^(i angle) times it.
  std::string turned(double angle) const;
  std::string real() const { return turned(0); }
  std::string imaginary() const { return turned(-std::numbers::pi / 2); }

 private:
  std::string _size, _angle;
};

}  // namespace anticrack::testing
