// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/shared_bounds.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "estimate/equilibrated_flux.hpp"
#include "fem/triangle_rules.hpp"
#include "operators/basis_fields.hpp"
#include "operators/displacement_bounds.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* sharing = "computing what bounds of rows share";

constexpr std::size_t most_inclusions = 16, most_bytes = std::size_t{512} << 20;

constexpr Index fluxes_together = 4;

/// The bytes of the fields, fluxes and gradients of `columns` functions, while they are made.
std::size_t bytes_at_work(std::size_t triangles, std::size_t columns) {
  return triangles *
         (sizeof(double) * 5 * columns + at(fluxes_together) * bytes_per_triangle_and_load);
}

/// a'b of tall matrices, or a'w b with weights of their rows, a few rows at a time.
MatrixXd product(const Eigen::Ref<const MatrixXd>& a, const MatrixXd& b,
                 const VectorXd& weight = {}) {
  MatrixXd sum = MatrixXd::Zero(a.cols(), b.cols()), weighed;
  const Index rows = std::max<Index>(64, 5'000'000 / (a.cols() * b.cols() + 1));
  for (Index first = 0; first < a.rows(); first += rows) {
    stop::look(sharing);
    const Index count = std::min(rows, a.rows() - first);
    if (weight.size() == 0) {
      sum.noalias() += a.middleRows(first, count).transpose() * b.middleRows(first, count);
    } else if (!weight.segment(first, count).isZero(0)) {
      weighed = weight.segment(first, count).asDiagonal() * b.middleRows(first, count);
      sum.noalias() += a.middleRows(first, count).transpose() * weighed;
    }
  }
  return sum;
}

class Maker {
 public:
  Maker(const MeshOperator::Parts& parts, std::span<const LoadOnTraces> loads,
        std::span<const BalancedLoad> balanced, const contact::SweepLoads& reduced)
      : _parts(parts),
        _cut(parts.cut_mesh()),
        _loads(loads),
        _balanced(balanced),
        _reduced(reduced) {
    for (const Aim& aim : aims(parts))
      if (aim.scale != nullptr) _aims.push_back(aim);  // rows have bounds of A only
    _of.loads = static_cast<Index>(loads.size());
    _of.contacts = reduced.r.rows();
    _of.goals = static_cast<Index>(_aims.size());
    _of.pressures = face_pressures(parts, _cut);
    _of.largest_tension = _cut.shapes.largest_tension;
    for (const Aim& aim : _aims) _of.inclusion.push_back(aim.inclusion);
    _of.unit = unit_forces(parts, _aims);
  }

  std::shared_ptr<const SharedBounds> make() {
    if (_of.pressures.ends.empty()) return nullptr;
    place_rows();
    find_fields();
    find_strain();
    const Eigen::LLT<MatrixXd> factor(_of.stiffness());
    if (factor.info() != Eigen::Success) return nullptr;
    _of.softness = factor.solve(MatrixXd::Identity(_of.contacts, _of.contacts));
    _of.inexact = (_of.stiffness() * _of.softness - MatrixXd::Identity(_of.contacts, _of.contacts))
                      .cwiseAbs()
                      .colwise()
                      .sum()
                      .maxCoeff();
    find_fluxes();
    if (!sound()) return nullptr;
    _of.flux = product(_flux, _flux);
    _of.norm = _of.flux.diagonal().cwiseMax(0.0).cwiseSqrt();
    find_weight();
    find_turns();
    find_rest();
    return std::make_shared<const SharedBounds>(std::move(_of));
  }

 private:
  Index columns() const { return _of.loads + _of.contacts + _of.goals; }
  std::span<const double> field(Index b) const { return _fields[at(b)]; }

