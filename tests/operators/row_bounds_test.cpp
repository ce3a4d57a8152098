// SPDX-License-Identifier: GPL-3.0-or-later
//
// Bounds of rows by shared products: against those by the fluxes that the products stand for,
// against exact solutions, and against finer meshes, also for jumps and pressures that are no
// solution.
#include "operators/row_bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <random>

#include "base/at.hpp"
#include "contact/answer.hpp"
#include "mesh/refine_uniform.hpp"
#include "operators/displacement_bounds.hpp"
#include "operators/sweep_support.hpp"
#include "reference/random_membrane.hpp"
#include "support/random_seed.hpp"

namespace anticrack::operators {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using estimate::Side;

/// Loads of every kind that rows share bounds for. If not `balanced`, the last one and the traction
/// are not; the first two are alike, to cancel.
std::vector<fem::Load> loads_on(const mesh::Mesh& mesh, bool balanced) {
  std::vector<fem::Load> loads(4);
  loads[0].force = 1.0;
  if (reference::has_neumann(mesh)) loads[0].traction = balanced ? "0.5" : "1 - 5*x";
  loads[1] = loads[0];
  loads[1].force = 1.02;
  loads[2].force = fem::Expression{"x - 2*y"};
  loads[2].boundary_value = "0.1*x - 0.05*y";
  loads[3].force =
      fem::Expression{balanced ? "y" : "3*sin(2*x + 5*y) + (2*x + 5*y > 20.3 ? 1 : 0)"};
  const std::vector<char> tilts = reference::tilting(mesh);
  for (std::size_t j = 0; j < mesh.inclusions.size(); ++j) {
    loads[2].inclusion_forces[mesh.inclusions[j]] = j % 2 == 0 ? 0.7 : -1;
    if (tilts[j] != 0) loads[3].inclusion_moments[mesh.inclusions[j]] = {0.2, -0.3};
  }
  return loads;
}

std::vector<const fem::Load*> pointers(const std::vector<fem::Load>& loads) {
  std::vector<const fem::Load*> result;
  for (const fem::Load& load : loads) result.push_back(&load);
  return result;
}

/// A number with its bounds.
struct Known {
  double value, lower, upper;
  double width() const { return upper - lower; }
  double middle() const { return (lower + upper) / 2; }
};

/// The energy, then A of each inclusion, of the bounds that a combination has alone.
std::vector<Known> alone(const MeshOperator& op, const LoadBasis& basis,
                         std::span<const double> c) {
  const PreparedLoad load = op.combine(basis, c);
  Silent silent;
  contact::Answer answer = op.solve(load, {}, false, silent);
  if (answer.status != contact::Status::converged) return {};
  op.estimate(load, answer);
  if (!answer.energy_lower) return {};
  std::vector<Known> all{{answer.energy_mesh, *answer.energy_lower, *answer.energy_upper}};
  for (const contact::InclusionAnswer& one : answer.inclusions) {
    if (!one.displacement_lower) return {};
    all.push_back({one.displacement_mesh, *one.displacement_lower, *one.displacement_upper});
  }
  return all;
}

std::vector<Known> of_row(const contact::SweepColumns& rows, std::size_t row) {
  if (rows.status[row] != contact::Status::converged || std::isnan(rows.energy_lower[row]))
    return {};
  std::vector<Known> all{{rows.energy_mesh[row], rows.energy_lower[row], rows.energy_upper[row]}};
  for (std::size_t i = row * rows.inclusions; i < (row + 1) * rows.inclusions; ++i)
    all.push_back(
        {rows.displacement_mesh[i], rows.displacement_lower[i], rows.displacement_upper[i]});
  return all;
}

/// Both hold the same exact number.
void expect_common(const Known& a, const Known& b) {
  const double rounding = 1e-9 * (std::abs(a.value) + std::abs(b.value)) + 1e-12;
  EXPECT_LE(a.lower, b.upper + rounding);
  EXPECT_GE(a.upper, b.lower - rounding);
}

std::shared_ptr<const mesh::Mesh> refined(const mesh::Mesh& mesh, int times) {
  mesh::Mesh fine = mesh;
  for (int i = 0; i < times; ++i) fine = mesh::refine_uniform(fine);
  return std::make_shared<const mesh::Mesh>(std::move(fine));
}

double quantile(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Rows of all kinds: random ones, none, a part, nearly the last one, the opposite, loads that
/// cancel, and a small multiple.
std::vector<double> rows_of(std::size_t loads, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> c;
  const auto add = [&](const auto& value) {
    for (std::size_t j = 0; j < loads; ++j) c.push_back(value(j));
  };
  for (int i = 0; i < 6; ++i) add([&](std::size_t) { return normal(random); });
  const std::vector<double> last(c.end() - static_cast<std::ptrdiff_t>(loads), c.end());
  add([&](std::size_t) { return 0.0; });
  add([&](std::size_t j) { return j % 2 == seed % 2 ? normal(random) : 0; });
  add([&](std::size_t j) { return last[j] * (1 + 1e-9 * normal(random)); });
  add([&](std::size_t j) { return -last[j]; });
  add([&](std::size_t j) { return j == 0 ? 1.02 : j == 1 ? -1 : 0.01 * last[j]; });
  add([&](std::size_t j) { return 1e-6 * last[j]; });
  return c;
}

struct Tally {
  std::vector<double> energies, displacements;  // widths, relative to those of the loads alone
  std::size_t contacts_changed = 0, meshes = 0, without = 0;
};

/// Rows that share bounds against the same loads alone, and on the mesh two levels finer.
void check_rows(unsigned seed, Tally& tally) {
  constexpr std::uint64_t many = 1'000'000;
  const reference::RandomMembrane membrane(seed, seed % 2 == 1);
  const auto mesh = refined(membrane.mesh(), 1), fine_mesh = refined(membrane.mesh(), 3);
  const std::vector<fem::Load> loads = loads_on(*mesh, seed % 5 == 0);
  Operator op, fine;
  std::shared_ptr<const LoadBasis> shared, own, finer;
  try {
    op = MeshOperator::factorise(mesh, 1, {});
    if (!op->shares_bounds(loads.size(), many)) return;
    fine = MeshOperator::factorise(fine_mesh, 1, {});
    shared = op->basis(pointers(loads), {}, true, many);
    own = op->basis(pointers(loads), {}, true);
    finer = fine->basis(pointers(loads), {}, true);
  } catch (const errors::Error&) {
    return;  // nothing holds a part, or the boundary holds a rigid one at several values
  }
  const std::vector<double> c = rows_of(loads.size(), seed);
  contact::SweepColumns rows(c.size() / loads.size(), mesh->inclusions.size(),
                             op->contact_nodes().size(), contact::tilts(*mesh), true);
  std::vector<char> start;
  ASSERT_TRUE(op->sweep(*shared, c, {}, rows, start));
  std::size_t with = 0, without = 0;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const auto own_c = std::span(c).subspan(row * loads.size(), loads.size());
    const std::vector<Known> found = of_row(rows, row), expected = alone(*op, *own, own_c),
                             truth = alone(*fine, *finer, own_c);
    (found.empty() ? without : with) += expected.empty() ? 0 : 1;
    if (found.empty() || expected.empty() || truth.empty()) continue;
    const auto contact = [&](std::size_t of) {
      return std::span(rows.contact).subspan(of * rows.contacts, rows.contacts);
    };
    if (row > 0 && !std::ranges::equal(contact(row), contact(row - 1))) ++tally.contacts_changed;
    for (std::size_t i = 0; i < found.size(); ++i) {
      SCOPED_TRACE("row " + std::to_string(row) + ", number " + std::to_string(i));
      const double size = std::abs(expected[i].value) + expected[i].width();
      EXPECT_NEAR(found[i].value, expected[i].value, 1e-9 * size);
      expect_common(found[i], expected[i]);
      expect_common(found[i], truth[i]);
      EXPECT_LE(found[i].lower, found[i].value + 1e-9 * size);
      EXPECT_GE(found[i].upper, found[i].value - 1e-9 * size);
      // Pi falls from mesh to mesh, but not below the exact one.
      if (i == 0) {
        EXPECT_LE(found[i].lower, truth[i].value + 1e-9 * size);
      }
      if (std::ranges::all_of(own_c, [](double one) { return one == 0; })) {
        EXPECT_EQ(found[i].lower, 0);
        EXPECT_EQ(found[i].upper, 0);
      } else if (expected[i].width() > 1e-9 * size) {
        (i == 0 ? tally.energies : tally.displacements)
            .push_back(found[i].width() / expected[i].width());
      }
    }
  }
  tally.meshes += with > 0 ? 1 : 0;
  tally.without += with > 0 ? without : 0;  // else fluxes are not in equilibrium, as at crossings
}

TEST(RowBounds, HoldOnFinerMeshesAndAreAboutThoseOfTheLoadsAlone) {
  const unsigned first = testing::random_seed();
  const char* const seeds = std::getenv("ANTICRACK_SEEDS");  // 600 by hand
  const unsigned count = seeds != nullptr ? static_cast<unsigned>(std::atoi(seeds)) : 24;
  Tally tally;
  for (unsigned seed = first; seed < first + count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    check_rows(seed, tally);
  }
  const std::size_t numbers = tally.energies.size() + tally.displacements.size();
  std::printf(
      "[ figures  ] seeds from %u: %zu meshes, %zu energies, %zu A, %zu changes of contact, %zu "
      "rows with bounds only alone; widths against alone: energy %.2f (95 %%: %.2f), A %.2f "
      "(%.2f)\n",
      first, tally.meshes, tally.energies.size(), tally.displacements.size(),
      tally.contacts_changed, tally.without, quantile(tally.energies, 0.5),
      quantile(tally.energies, 0.95), quantile(tally.displacements, 0.5),
      quantile(tally.displacements, 0.95));
  ASSERT_GT(tally.energies.size(), std::size_t{2} * count);
  ASSERT_GT(tally.displacements.size(), std::size_t{2} * count);
  EXPECT_GT(tally.contacts_changed, std::size_t{1} * count);
  EXPECT_LT(tally.without, numbers / 100);
  EXPECT_LT(quantile(tally.energies, 0.5), 1.2);
  EXPECT_LT(quantile(tally.displacements, 0.5), 1.2);
  EXPECT_LT(quantile(tally.energies, 0.95), 1.5);
  EXPECT_LT(quantile(tally.displacements, 0.95), 2.5);
}

/// What rows of loads share, with the pieces of which it is made.
struct Made {
  std::shared_ptr<const mesh::Mesh> mesh;
  MeshOperator::Parts parts;
  std::vector<LoadOnTraces> condensed;
  std::vector<BalancedLoad> balances;
  contact::SweepLoads reduced;
  std::shared_ptr<const SharedBounds> shared;

