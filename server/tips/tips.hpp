// SPDX-License-Identifier: GPL-3.0-or-later
//
// Numbers of the tips of cracks and inclusions: exponents, intensities and energy release rates.
//
// A. M. Khludnev, K. Ohtsuka, J. Sokolowski, On derivative of energy functional for elastic bodies
// with cracks and unilateral conditions, Quart. Appl. Math. 60 (2002), for the rate under contact.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "mesh/mesh.hpp"
#include "tips/extraction.hpp"
#include "tips/form.hpp"
#include "tips/places.hpp"
#include "tips/release.hpp"

namespace anticrack::ddm {
struct Decomposition;
}

namespace anticrack::tips {

/// The numbers of all triangles of the mesh in the decomposition. O(m).
std::vector<Cell> cells_of(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition);

/// An answer with its fields and its load.
struct Solved {
  const contact::Answer& answer;  ///< with fields, one per subdomain
  /// Per subdomain (m,3): int f hat_i for the corners i of each triangle; read in Tips::triangles.
  std::span<const std::span<const double>> force;
  std::span<const Point> point_forces;  ///< where they act
};

/// What integrals about a tip give, whatever its kind, and whether it is closed or not.
struct Integrals {
  std::array<double, radii> rates{};  ///< -dPi/da by discs of falling radii
  double intensity = 0;               ///< c by the dual singular function
};

/// What the numbers of the tips need of the mesh. Keeps a reference to the decomposition.
class Tips {
 public:
  /// O(m log m), and a microsecond for each triangle that is near a tip, at most
  /// most_triangles a tip. Throws errors::Error (cancelled).
  Tips(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition);

  /// A row for each of mesh::tips(mesh), in their order. What cannot be computed is empty, with
  /// the reason. O(triangles near tips), on base::Threads.
  std::vector<contact::TipAnswer> of(const Solved& solved) const;
  /// The integrals of a tip, by its index, which has no reason.
  Integrals integrals(std::size_t tip, const Solved& solved) const;
  /// The same of any u and load, as forms. Of a tip without an obstacle.
  Form form(std::size_t tip) const;
  /// Why a tip has no form; empty if it has one. `points`: where forces act on the membrane itself.
  std::string obstacle(std::size_t tip, std::span<const Point> points) const;
  /// The row of a tip with these integrals. `touching`: its faces touch right behind it, in the
  /// node `behind`.
  contact::TipAnswer told(std::size_t tip, const Integrals& integrals, bool touching) const;
  /// The interface of a tip and the index of the next node behind it there.
  std::array<std::int32_t, 2> behind(std::size_t tip) const noexcept {
    return {_tips[tip].place.interface, static_cast<std::int32_t>(_tips[tip].first_behind)};
  }
  /// The rows without numbers, for one reason.
  std::vector<contact::TipAnswer> without_numbers(const std::string& reason) const;

  std::size_t size() const noexcept { return _tips.size(); }
  /// The triangles of a subdomain that are near any tip, ascending.
  std::span<const std::int32_t> triangles(std::size_t subdomain) const {
    return _triangles[subdomain];
  }
  /// Memory in bytes.
  std::size_t bytes() const noexcept;

 private:
  struct Tip {
    Place place;
    double radius = 0, inner = 0;          ///< of its support
    std::vector<Cell> cells;               ///< of its support; empty: nothing can be computed
    std::vector<Tensor> change{};          ///< (cells) derivative of T along the course; empty: 0
    std::vector<Singular> singular{};      ///< one, or none
    std::vector<Extraction> extraction{};  ///< one, or none
    std::size_t tip_cell = 0, tip_corner = 0;  ///< where u of the tip is read
    std::size_t first_behind = 0;              ///< index of the next node behind, in its interface
  };

  contact::TipAnswer row_of(const Tip& tip) const;
  static std::string reason_of(const Tip& tip, std::span<const Point> points);
  void prepare(const mesh::Mesh& mesh, std::span<const Cell> local, const struct Support& support,
               std::span<const Law> laws, Tip& tip) const;
  Corners corners(const Cell& cell) const;
  Tensor tension(const Cell& cell) const;

  const ddm::Decomposition& _decomposition;
  std::vector<std::string> _interfaces;
  std::vector<char> _tilts;  ///< (inclusions)
  std::vector<Tip> _tips;
  std::vector<std::vector<std::int32_t>> _triangles;  ///< (subdomains) those of `cells`
};

}  // namespace anticrack::tips
