// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/growth_final.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "contact/observer.hpp"
#include "estimate/marking.hpp"
#include "growth/held.hpp"
#include "mesh/refine.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::jobs {
namespace {

using errors::Error;
using errors::Reason;
using growth::Bracket;
using operators::MeshOperator;
using operators::PreparedLoad;

constexpr double default_error = 0.05;

constexpr int most_meshes = 12;  // of a position

/// After so many meshes whose bounds are hardly closer than those before there is no hope.
constexpr int most_in_vain = 3;
constexpr double hardly = 0.9;

/// Reduction of the indicators from one mesh to the next.
constexpr double least_reduction = 2, most_reduction = 8;

/// What was found in a position.
struct Position {
  std::vector<std::optional<Bracket>> energy;  ///< of Pi under each load
  std::optional<double> release;  ///< G under the first load of the front that leaves it
  std::string no_release;         ///< why it is missing
  std::string reason;             ///< why there are no bounds, or no closer ones
  int in_vain = 0;                ///< the last meshes whose bounds are hardly closer
};

class Quiet : public contact::Observer {
 public:
  explicit Quiet(std::stop_token stop) : _stop(std::move(stop)) {}
  bool on_iteration(const contact::Sample&) override { return !_stop.stop_requested(); }

 private:
  const std::stop_token _stop;
};

/// Solves states of one load case, each on meshes of its own. Thread-safe.
class Positions {
 public:
  Positions(const PreparedCase& prepared, meshes::MeshCatalogue& catalogue,
            const growth::Fronts& fronts)
      : _task(prepared.task),
        _job(*prepared.task.job),
        _catalogue(catalogue),
        _fronts(fronts),
        _options(std::get<contact::ActiveSetOptions>(_job.spec->solver)),
        _bisection_bound(catalogue.get(_job.mesh).bisection_bound) {}

  /// `front`: the one that leaves; -1: none. `loads`: t of each; without a dead load all are the
  /// load case itself. `aim`: bounds of Pi as far apart will do.
  Position solve(std::size_t number, const growth::State& state, int front,
                 const std::vector<double>& loads, double aim) const {
    mesh::Mesh mesh = growth::mesh_of(_job.mesh_operator->mesh(), _fronts, state);
    mesh.bisection_bound = _bisection_bound;
    Position position;
    position.energy.resize(loads.size());
    for (int k = 1;; ++k) {
      std::shared_ptr<const MeshOperator> op;
      try {
        op = _catalogue.operators_of(
            {fmt::format("jobs/{}/{}/{}/{}", _job.id(), _task.index, number, k), _job.created.owner,
             _job.mesh_operator->bytes()},
            std::make_shared<const mesh::Mesh>(std::move(mesh)), _job.stop.get_token());
      } catch (const Error& error) {
        if (error.reason() != Reason::limit_exceeded && error.reason() != Reason::busy) throw;
        position.reason = error.what();
        return position;
      }
      std::optional<mesh::Mesh> finer =
          add(*op, state, front, loads, aim, k < most_meshes, position);
      if (!finer) return position;
      mesh = std::move(*finer);
    }
  }

 private:
  PreparedLoad load_on(const MeshOperator& op, double t) const {
    const std::vector<fem::Load>& loads = _job.spec->loads;
    fem::Load load = loads[_task.index];
    if (const std::string& dead = _job.spec->growth->dead; !dead.empty())
      load = fem::sum(*std::ranges::find(loads, dead, &fem::Load::name), t, load,
                      op.mesh().subdomains);
    const fem::Load* const one[] = {&load};
    auto outcome = std::move(op.prepare(one, _job.stop.get_token()).front());
    if (const auto* error = std::get_if<Error>(&outcome)) throw Error(*error);
    return std::get<PreparedLoad>(std::move(outcome));
  }

  /// Solves on one mesh. Returns the next, if there is to be one.
  std::optional<mesh::Mesh> add(const MeshOperator& op, const growth::State& state, int front,
                                const std::vector<double>& loads, double aim, bool may_go_on,
                                Position& position) const {
    const double before = width_of(position);
    std::vector<double> indicator;
    for (std::size_t i = 0; i < loads.size(); ++i)
      if (!add(op, state, i == 0 ? front : -1, loads[i], position.energy[i], indicator, position))
        return {};
    const double width = width_of(position);
    position.in_vain = width > hardly * before ? position.in_vain + 1 : 0;
    if (width <= aim) return {};
    if (may_go_on && position.in_vain < most_in_vain)
      return bisected(op.mesh(), indicator, width / aim, position);
    position.reason = "finer meshes no longer help";
    return {};
  }

