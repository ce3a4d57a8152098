// SPDX-License-Identifier: GPL-3.0-or-later
#include "tips/form.hpp"

#include <algorithm>

#include "base/at.hpp"
#include "ddm/decomposition.hpp"
#include "stop/stop.hpp"
#include "tips/tips.hpp"

namespace anticrack::tips {
namespace {

using Local = std::array<double, 6>;  ///< u, then int f hat_i, of the corners of a triangle

/// The square of a form, by its values: of two units and of their sum.
template <class Square>
double between(std::size_t i, std::size_t j, const Square& square) {
  Local sum{};
  sum[i] += 1;
  sum[j] += 1;
  Local one{}, other{};
  one[i] = other[j] = 1;
  return (square(sum) - square(one) - square(other)) / 2;
}

}  // namespace

Form Tips::form(std::size_t index) const {
  const Tip& tip = _tips[index];
  const Singular& singular = tip.singular.front();
  const Extraction& extraction = tip.extraction.front();
  const Moved moved(tip.place.course, tip.radius, tip.inner);
  Form form;
  form.cells = tip.cells;
  const auto node_of = [this](const Cell& cell, std::size_t i) {
    const fem::Triangulation& part = _decomposition.subdomains[at(cell.subdomain)].part;
    return std::pair(cell.subdomain, part.triangles[3 * at(cell.triangle) + i]);
  };
  for (const Cell& cell : tip.cells)
    for (std::size_t i = 0; i < 3; ++i) form.nodes.push_back(node_of(cell, i));
  std::ranges::sort(form.nodes);
  form.nodes.erase(std::unique(form.nodes.begin(), form.nodes.end()), form.nodes.end());
  const auto place_of = [&form](const std::pair<std::int32_t, std::int32_t>& node) {
    return std::ranges::lower_bound(form.nodes, node) - form.nodes.begin();
  };
  const auto nodes = static_cast<Eigen::Index>(form.nodes.size());
  const auto size = nodes + 3 * static_cast<Eigen::Index>(tip.cells.size());
  form.intensity = Eigen::VectorXd::Zero(size);
  std::array<std::vector<Eigen::Triplet<double>>, radii> entries;
  for (std::size_t k = 0; k < tip.cells.size(); ++k) {
    stop::look_at_turn<1024>(k, "measuring tips");
    const Cell& cell = tip.cells[k];
    const Corners corner = corners(cell);
    const Tensor at_mean = tension(cell);
    std::array<Eigen::Index, 6> place{};
    for (std::size_t i = 0; i < 3; ++i) {
      place[i] = place_of(node_of(cell, i));
      place[3 + i] = nodes + static_cast<Eigen::Index>(3 * k + i);
    }
    const auto u_of = [](const Local& v) { return std::array{v[0], v[1], v[2]}; };
    for (std::size_t i = 0; i < 6; ++i) {
      Local unit{};
      unit[i] = 1;
      form.intensity[place[i]] += extraction.part(k, u_of(unit), &unit[3]);
    }
    if (tip.place.kind == mesh::TipKind::delaminated_end) continue;
    for (std::size_t r = 0; r < radii; ++r) {
      const auto rate = [&](const Local& v) {
        std::array<double, radii> rates{};
        moved.add(corner, u_of(v), at_mean, &v[3], {},
                  tip.change.empty() ? nullptr : &tip.change[k], rates);
        return rates[r];
      };
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 6; ++j) {
          const double value = between(i, j, rate);
          if (value == 0) continue;
          entries[r].emplace_back(place[i], place[j], value);
          if (i != j) entries[r].emplace_back(place[j], place[i], value);
        }
    }
  }
  // u counts from its value at the tip, which changes no rate
  const Eigen::Index at_tip = place_of(node_of(tip.cells[tip.tip_cell], tip.tip_corner));
  form.intensity[at_tip] -= form.intensity.head(nodes).sum();
  form.intensity *= singular.sign() / (2 * singular.exponent() * singular.norm());
  for (std::size_t r = 0; r < radii; ++r) {
    form.rates[r].resize(size, size);
    form.rates[r].setFromTriplets(entries[r].begin(), entries[r].end());
  }
  return form;
}

}  // namespace anticrack::tips