  /// Two rows for a constant on each triangle, more in `_turned` ones where sigma is not.
  void place_rows() {
    _turned.assign(_cut.triangle_count(), 0);
    for (const estimate::Face& face : _cut.faces)
      if (face.inclusion >= 0 && _cut.tilts[at(face.inclusion)] != 0)
        _turned[at(face.side / 3)] = 1;
    for (std::size_t t = 0; t < _turned.size(); ++t) {
      _first_row.push_back(_rows);
      _rows += rows_of(t);
    }
  }
  Index rows_of(std::size_t t) const {
    return _turned[t] != 0 ? 2 * static_cast<Index>(fem::rule_5.size) : 2;
  }

  /// The products of the turns, triangle by triangle.
  void find_turns() {
    const auto count = static_cast<Index>(_of.pressures.turns.size());
    _of.turning = MatrixXd::Zero(count, columns());
    std::vector<std::vector<std::pair<Index, const double*>>> at_triangle(_cut.triangle_count());
    for (Index k = 0; k < count; ++k) {
      const std::size_t fan = _of.pressures.turns[at(k)].fan;
      for (auto n = at(_cut.first_corner[fan]); n < at(_cut.first_corner[fan + 1]); ++n) {
        const estimate::FanCorner& corner = _cut.shapes.around[n];
        at_triangle[at(corner.triangle)].emplace_back(k, corner.edge);
      }
    }
    std::vector<Eigen::Triplet<double>> overlaps, weighed;
    for (std::size_t t = 0; t < at_triangle.size(); ++t) {
      if (at_triangle[t].empty()) continue;
      stop::look(sharing);
      Eigen::Matrix<double, 2, Eigen::Dynamic> mean = Eigen::MatrixXd::Zero(2, columns());
      for (Index p = 0; p < rows_of(t) / 2; ++p)
        mean += (_turned[t] == 0 ? 1 : std::sqrt(fem::rule_5.weight[at(p)])) *
                _flux.middleRows(_first_row[t] + 2 * p, 2);
      for (const auto& [k, edge] : at_triangle[t]) {
        _of.turning.row(k) += edge[0] * mean.row(0) + edge[1] * mean.row(1);
        for (const auto& [l, other] : at_triangle[t]) {
          const double common = edge[0] * other[0] + edge[1] * other[1];
          overlaps.emplace_back(k, l, common);
          if (!_weight.empty()) weighed.emplace_back(k, l, _weight[t] * common);
        }
      }
    }
    _of.pressures.overlap.resize(count, count);
    _of.pressures.overlap.setFromTriplets(overlaps.begin(), overlaps.end());
    _of.unbalanced.overlap.resize(count, count);
    _of.unbalanced.overlap.setFromTriplets(weighed.begin(), weighed.end());
  }

  void find_fields() {
    std::vector<const ddm::Terms*> goals;
    for (const Aim& aim : _aims) goals.push_back(&aim.goal);
    basis_fields(_parts, _loads, goals,
                 [this](std::vector<double> u) { _fields.push_back(std::move(u)); });
    _of.largest.resize(columns());
    for (Index b = 0; b < columns(); ++b)
      _of.largest[b] =
          Eigen::Map<const VectorXd>(field(b).data(), _cut.at.size()).cwiseAbs().maxCoeff();
  }

  /// sqrt(area / T) T grad u_b.
  estimate::Vector flux_of(std::size_t t, Index b) const {
    const std::span<const double> u = field(b);
    const std::int32_t* copy = &_cut.copy[3 * t];
    const estimate::Vector* edge = &_cut.shapes.edge[3 * t];
    const double first = _cut.shapes.tension[t] * (u[at(copy[1])] - u[at(copy[0])]),
                 second = _cut.shapes.tension[t] * (u[at(copy[2])] - u[at(copy[0])]);
    return {-first * edge[1][1] - second * edge[2][1], first * edge[1][0] + second * edge[2][0]};
  }

