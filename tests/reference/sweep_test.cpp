// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of sweeps against the plain active set of the same load: all kinds, random geometries, loads
// of every sort, combinations with zeros and signs. Both the dense and the joined membrane.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "contact/sweep_columns.hpp"
#include "errors/errors.hpp"
#include "operators/mesh_operator.hpp"
#include "reference/random_membrane.hpp"
#include "support/multipliers.hpp"
#include "support/paths.hpp"
#include "support/silent_observer.hpp"
#include "support/solve.hpp"

namespace anticrack::reference {
namespace {

using anticrack::testing::Silent;
using contact::ActiveSetOptions;
using contact::Answer;
using contact::Status;
using contact::SweepColumns;
using operators::LoadBasis;
using operators::MeshOperator;

Answer plain(const MeshOperator& op, const fem::Load& load) {
  Silent silent;
  return testing::solve(op, load, ActiveSetOptions{}, false, silent);
}

std::string text(double value) {
  char digits[40];
  std::snprintf(digits, sizeof digits, "%.17g", value);
  return digits;
}

/// Loads of all sorts, polynomials so that quadrature is right to rounding, of which a combination
/// can be written down as a load.
class Loads {
 public:
  static constexpr std::size_t count = 4;

  explicit Loads(RandomMembrane& membrane) {
    for (double& value : _numbers) {
      value = membrane.uniform(-2, 2);
    }
    const mesh::Mesh& mesh = membrane.mesh();
    _inclusion = mesh.inclusions.empty() ? "" : mesh.inclusions[0];
    _neumann = has_neumann(mesh);
    const std::vector<char> tilts = tilting(mesh);
    if (const auto first = std::ranges::find(tilts, 1); first != tilts.end())
      _tilting = mesh.inclusions[static_cast<std::size_t>(first - tilts.begin())];
    for (std::size_t j = 0; j < count; ++j) {
      std::vector<double> unit(count, 0);
      unit[j] = 1;
      loads.push_back(combined(unit));
    }
  }

  fem::Load combined(std::span<const double> c) const {
    fem::Load load;
    load.force = fem::Expression{text(c[0] * _numbers[0]) + "*x*y + " + text(c[0]) + " + " +
                                 text(c[1] * _numbers[1]) + " + " + text(c[3]) + "*(x - y)"};
    load.boundary_value =
        text(c[0]) + "*(0.3*x - 0.1*y + 2) + " + text(c[2] * _numbers[2]) + "*y*y";
    if (_neumann) load.traction = text(c[1]) + "*(x - y) + " + text(c[2]);
    load.point_forces = {{1.3, 1.2, c[2] * _numbers[3]}, {0.4, 2.1, c[3] * _numbers[4]}};
    if (!_inclusion.empty()) {
      load.inclusion_forces[_inclusion] = c[3] * _numbers[5] + c[1];
    }
    if (!_tilting.empty())
      load.inclusion_moments[_tilting] = {c[2] * _numbers[5], c[0] * _numbers[1] - c[3]};
    return load;
  }

  std::vector<fem::Load> loads;

 private:
  double _numbers[6] = {};
  std::string _inclusion, _tilting;
  bool _neumann = false;
};

/// What the differences of a load's numbers are relative to: rounding is relative to the terms a
/// number is the sum of, and these are what each load of the basis gives alone.
struct Scale {
  double energy = 0, trace = 0, slope = 0;

