// SPDX-License-Identifier: GPL-3.0-or-later
//
// Rows of a sweep as MeshOperator solves them.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "operators/answer_difference.hpp"
#include "operators/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::operators {
namespace {

using anticrack::testing::throws;
using contact::ActiveSetOptions;
using contact::Status;
using contact::SweepColumns;
using errors::Reason;

/// A way through the coefficients with turns, zeros and repeated rows.
std::vector<double> coefficients(std::size_t rows, std::size_t m) {
  std::vector<double> result;
  for (std::size_t k = 0; k < rows * m; ++k) {
    const auto row = static_cast<double>(k / m % 17), column = static_cast<double>(k % m);
    result.push_back(k / m % 7 == 3 ? 0 : std::cos(1.3 * row + column) + 0.2 * column);
  }
  return result;
}

template <class Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), sizeof(Value) * a.size()) == 0);
}

/// All but the steps, which a better start saves.
void expect_same_bits(const SweepColumns& a, const SweepColumns& b) {
  EXPECT_EQ(a.status, b.status);
  EXPECT_TRUE(same_bits(a.energy, b.energy));
  EXPECT_TRUE(same_bits(a.contact_length, b.contact_length));
  EXPECT_TRUE(same_bits(a.kkt, b.kkt));
  EXPECT_TRUE(same_bits(a.displacement, b.displacement));
  EXPECT_TRUE(same_bits(a.contact, b.contact));
}

/// All rows in one call, from an empty start, which becomes that of the last row.
SweepColumns swept(const MeshOperator& op, const LoadBasis& basis, const std::vector<double>& c,
                   std::vector<char>& start) {
  SweepColumns rows = columns(op, c.size() / basis.size());
  EXPECT_TRUE(op.sweep(basis, c, {}, rows, start));
  return rows;
}

TEST(Sweep, StartsAndCompanyChangeNoBit) {
  const Operator op = factorised();
  const auto basis = basis_of(*op, three_loads());
  constexpr std::size_t count = 60, m = 3;
  const std::vector<double> c = coefficients(count, m);
  std::vector<char> start;
  const SweepColumns whole = swept(*op, *basis, c, start);
  EXPECT_EQ(start.size(), op->contact_nodes().size());
  for (const char closed : {char{0}, char{1}}) {
    SweepColumns other = columns(*op, count);
    std::vector<char> all(start.size(), closed);
    ASSERT_TRUE(op->sweep(*basis, c, {}, other, all));
    EXPECT_EQ(all, start);
    expect_same_bits(other, whole);
  }
  for (std::size_t k = 0; k < count; ++k) {
    SweepColumns alone = columns(*op, 1);
    std::vector<char> empty;
    ASSERT_TRUE(op->sweep(*basis, std::span(c).subspan(k * m, m), {}, alone, empty));
    EXPECT_EQ(alone.energy[0], whole.energy[k]);
    EXPECT_EQ(alone.displacement[0], whole.displacement[k]);
    EXPECT_GE(alone.steps[0], whole.steps[k] == 1 ? 1 : 0);
  }
}

/// Random, and what may upset an order of directions: nothing, one load, tiny and opposite rows.
std::vector<double> mixed_coefficients() {
  std::vector<double> c = {0,  0, 0,      0,       -0.0,   0,      0,     3, 0,  0,
                           -3, 0, 1e-300, -2e-300, 5e-301, 1,      2,     3, -1, -2,
                           -3, 4, 8,      12,      1e120,  -2e120, 5e119, 0, 0,  4e-320};
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  while (c.size() < 3 * std::size_t{300}) c.push_back(normal(random));
  return c;
}

TEST(Sweep, TheOrderOfTheRowsChangesNoBit) {
  const Operator op = factorised();
  const auto basis = basis_of(*op, three_loads());
  const std::vector<double> c = mixed_coefficients();
  std::vector<char> start;
  const SweepColumns wanted = swept(*op, *basis, c, start);
  std::vector<std::size_t> from(wanted.rows());
  std::iota(from.begin(), from.end(), std::size_t{0});
  std::mt19937_64 random(5);
  for (int times = 0; times < 3; ++times) {
    std::ranges::shuffle(from, random);
    std::vector<double> shuffled;
    for (const std::size_t row : from)
      shuffled.insert(shuffled.end(), &c[3 * row], &c[3 * row] + 3);
    start.clear();
    const SweepColumns rows = swept(*op, *basis, shuffled, start);
    SweepColumns back = columns(*op, from.size());
    for (std::size_t k = 0; k < from.size(); ++k) {
      back.status[from[k]] = rows.status[k];
      back.energy[from[k]] = rows.energy[k];
      back.contact_length[from[k]] = rows.contact_length[k];
      back.kkt[from[k]] = rows.kkt[k];
      back.displacement[from[k]] = rows.displacement[k];
      std::copy_n(&rows.contact[k * rows.contacts], rows.contacts,
                  &back.contact[from[k] * rows.contacts]);
    }
    expect_same_bits(back, wanted);
  }
}