  Made(std::shared_ptr<const mesh::Mesh> of, const std::vector<fem::Load>& loads)
      : mesh(std::move(of)), parts(mesh, 1, default_condensed_up_to) {
    const std::vector<const fem::Load*> all = pointers(loads);
    for (CondensedOutcome& one :
         condense_loads(all, *mesh, parts.decomposition, parts.condense(), parts.neumann, true)) {
      if (const auto* error = std::get_if<errors::Error>(&one)) throw errors::Error(*error);
      condensed.push_back(std::get<LoadOnTraces>(std::move(one)));
    }
    balances = balanced(all, condensed, parts.decomposition.subdomains, parts.cut_mesh());
    std::vector<contact::CaseLoads> cases;
    for (const LoadOnTraces& load : condensed)
      cases.push_back({load.subdomains, load.inclusion_forces});
    const auto count = static_cast<Index>(cases.size());
    Eigen::MatrixXd constants = Eigen::MatrixXd::Zero(count, count);
    for (std::size_t s = 0; s < parts.decomposition.subdomains.size(); ++s) {
      std::vector<const ddm::CondensedLoad*> here;
      for (const LoadOnTraces& load : condensed) here.push_back(&load.subdomains[s]);
      constants += ddm::products(here, parts.contact->condensed()).energy;
    }
    reduced = contact::reduce(*parts.contact, cases, constants);
    shared = shared_bounds(parts, condensed, balances, reduced);
  }