  /// Writes sqrt(area / T) times a vector that is constant on a triangle.
  void put(const estimate::Vector& value, std::size_t t, Index b, MatrixXd& to) const {
    if (_turned[t] == 0) {
      to(_first_row[t], b) = value[0];
      to(_first_row[t] + 1, b) = value[1];
      return;
    }
    for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
      const double root = std::sqrt(fem::rule_5.weight[p]);
      to(_first_row[t] + 2 * static_cast<Index>(p), b) = root * value[0];
      to(_first_row[t] + 2 * static_cast<Index>(p) + 1, b) = root * value[1];
    }
  }

  void find_strain() {
    _gradient.resize(_rows, columns());
    for (Index b = 0; b < _gradient.cols(); ++b) {
      stop::look(sharing);
      for (std::size_t t = 0; t < _cut.triangle_count(); ++t) put(flux_of(t, b), t, b, _gradient);
    }
    _of.strain = product(_gradient, _gradient);
    _of.traction = MatrixXd::Zero(_of.contacts + _of.goals, _of.loads);
    for (Index j = 0; j < _of.loads; ++j) {
      const std::vector<double>& load = _balanced[at(j)].balance.traction;
      for (const estimate::Face& face : _cut.faces) {
        if (face.traction < 0 || load.empty()) continue;
        const auto ends = _cut.ends(face);
        const double off = load[2 * at(face.traction)] - load[2 * at(face.traction) + 1];
        for (Index i = 0; off != 0 && i < _of.traction.rows(); ++i) {
          const auto z = field(_of.loads + i);
          _of.traction(i, j) -= 0.5 * off * (z[at(ends[0])] - z[at(ends[1])]);
        }
      }
    }
  }

  /// lambda of u_b, on each contact.
  VectorXd reactions(Index b) const {
    if (b < _of.loads) return -_reduced.r.col(b);
    if (b < _of.loads + _of.contacts) return _of.strain.col(b).segment(_of.loads, _of.contacts);
    return -_of.unit[at(b - _of.loads - _of.contacts)].r;
  }

  std::vector<estimate::ForceOn> forces(Index b) const {
    if (b < _of.loads) return forces_on(_loads[at(b)]);
    if (b < _of.loads + _of.contacts) return {};
    return _aims[at(b - _of.loads - _of.contacts)].unit(_parts.mesh->inclusions.size());
  }

  void find_fluxes() {
    _flux.resize(_rows, columns());
    _of.lack.resize(columns());
    _of.work.resize(columns());
    _size.resize(columns());
    for (Index first = 0; first < columns();) {
      const Index end = first < _of.loads ? _of.loads : columns();  // only loads have a force
      const Index count = std::min(fluxes_together, end - first);
      std::vector<std::vector<double>> through;
      std::vector<estimate::Balance> balances;
      for (Index b = first; b < first + count; ++b) {
        through.push_back(
            _of.pressures.through(_cut.faces.size(), _of.pressures.divided(reactions(b)).ends));
        balances.push_back({field(b), {}, {}});
        if (b >= _of.loads) continue;
        balances.back().force = _balanced[at(b)].balance.force;
        balances.back().traction = _balanced[at(b)].balance.traction;
      }
      std::vector<estimate::FaceBounds> bounds;
      bounds.reserve(through.size());
      for (const std::vector<double>& one : through) bounds.push_back({one, one});
      const auto fluxes = estimate::EquilibratedFlux::of_all(_cut, balances, bounds);
      for (Index k = 0; k < count; ++k)
        take(first + k, fluxes[at(k)], through[at(k)], balances[at(k)].traction);
      first += count;
    }
  }

  void take(Index b, const estimate::EquilibratedFlux& flux, std::span<const double> through,
            std::span<const double> traction) {
    std::vector<double> kept(_cut.faces.size());
    for (std::size_t f = 0; f < kept.size(); ++f) kept[f] = through[2 * f] + through[2 * f + 1];
    const estimate::Lack lack = estimate::lack_of(_cut, flux, traction, forces(b), kept, through);
    _of.lack[b] = lack.flux;
    _of.work[b] = lack.work;
    _size[b] = std::sqrt(flux.norm_squared());
    for (std::size_t t = 0; t < _cut.triangle_count(); ++t) {
      if (_turned[t] == 0) {
        put(flux.mean(t), t, b, _flux);
        continue;
      }
      for (std::size_t p = 0; p < fem::rule_5.size; ++p) {
        const double x = fem::rule_5.b[p], y = fem::rule_5.c[p];
        const estimate::Vector value = flux.difference(t, {1 - x - y, x, y});
        const double root = std::sqrt(fem::rule_5.weight[p] * flux.area(t) / flux.tension(t));
        for (const std::size_t k : {0, 1})
          _flux(_first_row[t] + 2 * static_cast<Index>(p) + static_cast<Index>(k), b) =
              root * value[k];
      }
    }
  }

  /// Whether all fluxes are in equilibrium to rounding: a fan with other faces than those of one
  /// contact may not divide its force as asked.
  bool sound() const {
    constexpr double rounding = 1e-9;
    const double of_loads = _size.head(_of.loads).maxCoeff();  // one may be 0 on this mesh
    for (Index b = 0; b < columns(); ++b)
      if (!(_of.lack[b] <= rounding * (b < _of.loads ? of_loads : _size[b]))) return false;
    return true;
  }

  /// omega on each triangle; empty if all loads are balanced.
  void find_weight() {
    for (const BalancedLoad& load : _balanced) {
      const std::vector<double>& own = load.balance.oscillation;
      if (own.empty()) continue;
      _weight.resize(_cut.triangle_count(), 0);
      const double size =
          Eigen::Map<const VectorXd>(own.data(), static_cast<Index>(own.size())).norm();
      for (std::size_t t = 0; size > 0 && t < own.size(); ++t) _weight[t] += own[t] / size;
    }
    if (_weight.empty()) return;
    VectorXd of_rows(_rows);
    for (std::size_t t = 0; t < _weight.size(); ++t)
      of_rows.segment(_first_row[t], rows_of(t)).setConstant(_weight[t]);
    _of.unbalanced.flux = product(_flux, _flux, of_rows);
    _of.unbalanced.strain = product(_gradient, _gradient, of_rows);
    _of.unbalanced.oscillation = MatrixXd::Zero(_of.loads, _of.loads);
  }

  /// The parts of loads that are not constant on triangles, or not balanced.
  void find_rest() {
    _of.oscillation = MatrixXd::Zero(_of.loads, _of.loads);
    _of.steep = _of.moments = MatrixXd::Zero(_of.loads, _of.goals);
    for (std::size_t t = 0; t < _cut.triangle_count(); ++t) {
      stop::look_at_turn<stop::quick>(t, sharing);
      for (Index j = 0; j < _of.loads; ++j) {
        const estimate::LoadBalance& own = _balanced[at(j)].balance;
        for (Index k = 0; k <= j; ++k) {
          const estimate::LoadBalance& other = _balanced[at(k)].balance;
          double force = 0, beyond = 0;
          if (_turned[t] == 0)
            force = estimate::rest_of_forces(_cut, t, &own.force[3 * t], &other.force[3 * t]);
          if (!own.oscillation.empty() && !other.oscillation.empty())
            beyond = own.oscillation[t] * other.oscillation[t];
          const auto add = [&](MatrixXd& to, double what) {
            to(j, k) += what;
            if (j != k) to(k, j) += what;
          };
          add(_of.flux, force);
          add(_of.oscillation, beyond);
          if (_weight.empty()) continue;
          add(_of.unbalanced.flux, _weight[t] * force);
          if (beyond > 0) add(_of.unbalanced.oscillation, beyond / _weight[t]);
        }
        if (own.oscillation.empty() || own.oscillation[t] == 0) continue;
        for (Index k = 0; k < _of.goals; ++k) {
          const Index b = _of.loads + _of.contacts + k;
          const double steep = own.oscillation[t];
          const estimate::Vector flux = flux_of(t, b);
          if (own.moments[t] * _of.largest[b] < steep * std::sqrt(estimate::dot(flux, flux)))
            _of.moments(j, k) += own.moments[t];
          else
            _of.steep(j, k) += steep * steep / _weight[t];
        }
      }
    }
    _of.steep = _of.steep.cwiseSqrt();
    // A force is divided in parts whose sum is at most 2, and both faces of a crack have it.
    const estimate::Ways& ways = _cut.ways;
    _of.beyond = 4 * ways.triangle;
    for (const estimate::Ways::Body& body : ways.bodies)
      if (!body.held)
        _of.beyond =
            std::max(_of.beyond, 4 * ways.triangle + 2 * (body.force + body.extent * body.moment));
  }

  const MeshOperator::Parts& _parts;
  const estimate::CutMesh& _cut;
  std::span<const LoadOnTraces> _loads;
  std::span<const BalancedLoad> _balanced;
  const contact::SweepLoads& _reduced;
  std::vector<Aim> _aims;
  std::vector<char> _turned;
  std::vector<Index> _first_row;
  Index _rows = 0;
  std::vector<std::vector<double>> _fields;
  MatrixXd _gradient, _flux;  // rows of sqrt(area / T) T grad u_b, and of sigma_b - T grad u_b
  VectorXd _size;
  std::vector<double> _weight;
  SharedBounds _of;
};