/// Neighbours of random rows are alike only because of the order.
TEST(Sweep, RandomRowsTakeFewSteps) {
  const Operator op = factorised();
  const auto basis = basis_of(*op, three_loads());
  const std::vector<double> c = mixed_coefficients();
  std::vector<char> start;
  const SweepColumns rows = swept(*op, *basis, c, start);
  long ordered = 0, as_given = 0;
  std::vector<char> last;
  for (std::size_t k = 0; k < rows.rows(); ++k) {
    SweepColumns one = columns(*op, 1);
    ASSERT_TRUE(op->sweep(*basis, std::span(c).subspan(3 * k, 3), {}, one, last));
    as_given += one.steps[0];
    ordered += rows.steps[k];
  }
  EXPECT_LT(ordered, 0.75 * static_cast<double>(as_given));
}

TEST(Sweep, RowsOfPreparedLoadsAreTheirPlainAnswers) {
  const Operator op = factorised();
  const std::vector<fem::Load> loads = three_loads();
  std::vector<PreparedLoad> prepared;
  for (const fem::Load& load : loads) {
    const fem::Load* const one[] = {&load};
    prepared.push_back(std::get<PreparedLoad>(std::move(op->prepare(one).front())));
  }
  SweepColumns rows = columns(*op, loads.size());
  std::vector<char> start;
  ASSERT_TRUE(op->sweep(prepared, {}, rows, start));
  Silent silent;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    const contact::Answer answer = testing::solve(*op, loads[k], ActiveSetOptions{}, false, silent);
    EXPECT_EQ(rows.status[k], answer.status);
    EXPECT_NEAR(rows.energy[k], answer.energy, 1e-12 * std::abs(answer.energy));
    EXPECT_NEAR(rows.displacement[k], answer.inclusions[0].displacement, 1e-12);
    EXPECT_NEAR(rows.contact_length[k], answer.contact_length, 1e-12);
    for (std::size_t n = 0; n < rows.contacts; ++n) {
      const auto [interface, node] = op->contact_nodes()[n];
      EXPECT_EQ(rows.contact[k * rows.contacts + n],
                answer.traces[static_cast<std::size_t>(interface)]
                    .contact[static_cast<std::size_t>(node)]);
    }
  }
}

TEST(Sweep, ACombinationIsALoadWithoutFields) {
  const Operator op = factorised();
  std::vector<fem::Load> loads(2);
  loads[0].force = 2.0;
  loads[0].boundary_value = "x";
  loads[1].force = fem::Expression{"y"};
  loads[1].boundary_value = "y - 1";
  loads[1].inclusion_forces["bar"] = 1;
  const auto basis = basis_of(*op, loads);
  fem::Load same;
  same.force = fem::Expression{"-3*2 + 0.5*y"};
  same.boundary_value = "-3*x + 0.5*(y - 1)";
  same.inclusion_forces["bar"] = 0.5;
  const double c[] = {-3, 0.5};
  Silent silent;
  const PreparedLoad row = op->combine(*basis, c);
  for (const contact::SolverOptions& options :
       {contact::SolverOptions(ActiveSetOptions{}), contact::SolverOptions([] {
          contact::UzawaOptions uzawa;
          uzawa.theta.reset();
          return uzawa;
        }())}) {
    const contact::Answer a = testing::solve(*op, row, options, false, silent);
    const contact::Answer b = testing::solve(*op, same, options, false, silent);
    EXPECT_EQ(a.status, Status::converged);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_NEAR(a.criterion, b.criterion, 1e-6 * b.criterion + 1e-15);
    EXPECT_LT(difference(a, b), 1e-11);
    EXPECT_NEAR(a.inclusions[0].resultant, 0.5, 1e-9);
  }
  EXPECT_TRUE(throws([&] { op->solve(row, ActiveSetOptions{}, true, silent); }, Reason::internal));
  UzawaBlock block(op, contact::Mass::lumped, 1);
  EXPECT_TRUE(
      throws([&] { block.add(op->combine(*basis, c), {}, true, silent); }, Reason::internal));
}

TEST(Sweep, ARowThatCannotBeSolvedHasNoNumbersAndHarmsNoOther) {
  const Operator op = factorised();
  const auto basis = basis_of(*op, three_loads());
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> c = {1, 2, 3, 1e300, 1e300, 0, infinite, 0, 0, 1, 2, 3};
  SweepColumns rows = columns(*op, 4);
  std::fill(rows.energy.begin(), rows.energy.end(), std::nan(""));
  std::vector<char> start;
  ASSERT_TRUE(op->sweep(*basis, c, {}, rows, start));
  EXPECT_EQ(rows.status, (std::vector{Status::converged, Status::not_converged,
                                      Status::not_converged, Status::converged}));
  EXPECT_EQ(rows.energy[1], 0);
  EXPECT_EQ(rows.energy[2], 0);
  EXPECT_EQ(rows.energy[3], rows.energy[0]);
  EXPECT_EQ(rows.steps[3], 1);

  ActiveSetOptions hasty;
  hasty.max_steps = 1;
  SweepColumns one = columns(*op, 1);
  std::vector<char> closed;
  ASSERT_TRUE(op->sweep(*basis, std::vector<double>{0, 1, 0}, hasty, one, closed));
  EXPECT_EQ(one.status[0], Status::not_converged);
  EXPECT_EQ(one.steps[0], 1);
}