  /// Jumps d >= 0 and pressures lambda >= 0 of the load c, which need not solve it, and the
  /// contacts that z_0 has closed.
  struct Row {
    VectorXd c, d, lambda;
    std::vector<char> closed;
  };
  VectorXd reaction(const VectorXd& c, const VectorXd& d) const {
    return shared->stiffness() * d - reduced.r * c;
  }
  Row solved(const VectorXd& c) const {
    const VectorXd r = reduced.r * c;
    contact::LcpAnswer solution =
        parts.contact->solve_contact({{}, {}, {}, r, r.cwiseAbs(), 1}, {}, {}, {});
    return {c, solution.d.head(r.size()), solution.lambda.head(r.size()), solution.closed};
  }
  /// Pressures on all contacts that keep the sides apart.
  Row pushed(const VectorXd& c, double by) const {
    const VectorXd r = reduced.r * c, free = (shared->softness * r).cwiseMax(0.0),
                   missing = (r - shared->stiffness() * free).cwiseMax(0.0);
    const VectorXd& mass = parts.problem.pair_forces().contact_mass();
    const VectorXd d =
        (free + shared->softness * (missing + by * r.lpNorm<1>() / mass.sum() * mass))
            .cwiseMax(0.0);
    Row row{c, d, reaction(c, d).cwiseMax(0.0), {}};
    for (Index i = 0; i < d.size(); ++i) row.closed.push_back(d[i] > 0 ? 0 : 1);
    return row;
  }

