// SPDX-License-Identifier: GPL-3.0-or-later
#include "accuracy/error_norms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/at.hpp"

namespace anticrack::accuracy {
namespace {

using testing::Complex;
using testing::crack_end;

// Gauss points and weights on (0,1).
constexpr std::array<double, 6> points{0.03376524289842399, 0.16939530676686775,
                                       0.38069040695840155, 0.61930959304159845,
                                       0.83060469323313225, 0.96623475710157601};
constexpr std::array<double, 6> weights{0.08566224618958517, 0.18038078652406930,
                                        0.23395696728634552, 0.23395696728634552,
                                        0.18038078652406930, 0.08566224618958517};

double distance_to_tips(Complex z) {
  return std::min(std::abs(z - crack_end), std::abs(z + crack_end));
}

/// int |exact.derivative - slope|^2 over the triangle, coordinates collapsed in the corner nearest
/// to a tip. A tip itself is approached like s^4, which turns r^{-3/2} r dr into s ds.
double square_error(std::array<Complex, 3> corner, const testing::ExactSolution& exact,
                    Complex slope) {
  std::rotate(corner.begin(),
              std::min_element(
                  corner.begin(), corner.end(),
                  [](Complex a, Complex b) { return distance_to_tips(a) < distance_to_tips(b); }),
              corner.end());
  const Complex a = corner[1] - corner[0], b = corner[2] - corner[0];
  const double doubled = std::imag(std::conj(a) * b);
  const bool tip = distance_to_tips(corner[0]) == 0;
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = points[i];
    const double r = tip ? s * s * s * s : s;
    const double dr = tip ? 4 * s * s * s : 1;
    for (std::size_t j = 0; j < points.size(); ++j) {
      const Complex z = corner[0] + r * ((1 - points[j]) * a + points[j] * b);
      sum += weights[i] * weights[j] * dr * r * doubled * std::norm(exact.derivative(z) - slope);
    }
  }
  return sum;
}

Complex point(const mesh::Mesh& mesh, std::int32_t node) {
  return {mesh.xy[2 * at(node)], mesh.xy[2 * at(node) + 1]};
}

/// Sum over the triangles; `slope(t, corner)` is F_h' there.
template <class Slope>
double energy_distance(const mesh::Mesh& mesh, const testing::ExactSolution& exact, Slope&& slope) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<Complex, 3> corner{point(mesh, mesh.triangles[3 * t]),
                                        point(mesh, mesh.triangles[3 * t + 1]),
                                        point(mesh, mesh.triangles[3 * t + 2])};
    sum += square_error(corner, exact, slope(t, corner));
  }
  return std::sqrt(sum);
}

}  // namespace

double energy_error(const mesh::Mesh& mesh, const contact::Answer& answer,
                    const testing::ExactSolution& exact) {
  std::vector<std::vector<double>> u(mesh.subdomains.size(),
                                     std::vector<double>(mesh.node_count()));
  for (std::size_t s = 0; s < u.size(); ++s) {
    const contact::Field& field = answer.fields.at(s);
    for (std::size_t i = 0; i < field.nodes.size(); ++i) {
      u[s][at(field.nodes[i])] = field.u[i];
    }
  }
  return energy_distance(mesh, exact, [&](std::size_t t, const std::array<Complex, 3>& corner) {
    const std::vector<double>& values = u[at(mesh.subdomain[t])];
    const auto value = [&](std::size_t i) { return values[at(mesh.triangles[3 * t + i])]; };
    // u_x - i u_y of the linear function with increments da along a and db along b.
    const Complex a = corner[1] - corner[0], b = corner[2] - corner[0];
    const double da = value(1) - value(0), db = value(2) - value(0);
    const double doubled = std::imag(std::conj(a) * b);
    return Complex(da * b.imag() - db * a.imag(), da * b.real() - db * a.real()) / doubled;
  });
}

JumpError jump_error(const mesh::Mesh& mesh, const contact::Answer& answer,
                     const testing::ExactSolution& exact) {
  const mesh::Interface& line = mesh.interfaces.at(0);
  const std::vector<double>& jump = answer.traces.at(0).jump;
  JumpError error;
  double sum = 0;
  for (std::size_t e = 0; e < line.kind.size(); ++e) {
    const double begin = mesh.xy[2 * at(line.nodes[e])], end = mesh.xy[2 * at(line.nodes[e + 1])];
    if (std::abs(0.5 * (begin + end)) > crack_end) {
      continue;
    }
    error.largest = std::max(error.largest, std::abs(jump[e + 1] - exact.jump(end)));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double s = points[i];
      const double difference =
          (1 - s) * jump[e] + s * jump[e + 1] - exact.jump((1 - s) * begin + s * end);
      sum += weights[i] * std::abs(end - begin) * difference * difference;
    }
  }
  error.l2 = std::sqrt(sum);
  return error;
}

}  // namespace anticrack::accuracy