  void add(double coefficient, const Answer& alone) {
    energy += coefficient * coefficient * std::abs(alone.energy);
    for (const contact::InclusionAnswer& rigid : alone.inclusions)
      slope = std::max(slope, std::abs(coefficient) * std::hypot(rigid.slope_x, rigid.slope_y));
    for (const contact::Trace& along : alone.traces) {
      for (std::size_t i = 0; i < along.u_minus.size(); ++i) {
        trace = std::max({trace, std::abs(coefficient * along.u_minus[i]),
                          std::abs(coefficient * along.u_plus[i])});
      }
    }
  }
};

struct SweepTally {
  int rows = 0, not_converged = 0, undecided = 0, open = 0, closed = 0, refused = 0;
  int tilting = 0, held = 0, unsolvable = 0;
  double energy = 0, displacement = 0, slope = 0, length = 0, kkt = 0;
};

void compare_row(const MeshOperator& op, const SweepColumns& rows, std::size_t row,
                 const Answer& wanted, const Scale& scale, SweepTally& tally) {
  ++tally.rows;
  ASSERT_EQ(rows.status[row], wanted.status);
  EXPECT_LE(rows.kkt[row], 1e-11);
  tally.kkt = std::max(tally.kkt, rows.kkt[row]);
  if (wanted.status != Status::converged) {
    ++tally.not_converged;
    EXPECT_EQ(rows.energy[row], 0);
    return;
  }
  EXPECT_GE(rows.steps[row], 1);
  double largest = 0;
  for (const contact::Trace& trace : wanted.traces) {
    for (const double pressure : testing::multipliers(trace)) {
      largest = std::max(largest, std::abs(pressure));
    }
  }
  bool all_decided = true;
  for (std::size_t n = 0; n < rows.contacts; ++n) {
    const auto c = static_cast<std::size_t>(op.contact_nodes()[n][0]);
    const auto i = static_cast<std::size_t>(op.contact_nodes()[n][1]);
    const bool in_contact = rows.contact[row * rows.contacts + n] != 0;
    ++(in_contact ? tally.closed : tally.open);
    if (in_contact != (wanted.traces[c].contact[i] != 0)) {
      const bool noise = std::abs(wanted.traces[c].pressure[i]) <= 1e-10 * largest &&
                         wanted.traces[c].jump[i] <= 1e-10 * scale.trace;
      EXPECT_TRUE(noise) << "interface " << c << ", node " << i;
      all_decided = false;
      ++tally.undecided;
    }
  }
  const auto difference = [](double a, double b, double size) {
    return a == b ? 0 : std::abs(a - b) / size;
  };
  tally.energy = std::max(tally.energy, difference(rows.energy[row], wanted.energy, scale.energy));
  for (std::size_t j = 0; j < rows.inclusions; ++j) {
    tally.displacement =
        std::max(tally.displacement, difference(rows.displacement[row * rows.inclusions + j],
                                                wanted.inclusions[j].displacement, scale.trace));
    if (!rows.slope.empty()) {
      const double* slope = &rows.slope[2 * (row * rows.inclusions + j)];
      // A body with a slight kink has next to nothing against tilting about its line.
      const double size = std::max(scale.trace, scale.slope);
      tally.slope = std::max({tally.slope, difference(slope[0], wanted.inclusions[j].slope_x, size),
                              difference(slope[1], wanted.inclusions[j].slope_y, size)});
      tally.tilting += slope[0] != 0 || slope[1] != 0 ? 1 : 0;
    }
    const std::vector<mesh::Motion>& motions = op.mesh().motions;
    if (motions.empty() || !motions[j].fixed) continue;
    ++tally.held;
    EXPECT_DOUBLE_EQ(rows.displacement[row * rows.inclusions + j], *motions[j].fixed);
  }
  if (all_decided) {
    tally.length = std::max(tally.length, difference(rows.contact_length[row],
                                                     wanted.contact_length, wanted.contact_length));
  }
}

class Sweep : public ::testing::TestWithParam<std::tuple<bool, std::size_t>> {};

TEST_P(Sweep, RowsArePlainAnswersOfTheirLoads) {
  const auto [rich, condensed_up_to] = GetParam();
  SweepTally tally;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomMembrane membrane(seed, rich);
    std::shared_ptr<const MeshOperator> op;
    try {
      op = MeshOperator::factorise(std::make_shared<const mesh::Mesh>(membrane.mesh()), 1, {},
                                   condensed_up_to);
    } catch (const errors::Error&) {
      ++tally.refused;
      continue;
    }
    const Loads loads(membrane);
    std::vector<const fem::Load*> pointers;
    for (const fem::Load& load : loads.loads) {
      pointers.push_back(&load);
    }
    std::shared_ptr<const LoadBasis> basis;
    try {
      basis = op->basis(pointers);
    } catch (const errors::Error& error) {
      // What holds a body does not agree, for this load alone or for all.
      EXPECT_TRUE(rich && error.reason() == errors::Reason::invalid_argument) << error.what();
      ++tally.unsolvable;
      continue;
    }
    constexpr std::size_t count = 12, m = Loads::count;
    std::vector<double> coefficients;
    for (std::size_t k = 0; k < count * m; ++k) {
      coefficients.push_back(k < m || k % 7 == 0 ? 0 : membrane.uniform(-2, 2));
    }
    SweepColumns rows(count, membrane.mesh().inclusions.size(), op->contact_nodes().size(),
                      contact::tilts(membrane.mesh()));
    std::vector<char> start;
    ASSERT_TRUE(op->sweep(*basis, coefficients, {}, rows, start));
    std::vector<Answer> alone;
    for (const fem::Load& load : loads.loads) {
      alone.push_back(plain(*op, load));
    }
    for (std::size_t k = 0; k < count; ++k) {
      SCOPED_TRACE("row " + std::to_string(k));
      const std::span<const double> row(coefficients.data() + k * m, m);
      Scale scale;
      for (std::size_t j = 0; j < m; ++j) {
        scale.add(row[j], alone[j]);
      }
      const fem::Load combined = loads.combined(row);
      // What is held acts without loads as well.
      if (rich) scale.add(1, plain(*op, loads.combined(std::vector<double>(m, 0))));
      compare_row(*op, rows, k, plain(*op, combined), scale, tally);
    }
  }
  std::printf(
      "[ figures  ] %d rows, %d not converged, %d membranes refused, %d unsolvable, nodes: %d "
      "closed, %d open, %d undecided; %d slopes, %d held; energy %.1e, A %.1e, B %.1e, length "
      "%.1e, kkt %.1e\n",
      tally.rows, tally.not_converged, tally.refused, tally.unsolvable, tally.closed, tally.open,
      tally.undecided, tally.tilting, tally.held, tally.energy, tally.displacement, tally.slope,
      tally.length, tally.kkt);
  const double tolerance = condensed_up_to > 1 ? 1e-11 : 1e-10;
  EXPECT_LT(tally.energy, tolerance);
  EXPECT_LT(tally.displacement, tolerance);
  EXPECT_LT(tally.slope, tolerance);
  EXPECT_LT(tally.length, tolerance);
  EXPECT_EQ(tally.tilting > 100, rich);
  EXPECT_EQ(tally.held > 100, rich);
}

INSTANTIATE_TEST_SUITE_P(Membranes, Sweep,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(operators::default_condensed_up_to,
                                                              std::size_t{0}, std::size_t{1})),
                         [](const auto& instance) {
                           return std::string(std::get<0>(instance.param) ? "Rich" : "Plain") +
                                  testing::path_name(std::get<1>(instance.param));
                         });

}  // namespace
}  // namespace anticrack::reference