  double displacement(const Row& row, std::size_t goal) const {
    return reduced.motion.row(static_cast<Index>(shared->inclusion[goal])).dot(row.c) +
           shared->unit[goal].r.dot(row.d);
  }
  double energy(const Row& row) const {
    return row.c.dot(reduced.energy * row.c) - row.d.dot(reduced.r * row.c) +
           0.5 * row.d.dot(shared->stiffness() * row.d);
  }
  std::vector<Known> bounds(const Row& row, RowBounds& of) const {
    contact::LcpAnswer answer;
    answer.d = row.d;
    answer.lambda = row.lambda;
    answer.closed = row.closed;
    contact::SweepColumns rows(1, mesh->inclusions.size(), 0, false, true);
    rows.status[0] = contact::Status::converged;
    rows.energy[0] = energy(row) - 0.5 * row.d.dot(reaction(row.c, row.d));  // as SweepSolver
    for (std::size_t k = 0; k < shared->inclusion.size(); ++k)
      rows.displacement[shared->inclusion[k]] = displacement(row, k);
    of.find({row.c.data(), at(row.c.size())}, answer, 0, rows);
    std::vector<Known> known = of_row(rows, 0);
    if (!known.empty()) known[0].value = energy(row);
    return known;
  }
  std::vector<Known> bounds(const Row& row) const {
    RowBounds of(parts, *shared, reduced);
    return bounds(row, of);
  }

  /// u of a row in the copies.
  std::vector<double> field(const Row& row) const {
    const ddm::Terms none;
    std::vector<double> u = field(none, row.d);
    for (Index j = 0; j < row.c.size(); ++j) {
      const LoadOnTraces& load = condensed[at(j)];
      const contact::Reduced closed = parts.contact->reduce(
          load.subdomains, contact::held_values(parts.decomposition, load.subdomains), true);
      contact::Answer answer;
      for (const VectorXd& trace : parts.problem.scatter(
               parts.contact->values(closed.x, VectorXd::Zero(row.d.size()), closed.p)))
        answer.side_traces.emplace_back(trace.begin(), trace.end());
      const contact::SolvedCase one{load.subdomains, answer};
      parts.contact->recover_fields({&one, 1});
      const std::vector<double> of_load = of_copies(answer.fields);
      for (std::size_t i = 0; i < u.size(); ++i) u[i] += row.c[j] * of_load[i];
    }
    return u;
  }
  /// The response to a unit force and jumps.
  std::vector<double> field(const ddm::Terms& force, const VectorXd& jumps) const {
    const contact::Displaced one{&force, jumps};
    return parts.contact->fields_of({&one, 1}).front();
  }
};

/// How often each term of the bounds was there to be compared.
struct Compared {
  int pressures = 0, works = 0, tractions = 0, cones = 0, shifts = 0, turns = 0, unknown = 0,
      energies = 0, displacements = 0;
};

/// Compares the bounds of a row with the same made of fluxes and fields.
class Comparison {
 public:
  Comparison(const Made& made, const Made::Row& row, bool balanced, Compared& tally)
      : _made(made),
        _cut(made.parts.cut_mesh()),
        _row(row),
        _balanced(balanced),
        _tally(tally),
        _load(combine(made.balances, {row.c.data(), at(row.c.size())})),
        _u(made.field(row)) {
    for (const Aim& goal : aims(made.parts))
      if (goal.scale != nullptr) _goals.push_back(goal);
  }