  /// Under one load. Adds to the indicator; false: there are no bounds.
  bool add(const MeshOperator& op, const growth::State& state, int front, double t,
           std::optional<Bracket>& energy, std::vector<double>& indicator,
           Position& position) const {
    const std::stop_token stop = _job.stop.get_token();
    const PreparedLoad load = load_on(op, t);
    Quiet quiet(stop);
    contact::Answer answer = op.solve(load, _options, false, quiet);
    if (answer.status == contact::Status::cancelled)
      throw Error(Reason::cancelled, "stopped while solving a position of growth");
    if (answer.status != contact::Status::converged) {
      position.reason = answer.reason;
      return false;
    }
    const PreparedLoad* const loads[] = {&load};
    contact::Answer* const answers[] = {&answer};
    op.recover_fields(loads, answers);
    MeshOperator::Estimate estimate{&load, &answer, stop};
    estimate.of_energy = true;
    op.estimate({&estimate, 1});
    if (estimate.failure) std::rethrow_exception(estimate.failure);
    if (front >= 0) {
      op.find_tips(load, answer, stop);
      const growth::Front& leader = _fronts.fronts[at(front)];
      const mesh::Point& place = leader.track.place[state.at[at(front)]];
      for (const contact::TipAnswer& tip : answer.tips)
        if (tip.x == place[0] && tip.y == place[1]) {
          position.release = tip.closed ? 0 : tip.energy_release_rate;
          position.no_release = tip.reason;
        }
    }
    if (!answer.energy_lower || !answer.energy_upper) {
      position.reason = answer.no_bracket;
      return false;
    }
    // Bounds of finer meshes count beside those before.
    if (!energy) energy = {*answer.energy_lower, *answer.energy_upper};
    energy->lower = std::max(energy->lower, *answer.energy_lower);
    energy->upper = std::min(energy->upper, *answer.energy_upper);
    indicator.resize(estimate.indicator.size(), 0);
    for (std::size_t k = 0; k < indicator.size(); ++k) indicator[k] += estimate.indicator[k];
    return true;
  }

  static double width_of(const Position& position) {
    double width = 0;
    for (const std::optional<Bracket>& energy : position.energy)
      width = std::max(
          width, energy ? energy->upper - energy->lower : std::numeric_limits<double>::infinity());
    return width;
  }

  /// The next mesh; none, with the reason, beyond a limit.
  std::optional<mesh::Mesh> bisected(const mesh::Mesh& mesh, const std::vector<double>& indicator,
                                     double excess, Position& position) const {
    const double reduction = std::clamp(excess, least_reduction, most_reduction);
    try {
      return mesh::refine(mesh, estimate::levels(indicator, reduction), _catalogue.max_triangles());
    } catch (const Error& error) {
      if (error.reason() != Reason::limit_exceeded) throw;
      position.reason = fmt::format("a mesh may have {} triangles", _catalogue.max_triangles());
      return {};
    }
  }

  const Task& _task;
  const LiveJob& _job;
  meshes::MeshCatalogue& _catalogue;
  const growth::Fronts& _fronts;
  const contact::ActiveSetOptions _options;
  const double _bisection_bound;
};

/// How far all fronts have come in a row.
double way_of(const growth::Row& row, const growth::Row& first) {
  double way = 0;
  for (std::size_t i = 0; i < row.position.size(); ++i)
    way += std::abs(row.position[i] - first.position[i]);
  return way;
}

/// The positions of the job that are done, from the first one on.
class InOrder {
 public:
  InOrder(std::size_t count, std::function<void(std::size_t)> next)
      : _done(count, 0), _next(std::move(next)) {}
  void done(std::size_t i) {
    const std::lock_guard lock(_mutex);
    _done[i] = 1;
    for (; _told < _done.size() && _done[_told] != 0; ++_told) _next(_told);
  }

 private:
  std::mutex _mutex;
  std::vector<char> _done;
  std::size_t _told = 0;
  const std::function<void(std::size_t)> _next;
};

}  // namespace