/// Where rows are bounded by adjoints, and nothing varies inside triangles.
bool possible(const MeshOperator::Parts& parts) {
  const ddm::Skeleton& skeleton = parts.decomposition.skeleton;
  return skeleton.independent > 0 && skeleton.dependent.empty() &&
         parts.mesh->inclusions.size() <= most_inclusions && parts.mesh->tension_laws.empty() &&
         std::ranges::all_of(skeleton.held, [](const ddm::Held& held) { return held.value == 0; });
}

}  // namespace

std::size_t SharedBounds::bytes() const noexcept {
  std::size_t numbers = 0;
  for (const MatrixXd* one :
       {&flux, &turning, &strain, &softness, &traction, &oscillation, &unbalanced.flux,
        &unbalanced.strain, &unbalanced.oscillation, &steep, &moments})
    numbers += at(one->size());
  for (const contact::UnitForce& force : unit) numbers += at(force.r.size());
  // The overlap with the weight has the entries of that without.
  return sizeof(*this) + sizeof(double) * (numbers + 4 * at(norm.size())) +
         (unbalanced.flux.size() > 0 ? 2 : 1) * pressures.bytes();
}

bool shares_bounds(const MeshOperator::Parts& parts, std::size_t loads, std::uint64_t rows) {
  const std::size_t all =
      loads + parts.decomposition.skeleton.independent + parts.mesh->inclusions.size();
  if (!possible(parts) || bytes_at_work(parts.mesh->triangle_count(), all) > most_bytes)
    return false;
  // Operations: a row of its own, a row with products and new contact, and the products.
  const auto m = static_cast<double>(parts.mesh->triangle_count()), n = static_cast<double>(all);
  const double own = 500 * m, shared = 20 * n * n + n * n * n / 3, once = n * m * (300 + 4 * n);
  return static_cast<double>(rows) * (own - shared) > 2 * once;
}

std::shared_ptr<const SharedBounds> shared_bounds(const MeshOperator::Parts& parts,
                                                  std::span<const LoadOnTraces> loads,
                                                  std::span<const BalancedLoad> balanced,
                                                  const contact::SweepLoads& reduced) {
  const estimate::CutMesh& cut = parts.cut_mesh();
  const bool linear = std::ranges::all_of(balanced, [](const BalancedLoad& load) {
    return load.obstacle.empty() && load.linear_along_edges;
  });
  if (!possible(parts) || !linear || !cut.obstacle.empty() || !std::isfinite(cut.ways.triangle))
    return nullptr;
  const Working counted(parts.at_work,
                        bytes_at_work(cut.triangle_count(), loads.size() + at(reduced.r.rows()) +
                                                                parts.mesh->inclusions.size()));
  return Maker(parts, loads, balanced, reduced).make();
}

}  // namespace anticrack::operators