  /// Where no flux is turned, sigma and tau are made fan by fan, and bound as for a load case.
  void of_load_case() {
    SharedBounds still = *_made.shared;
    still.pressures.turns.clear();
    still.pressures.overlap.resize(0, 0);
    still.unbalanced.overlap.resize(0, 0);
    still.turning.resize(0, still.flux.cols());
    RowBounds rows(_made.parts, still, _made.reduced);
    const std::vector<Known> known = _made.bounds(_row, rows);
    if (known.empty()) return;
    const estimate::EquilibratedFlux sigma = this->sigma();
    const estimate::Bracket bracket =
        estimate::bracket(_cut, sigma, _load.balance, {}, _u, known[0].value);
    expect_as_wide(-known[0].lower, -bracket.lower, 1e-9 * size(sigma), _balanced);
    EXPECT_NEAR(known[0].upper, bracket.upper, 1e-9 * size(sigma));
    ++_tally.energies;
    _tally.pressures += bracket.work > 1e-6 * size(sigma) ? 1 : 0;
    const std::vector<estimate::Lift> none;
    const estimate::Primal primal{_cut, sigma, _load.balance, none, _u};
    for_each(rows, known, [&](const RowBounds::Found& found, std::size_t k, Side side) {
      const std::vector<double> z = field(k, found.pair.jumps),
                                reacting = field(k, found.pair.reacting);
      const std::vector<estimate::ForceOn> unit = _goals[k].unit(_made.mesh->inclusions.size());
      const estimate::Aimed aimed{
          &primal, {z, reacting, _made.displacement(_row, k), side, found.most, unit}};
      const estimate::Bound &bound = found.bound,
                            expected = estimate::bound(aimed, tau(reacting, found.pair));
      const double off = std::sqrt(size(sigma)), scale = off * found.pair.terms;
      const double sign = side == Side::upper ? 1 : -1;
      EXPECT_NEAR(bound.middle, expected.middle, 1e-9 * (scale + std::abs(bound.middle)));
      expect_as_wide(bound.c * off, expected.c * off, 1e-7 * found.pair.terms, !sums());
      EXPECT_NEAR(bound.half.dual, expected.half.dual, 1e-9 * square(found.pair.terms));
      expect_as_wide(bound.half.primal, expected.half.primal, 1e-9 * size(sigma), _balanced);
      expect_as_wide(bound.half.mixed, expected.half.mixed, 1e-9 * scale, _balanced);
      const auto beside = [&](const estimate::Bound& of) {
        return sign * (of.value - of.middle) - of.half(of.c);
      };
      expect_as_wide(beside(bound), beside(expected), 1e-9 * scale, _balanced);
      _tally.unknown += beside(expected) > 1e-7 * scale ? 1 : 0;
      ++_tally.displacements;
      _tally.cones += bound.c * std::sqrt(bound.half.primal) > std::sqrt(bound.half.dual) ? 1 : 0;
      _tally.shifts += found.pair.shift.size() > 0 ? 1 : 0;
      _tally.works += std::abs(work(found.pair)) > 1e-6 * scale ? 1 : 0;
      _tally.tractions += std::abs(traction(found.pair, k)) > 1e-6 * scale ? 1 : 0;
    });
  }

  /// What is turned against integrals of the same, triangle by triangle, where all is constant.
  void of_turns() {
    if (!_balanced || std::ranges::any_of(_cut.tilts, [](char one) { return one != 0; })) return;
    RowBounds rows(_made.parts, *_made.shared, _made.reduced);
    const std::vector<Known> known = _made.bounds(_row, rows);
    if (known.empty()) return;
    const estimate::EquilibratedFlux sigma = this->sigma();
    const Means x = means(sigma, rows.pressure());
    double distance = square(x);
    for (std::size_t t = 0; t < x.size(); ++t)
      distance += sigma.distance()[t] - estimate::dot(sigma.mean(t), sigma.mean(t));
    const double pressure = faces().work(rows.pressure().ends, _row.d);
    const double parts = _made.reduced.parts_energy({_row.c.data(), at(_row.c.size())});
    EXPECT_NEAR(known[0].lower, known[0].value - distance / 2 - pressure,
                1e-9 * (size(sigma) + parts));
    _tally.turns += rows.pressure().by.norm() > 0 ? 1 : 0;
    for_each(rows, known, [&](const RowBounds::Found& found, std::size_t k, Side) {
      const RowBounds::Pair& pair = found.pair;
      const std::vector<double> z = field(k, pair.jumps), reacting = field(k, pair.reacting);
      Means w = means(tau(reacting, pair), pair.turned);
      std::vector<double> rest(z.size());
      for (std::size_t i = 0; i < z.size(); ++i) rest[i] = reacting[i] - z[i];
      double mixed = 0;
      for (std::size_t t = 0; t < w.size(); ++t) {
        const estimate::Vector rise = sigma.rise_of(t, rest);
        w[t][0] -= sigma.tension(t) * rise[1];
        w[t][1] += sigma.tension(t) * rise[0];
        mixed += estimate::dot(w[t], x[t]) / 2;
      }
      const double middle = _made.displacement(_row, k) + work(pair) + traction(pair, k) -
                            pair.jumps.dot(_row.lambda) + mixed;
      const double scale = std::sqrt(size(sigma)) * pair.terms + std::abs(middle);
      EXPECT_NEAR(found.bound.middle, middle, 1e-9 * scale);
      EXPECT_NEAR(found.bound.half.primal, distance / 4 + pressure, 1e-9 * size(sigma));
      EXPECT_NEAR(found.bound.half.dual, square(w) / 4, 1e-9 * square(pair.terms));
    });
  }

 private:
  using Means = std::vector<estimate::Vector>;