TEST(Sweep, StopsBetweenTwoRows) {
  const Operator op = factorised();
  const auto basis = basis_of(*op, three_loads());
  constexpr std::size_t count = 100, m = 3;
  const std::vector<double> c = coefficients(count, m);
  std::vector<char> wanted_start;
  const SweepColumns wanted = swept(*op, *basis, c, wanted_start);
  std::stop_source stop;
  SweepColumns rows = columns(*op, count);
  {
    std::atomic<bool> begun{false};
    std::jthread sweeping([&] {
      std::vector<char> start;
      do {  // only a stop ends this
        rows = columns(*op, count);
        begun = true;
      } while (op->sweep(*basis, c, {}, rows, start, stop.get_token()));
    });
    while (!begun) {
      std::this_thread::yield();
    }
    stop.request_stop();
  }
  // Rows that were solved before the stop are whole, the others untouched.
  for (std::size_t k = 0; k < count; ++k)
    EXPECT_EQ(rows.energy[k], rows.steps[k] > 0 ? wanted.energy[k] : 0);
  EXPECT_TRUE(std::ranges::count(rows.steps, 0) > 0);
  const std::vector<fem::Load> loads = three_loads();
  const fem::Load* const one[] = {&loads[0]};
  std::vector<PreparedLoad> prepared;
  prepared.push_back(std::get<PreparedLoad>(std::move(op->prepare(one).front())));
  SweepColumns row = columns(*op, 1);
  std::vector<char> start;
  EXPECT_FALSE(op->sweep(prepared, {}, row, start, stop.get_token()));
  EXPECT_TRUE(op->sweep(prepared, {}, row, start));
}

/// BLAS complains on standard output of matrices without entries.
TEST(Sweep, NeedsNeitherCrackNorInclusion) {
  for (const mesh::Kind kind : {mesh::Kind::glue, mesh::Kind::crack}) {
    const Operator op = MeshOperator::factorise(
        std::make_shared<const mesh::Mesh>(anticrack::testing::structured_mesh(
            {24,
             8,
             [=](double x) { return std::abs(x) < 0.5 ? kind : mesh::Kind::glue; },
             {},
             {}})),
        1, {});
    std::vector<fem::Load> loads = three_loads();
    loads[2].inclusion_forces.clear();
    SweepColumns rows = columns(*op, 1);
    std::vector<char> start;
    Silent silent;
    ::testing::internal::CaptureStdout();
    EXPECT_TRUE(op->sweep(*basis_of(*op, loads), std::vector<double>{1, -1, 2}, {}, rows, start));
    testing::solve(*op, loads[0], ActiveSetOptions{}, false, silent);
    EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(rows.status[0], Status::converged);
  }
}

TEST(Sweep, RefusesWhatDoesNotFit) {
  const Operator op = factorised(), another = factorised();
  const auto basis = basis_of(*op, three_loads());
  std::vector<char> start;
  SweepColumns rows = columns(*op, 2);
  const std::vector<double> c = coefficients(2, 3);
  EXPECT_TRUE(throws([&] { another->sweep(*basis, c, {}, rows, start); }, Reason::internal));
  EXPECT_TRUE(
      throws([&] { op->sweep(*basis, coefficients(3, 3), {}, rows, start); }, Reason::internal));
  SweepColumns narrow(2, 1, 3);
  EXPECT_TRUE(throws([&] { op->sweep(*basis, c, {}, narrow, start); }, Reason::internal));
  std::vector<char> short_start(1, 0);
  EXPECT_TRUE(throws([&] { op->sweep(*basis, c, {}, rows, short_start); }, Reason::internal));
  EXPECT_TRUE(throws([&] { op->combine(*basis, c); }, Reason::internal));
}

TEST(Sweep, TwoThreadsAtOnceGetWhatOneGets) {
  const Operator op = factorised();
  constexpr std::size_t count = 300, m = 3;
  const std::vector<double> c = coefficients(count, m);
  std::vector<char> start;
  const SweepColumns wanted = swept(*op, *basis_of(*op, three_loads()), c, start);

  const Operator fresh = factorised();
  std::vector<SweepColumns> found(3, columns(*op, count));
  std::vector<std::shared_ptr<const LoadBasis>> bases(found.size());
  {
    std::barrier together(static_cast<std::ptrdiff_t>(found.size()));
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < found.size(); ++i) {
      threads.emplace_back([&, i] {
        together.arrive_and_wait();
        bases[i] = basis_of(*fresh, three_loads());
        std::vector<char> mine;
        fresh->sweep(*bases[i], c, {}, found[i], mine);
        static_cast<void>(fresh->theta_star());
        static_cast<void>(fresh->bytes());
      });
    }
  }
  for (const SweepColumns& rows : found) {
    expect_same_bits(rows, wanted);
    EXPECT_EQ(rows.steps, wanted.steps);
  }
}

}  // namespace
}  // namespace anticrack::operators
