// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/row_tips.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "operators/basis_fields.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Most memory of the forms, and most values of all u that are computed once.
constexpr std::size_t most_form_bytes = std::size_t{512} << 20, most_values = std::size_t{1} << 31;

/// The forms of a tip with the columns of v.
struct Values {
  tips::Form form;
  MatrixXd v;  ///< (numbers of v, b)
};

/// The contact of the node right behind a tip, if it has a jump of its own, or -1.
std::int32_t contact_behind(const MeshOperator::Parts& parts, std::size_t tip) {
  const std::array<std::int32_t, 2> node = parts.all_tips().behind(tip);
  const contact::SweepGeometry& geometry = parts.sweep_geometry;
  const auto found = std::ranges::find(geometry.nodes, node);
  if (found == geometry.nodes.end()) return -1;
  const std::int32_t contact = geometry.contact[at(found - geometry.nodes.begin())];
  return at(contact) < parts.decomposition.skeleton.independent ? contact : -1;
}

std::string obstacle(const MeshOperator::Parts& parts, std::size_t loads) {
  const ddm::Skeleton& skeleton = parts.decomposition.skeleton;
  if (std::ranges::any_of(skeleton.held, [](const ddm::Held& held) { return held.value != 0; }))
    return "an inclusion is held at a given number";
  const std::size_t b = loads + skeleton.independent;
  std::size_t nodes = 0;
  for (const ddm::Subdomain& one : parts.decomposition.subdomains) nodes += one.node.size();
  if (b * nodes > most_values ||
      parts.all_tips().size() * tips::radii * b * b * 8 > most_form_bytes)
    return fmt::format("{} loads and contacts on {} nodes are too many", b, nodes);
  return {};
}

}  // namespace

std::size_t RowTips::bytes() const noexcept {
  std::size_t numbers = 0;
  for (const Tip& tip : tips) {
    numbers += at(tip.intensity.size());
    for (const MatrixXd& rate : tip.rates) numbers += at(rate.size());
  }
  return sizeof(*this) + tips.size() * sizeof(Tip) + sizeof(double) * numbers;
}

RowTips row_tips(const MeshOperator::Parts& parts, std::span<const LoadOnTraces> loads) {
  RowTips result;
  const tips::Tips& tips = parts.all_tips();
  if (const std::string why = obstacle(parts, loads.size()); !why.empty()) {
    if (tips.size() > 0) result.warnings.push_back("no numbers of tips in rows: " + why);
    return result;
  }
  const auto b = static_cast<Index>(loads.size() + parts.decomposition.skeleton.independent);
  std::vector<ForceOnTriangles> forces;
  std::vector<mesh::Point> points;
  for (const LoadOnTraces& load : loads) {
    forces.emplace_back(load.parts, parts.decomposition.subdomains);
    points.insert(points.end(), load.parts.points.begin(), load.parts.points.end());
  }
  std::vector<Values> values;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    if (const std::string why = tips.obstacle(i, points); !why.empty()) {
      result.warnings.push_back(fmt::format("tip {} has no numbers in rows: {}", i, why));
      continue;
    }
    result.tips.push_back({i, {}, {}, contact_behind(parts, i)});
    Values& of = values.emplace_back(Values{tips.form(i), {}});
    of.v = MatrixXd::Zero(of.form.intensity.size(), b);
  }
  std::vector<std::size_t> first{0};
  for (const ddm::Subdomain& one : parts.decomposition.subdomains)
    first.push_back(first.back() + one.node.size());
  Index column = 0;
  basis_fields(parts, loads, {}, [&](const std::vector<double>& u) {
    for (Values& of : values) {
      const auto nodes = static_cast<Index>(of.form.nodes.size());
      for (Index n = 0; n < nodes; ++n) {
        const auto& [subdomain, node] = of.form.nodes[at(n)];
        of.v(n, column) = u[first[at(subdomain)] + at(node)];
      }
      for (std::size_t k = 0; at(column) < loads.size() && k < of.form.cells.size(); ++k) {
        const tips::Cell& cell = of.form.cells[k];
        const double* force =
            &forces[at(column)].of_subdomains[at(cell.subdomain)][3 * at(cell.triangle)];
        for (std::size_t i = 0; i < 3; ++i)
          of.v(nodes + static_cast<Index>(3 * k + i), column) = force[i];
      }
    }
    ++column;
  });
  for (std::size_t i = 0; i < values.size(); ++i) {
    stop::look("measuring tips");
    const Values& of = values[i];
    result.tips[i].intensity = of.v.transpose() * of.form.intensity;
    for (std::size_t r = 0; r < tips::radii; ++r)
      if (of.form.rates[r].nonZeros() > 0)
        result.tips[i].rates[r] = of.v.transpose() * (of.form.rates[r] * of.v);
  }
  return result;
}

void find_row_tips(const MeshOperator::Parts& parts, const RowTips& shared,
                   std::span<const double> coefficients, const contact::LcpAnswer& solution,
                   std::size_t row, contact::SweepColumns& rows) {
  std::vector<std::pair<Index, double>> y;
  for (std::size_t j = 0; j < coefficients.size(); ++j)
    if (coefficients[j] != 0) y.emplace_back(static_cast<Index>(j), coefficients[j]);
  for (Index i = 0; i < solution.d.size(); ++i)
    if (solution.d[i] != 0)
      y.emplace_back(static_cast<Index>(coefficients.size()) + i, solution.d[i]);
  for (const RowTips::Tip& tip : shared.tips) {
    tips::Integrals integrals;
    for (const auto& [i, value] : y) integrals.intensity += value * tip.intensity[i];
    for (std::size_t r = 0; r < tips::radii && tip.rates[r].size() > 0; ++r) {
      for (const auto& [i, value] : y) {
        double sum = 0;
        for (const auto& [k, other] : y) sum += tip.rates[r](k, i) * other;
        integrals.rates[r] += value * sum;
      }
    }
    const bool touching = tip.contact >= 0 && solution.d[tip.contact] <= 0;
    rows.take_tip(row, tip.index, parts.all_tips().told(tip.index, integrals, touching));
  }
}

}  // namespace anticrack::operators