  static double square(double x) { return x * x; }
  static double square(const Means& x) {
    double sum = 0;
    for (const estimate::Vector& one : x) sum += estimate::dot(one, one);
    return sum;
  }
  const FacePressures& faces() const { return _made.shared->pressures; }
  double size(const estimate::EquilibratedFlux& sigma) const {
    return sigma.norm_squared() + std::abs(_made.energy(_row));
  }
  std::vector<double> field(std::size_t goal, const VectorXd& jumps) const {
    return _made.field(_goals[goal].goal, jumps);
  }
  double work(const RowBounds::Pair& pair) const { return faces().work(pair.turned.ends, _row.d); }
  double traction(const RowBounds::Pair& pair, std::size_t goal) const {
    const Eigen::MatrixXd& of = _made.shared->traction;
    const Index n = _made.shared->contacts;
    return (pair.jumps.transpose() * of.topRows(n) + of.row(n + static_cast<Index>(goal)))
        .dot(_row.c);
  }
  /// The flux with the pressure of these forces, not turned.
  estimate::EquilibratedFlux flux(const estimate::Balance& of, const VectorXd& forces) const {
    const std::vector<double> through =
        faces().through(_cut.faces.size(), faces().divided(forces).ends);
    return {_cut, of, {through, through}};
  }
  estimate::EquilibratedFlux sigma() const {
    return flux({_u, _load.balance.force, _load.balance.traction}, _row.lambda);
  }
  estimate::EquilibratedFlux tau(const std::vector<double>& reacting,
                                 const RowBounds::Pair& pair) const {
    return flux({reacting, {}, {}}, pair.forces);
  }
  /// The means of a flux less its field, turned, times sqrt(area / T).
  Means means(const estimate::EquilibratedFlux& of, const FacePressures::Turned& turned) const {
    Means all;
    for (std::size_t t = 0; t < _cut.triangle_count(); ++t) all.push_back(of.mean(t));
    for (Index k = 0; k < turned.by.size(); ++k) {
      const std::size_t fan = faces().turns[at(k)].fan;
      for (auto n = at(_cut.first_corner[fan]); n < at(_cut.first_corner[fan + 1]); ++n) {
        const estimate::FanCorner& corner = _cut.shapes.around[n];
        for (const std::size_t i : {0, 1})
          all[at(corner.triangle)][i] += turned.by[k] * corner.edge[i];
      }
    }
    return all;
  }
  /// Whether interfaces cross so that [u] is a sum of jumps, each of which a row keeps in the cone.
  bool sums() const {
    return std::ranges::any_of(
        faces().ends, [](const FacePressures::End& end) { return end.last - end.first > 1; });
  }
  static void expect_as_wide(double found, double expected, double rounding, bool exactly) {
    EXPECT_GE(found, expected - rounding);
    if (exactly) {
      EXPECT_LE(found, expected + rounding);
    }
  }
  template <class Compare>
  void for_each(const RowBounds& rows, const std::vector<Known>& known, const Compare& compare) {
    auto found = rows.found().begin();
    for (std::size_t k = 0; k < _goals.size(); ++k) {
      const Known& one = known[1 + _goals[k].inclusion];
      if (one.lower == one.upper) continue;  // held
      for (const Side side : {Side::lower, Side::upper}) compare(*found++, k, side);
    }
  }

  const Made& _made;
  const estimate::CutMesh& _cut;
  const Made::Row& _row;
  bool _balanced;
  Compared& _tally;
  BalancedLoad _load;
  std::vector<double> _u;
  std::vector<Aim> _goals;
};

TEST(RowBounds, AreThoseOfTheFluxesThatTheyStandFor) {
  Compared tally;
  for (unsigned seed = 0; seed < 32; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const reference::RandomMembrane membrane(seed, seed % 2 == 1);
    const auto mesh = refined(membrane.mesh(), 0);
    const bool balanced = seed % 3 != 0;
    std::optional<Made> made;
    try {
      made.emplace(mesh, loads_on(*mesh, balanced));
    } catch (const errors::Error&) {
      continue;
    }
    if (!made->shared) continue;
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 8; ++i) {
      SCOPED_TRACE("row " + std::to_string(i));
      const VectorXd c = VectorXd::NullaryExpr(4, [&] { return normal(random); });
      Made::Row row = i % 2 == 0 ? made->solved(c) : made->pushed(c, 0.2 * i);
      if (i % 2 == 1)
        for (char& one : row.closed) one = static_cast<char>(random() % 2);
      Comparison comparison(*made, row, balanced, tally);
      comparison.of_load_case();
      comparison.of_turns();
    }
  }
  std::printf(
      "[ figures  ] %d energies, %d A; with p [u] %d, turned %d, q [u] %d, tractions %d, in cones "
      "%d, clipped %d, unknown %d\n",
      tally.energies, tally.displacements, tally.pressures, tally.turns, tally.works,
      tally.tractions, tally.cones, tally.shifts, tally.unknown);
  for (const int term : {tally.pressures, tally.turns, tally.works, tally.tractions, tally.cones,
                         tally.shifts, tally.unknown})
    EXPECT_GT(term, 10);
}