std::vector<std::size_t> final_rows(const std::vector<growth::Row>& rows, std::size_t count) {
  std::vector<std::size_t> found;
  if (rows.empty()) return found;
  const double all = way_of(rows.back(), rows.front());
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = all * static_cast<double>(k) / static_cast<double>(count - 1);
    const auto nearest = std::ranges::min_element(rows, {}, [&](const growth::Row& row) {
      return std::abs(way_of(row, rows.front()) - wanted);
    });
    const std::size_t row = k + 1 == count ? rows.size() - 1 : at(nearest - rows.begin());
    if (found.empty() || row > found.back()) found.push_back(row);
  }
  return found;
}

void add_final(const PreparedCase& prepared, meshes::MeshCatalogue& catalogue,
               const growth::Fronts& fronts, const std::vector<growth::Row>& rows,
               const std::vector<GrownState>& states, contact::Answer& answer,
               const std::function<void(std::size_t)>& told) {
  const records::GrowthSpec& spec = *prepared.task.job->spec->growth;
  const double error = spec.final_error > 0 ? spec.final_error : default_error;
  const std::vector<std::size_t> chosen = final_rows(rows, at(spec.final_positions));
  const Positions positions(prepared, catalogue, fronts);
  std::vector<Position> found(chosen.size());
  const bool driven = !spec.dead.empty();
  const mesh::Mesh& open = prepared.task.job->mesh_operator->mesh();
  const auto between = [&](std::size_t k) {
    return growth::opened(open, fronts, spec.paths, states[chosen[k]].state,
                          states[chosen[k + 1]].state);
  };
  const auto freed = [&](std::size_t k) {  // between two positions, on the mesh of all
    return driven ? between(k).cost_lower : states[chosen[k]].energy - states[chosen[k + 1]].energy;
  };
  // Beside a dead load energies are those under the load of a row: from one to the next both have
  // them under that of the first.
  std::vector<double> load_of(chosen.size(), 1);
  for (std::size_t k = 0; driven && k < chosen.size(); ++k) {
    double highest = 0;
    for (std::size_t row = 0; row < chosen[k]; ++row) highest = std::max(highest, rows[row].load);
    load_of[k] = rows[chosen[k]].leader < 0 ? highest : rows[chosen[k]].load;
  }
  const auto loads_of = [&](std::size_t k) {
    std::vector<double> loads{load_of[k]};
    if (driven && k > 0) loads.push_back(load_of[k - 1]);
    return loads;
  };
  const auto aim_of = [&](std::size_t k) {
    double least = std::numeric_limits<double>::infinity();
    if (k > 0) least = freed(k - 1);
    if (k + 1 < chosen.size()) least = std::min(least, freed(k));
    return error * least;
  };
  const auto fill = [&](std::size_t k) {
    contact::GrowthRow& row = answer.growth[chosen[k]];
    row.g1_final = found[k].release;
    const std::optional<Bracket>& energy = found[k].energy.front();
    if (energy && row.load) {
      const double scale = driven ? 1 : *row.load * *row.load;
      row.energy_lower = energy->lower * scale;
      row.energy_upper = energy->upper * scale;
    }
    if (k + 1 == chosen.size() || !energy || !found[k + 1].energy.back()) return;
    const growth::MeanRelease mean =
        growth::mean_release(*energy, *found[k + 1].energy.back(), between(k));
    row.g1_lower = mean.lower;
    row.g1_upper = mean.upper;
    if (driven) return;  // G is not as the square of the load
    row.load_lower = mean.load_lower;
    row.load_upper = mean.load_upper;
  };
  InOrder in_order(chosen.size(), [&](std::size_t k) {  // a row needs the position after it
    if (k > 0) {
      fill(k - 1);
      told(chosen[k - 1]);
    }
    if (k + 1 == chosen.size()) {
      fill(k);
      told(chosen[k]);
    }
  });
  base::at_once(chosen.size(), base::Threads::allowed(), [&] {
    return [&](std::size_t k) {
      const std::size_t row = chosen[k];
      found[k] = positions.solve(k, states[row].state, rows[row].leader, loads_of(k), aim_of(k));
      in_order.done(k);
    };
  });
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto note = [&](const char* what, const std::string& why) {
      answer.growth_notes.push_back(fmt::format("row {} has {}: {}", chosen[k], what, why));
    };
    if (!found[k].reason.empty())
      note(found[k].energy.front() ? "no closer bounds" : "no bounds", found[k].reason);
    if (!found[k].release && !found[k].no_release.empty()) note("no G1_final", found[k].no_release);
  }
}

}  // namespace anticrack::jobs