/// Bounds from jumps d >= 0 and pressures lambda >= 0 that no load has hold on finer meshes.
TEST(RowBounds, HoldForJumpsAndPressuresThatAreNoSolution) {
  std::size_t tested = 0;
  for (unsigned seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const reference::RandomMembrane membrane(seed, seed % 2 == 1);
    const auto mesh = refined(membrane.mesh(), 1);
    const std::vector<fem::Load> loads = loads_on(*mesh, false);
    std::optional<Made> made;
    Operator fine;
    try {
      made.emplace(mesh, loads);
      if (!made->shared) continue;
      fine = MeshOperator::factorise(refined(membrane.mesh(), 3), 1, {});
    } catch (const errors::Error&) {
      continue;
    }
    const auto finer = fine->basis(pointers(loads), {}, true);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 4; ++i) {
      const VectorXd c = VectorXd::NullaryExpr(4, [&] { return normal(random); });
      const std::vector<Known> truth = alone(*fine, *finer, {c.data(), at(c.size())});
      if (truth.empty()) continue;
      Made::Row row = made->pushed(c, i);
      if (i % 2 == 1)
        row.lambda = row.lambda.cwiseProduct(VectorXd::Random(row.d.size()).cwiseAbs());
      const std::vector<Known> found = made->bounds(row);
      if (found.empty()) continue;
      ++tested;
      for (std::size_t k = 0; k < found.size(); ++k) {
        SCOPED_TRACE("row " + std::to_string(i) + ", number " + std::to_string(k));
        expect_common(found[k], truth[k]);
      }
      EXPECT_LE(found[0].lower, truth[0].value + 1e-9 * std::abs(truth[0].value));
    }
  }
  EXPECT_GT(tested, 40U);
}

/// A strip held at its lower and upper edge, at heights 0 and `rise`, with an inclusion across all
/// of it that is glued above; nothing depends on x, and u is linear on both sides. T = 1; each side
/// is a spring of stiffness 2. All fluxes are exact, so only jumps, pressures and what lacks
/// remain.
struct Strip {
  static constexpr double spring = 2;
  double rise = 0, force = 0, jump = 0;
  double pressure() const { return spring * (displacement() - rise) - force; }  ///< lambda of d
  double displacement() const { return (rise + jump + force / spring) / 2; }
  double energy() const {
    const double a = displacement(), minus = a - jump;
    return spring / 2 * ((rise - a) * (rise - a) + minus * minus) - force * a;
  }
  Strip solution() const { return {rise, force, std::max(0.0, rise + force / spring)}; }
};

Made strip() {
  mesh::Mesh mesh =
      testing::structured_mesh({8, 2, [](double) { return mesh::Kind::delaminated; }, {}, {"bar"}});
  std::erase_if(mesh.dirichlet, [&](const auto& edge) {
    return mesh.xy[2 * at(edge[0])] == mesh.xy[2 * at(edge[1])];
  });
  std::vector<fem::Load> loads(2);
  loads[0].force = 0.0;
  loads[0].boundary_value = "0.5 + 0.5*y";
  loads[1].force = 0.0;
  loads[1].inclusion_forces["bar"] = 1;
  return {std::make_shared<const mesh::Mesh>(std::move(mesh)), loads};
}

TEST(RowBounds, OfAStripAreWhatJumpsAndPressuresMakeOfThem) {
  const Made made = strip();
  ASSERT_TRUE(made.shared);
  const Index n = made.shared->contacts;
  int exact_ones = 0;
  for (const double rise : {-1.0, 1.0}) {
    for (const double jump : {0.2, 0.7, 1.5}) {
      for (const char closed : {char{0}, char{1}}) {
        const Strip of{rise, 0.4, jump}, exact = of.solution();
        SCOPED_TRACE(std::to_string(rise) + ", " + std::to_string(jump) +
                     (closed ? " closed" : ""));
        Made::Row row{Eigen::Vector2d(rise, of.force),
                      VectorXd::Constant(n, jump),
                      {},
                      std::vector<char>(at(n), closed)};
        const VectorXd reaction = made.reaction(row.c, row.d);
        ASSERT_NEAR(reaction.sum(), of.pressure(), 1e-12);
        row.lambda = reaction.cwiseMax(0.0);
        RowBounds bounds(made.parts, *made.shared, made.reduced);
        const std::vector<Known> found = made.bounds(row, bounds);
        ASSERT_EQ(found.size(), 2U);
        EXPECT_NEAR(found[0].value, of.energy(), 1e-12);
        EXPECT_NEAR(found[1].value, of.displacement(), 1e-12);
        EXPECT_LE(found[0].lower, exact.energy() + 1e-9);
        EXPECT_LE(found[1].lower, exact.displacement() + 1e-6);
        EXPECT_GE(found[1].upper, exact.displacement() - 1e-6);
        if (of.pressure() < 0) {
          // The contacts are pulled, which no pressure explains.
          const double unexplained = closed != 0 ? 0 : -of.pressure() / Strip::spring;
          for (const RowBounds::Found& one : bounds.found())
            EXPECT_GE(std::abs(one.bound.value - one.bound.middle),
                      one.bound.half(one.bound.c) + unexplained - 1e-9);
          continue;
        }
        // eta = 0: P alone is between the energies, and c P between mid and the upper bound of A.
        const double work = of.pressure() * jump;
        EXPECT_NEAR(found[0].lower, of.energy() - work, 1e-9);
        const double c = closed != 0 ? 0.5 / of.pressure() : 1 / (Strip::spring * jump);
        const double middle =
            of.displacement() - (closed != 0 ? jump / 2 : of.pressure() / Strip::spring);
        EXPECT_NEAR(found[1].lower, middle, 1e-5);
        if (bounds.found()[1].most < c) continue;  // clipped
        EXPECT_NEAR(found[1].upper, middle + c * work, 1e-5);
        ++exact_ones;
      }
    }
  }
  EXPECT_GT(exact_ones, 4);
}

/// Waves that no triangle sees: on the mesh there is next to no load.
TEST(RowBounds, HoldForALoadThatIsNotBalanced) {
  fem::Load wave;
  wave.force = fem::Expression{"100*cos(24*acos(-1)*x)"};
  fem::Load smooth;
  smooth.force = 0.01;
  const std::vector<fem::Load> loads{wave, smooth};
  const mesh::Mesh coarse = testing::structured_mesh({8, 2, {}, {}, {"bar"}});
  const Made made(std::make_shared<const mesh::Mesh>(coarse), loads);
  ASSERT_TRUE(made.shared);
  const Operator fine = MeshOperator::factorise(refined(coarse, 4), 1, {});
  const auto finer = fine->basis(pointers(loads), {}, true);
  const VectorXd c = VectorXd::Ones(2);
  const std::vector<Known> found = made.bounds(made.solved(c)),
                           truth = alone(*fine, *finer, {c.data(), 2});
  ASSERT_FALSE(found.empty() || truth.empty());
  for (std::size_t i = 0; i < found.size(); ++i) expect_common(found[i], truth[i]);
  // What is balanced alone would not reach the energy.
  EXPECT_LT(truth[0].value, 2 * found[0].value);
}

TEST(RowBounds, DoNotDependOnOtherRows) {
  const Operator op = MeshOperator::factorise(
      std::make_shared<const mesh::Mesh>(testing::structured_mesh({64, 16, {}, {}, {"bar"}})), 1,
      {});
  const std::vector<fem::Load> loads = loads_on(op->mesh(), false);
  constexpr std::size_t count = 12;
  ASSERT_TRUE(op->shares_bounds(4, 1'000'000));
  EXPECT_FALSE(op->shares_bounds(4, 1));
  const auto basis = op->basis(pointers(loads), {}, true, 1'000'000);
  std::vector<double> c(4 * count);
  std::mt19937 random(1);
  for (double& one : c) one = std::normal_distribution<double>()(random);
  const auto columns = [&](std::size_t rows) {
    return contact::SweepColumns(rows, 1, op->contact_nodes().size(), false, true);
  };
  contact::SweepColumns together = columns(count);
  std::vector<char> start;
  ASSERT_TRUE(op->sweep(*basis, c, {}, together, start));
  for (std::size_t row = 0; row < count; ++row) {
    contact::SweepColumns one = columns(1);
    start.clear();
    ASSERT_TRUE(op->sweep(*basis, std::span(c).subspan(4 * row, 4), {}, one, start));
    EXPECT_EQ(one.energy_lower[0], together.energy_lower[row]);
    EXPECT_EQ(one.displacement_lower[0], together.displacement_lower[row]);
    EXPECT_EQ(one.displacement_upper[0], together.displacement_upper[row]);
  }
}

}  // namespace
}  // namespace anticrack::operators
