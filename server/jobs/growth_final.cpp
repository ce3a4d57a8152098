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
#include "estimate/marking.hpp"
#include "jobs/portion_codec.hpp"
#include "jobs/spreading.hpp"
#include "mesh/refine.hpp"
#include "records/mesh_record.hpp"
#include "stop/stop.hpp"

namespace anticrack::jobs {
namespace {

using errors::Error;
using errors::Reason;
using growth::Bracket;
using operators::MeshOperator;
using operators::PreparedLoad;

constexpr double default_error = 0.05;
constexpr double unbounded = std::numeric_limits<double>::infinity();

constexpr int most_meshes = 12;  // of a position

/// After so many meshes whose bounds are hardly closer than those before there is no hope.
constexpr int most_in_vain = 3;
constexpr double hardly = 0.9;

bool bounded(const Bracket& energy) { return std::isfinite(energy.lower); }

/// Solves a position on meshes of its own.
class Position {
 public:
  /// `number`: over the positions of all load cases.
  Position(const LiveJob& job, meshes::MeshCatalogue& catalogue, const growth::Fronts& fronts,
           std::size_t number, const PositionRequest& request)
      : _job(job), _catalogue(catalogue), _fronts(fronts), _number(number), _request(request) {}

  SolvedPosition solve() {
    mesh::Mesh mesh = growth::mesh_of(_job.mesh_operator->mesh(), _fronts, _request.state);
    mesh.bisection_bound = _catalogue.get(_job.mesh).bisection_bound;
    _solved.energy.assign(_request.loads.size(), {-unbounded, unbounded});
    for (int k = 1;; ++k) {
      std::shared_ptr<const MeshOperator> op;
      try {
        op = _catalogue.operators_of({fmt::format("jobs/{}/{}/{}", _job.id(), _number, k),
                                      _job.created.owner, _job.mesh_operator->bytes()},
                                     std::make_shared<const mesh::Mesh>(std::move(mesh)),
                                     _job.stop.get_token());
      } catch (const Error& error) {
        const bool full =
            error.reason() == Reason::limit_exceeded || error.reason() == Reason::busy;
        if (!full || _job.helps) throw;
        _solved.reason = error.what();
        return _solved;
      }
      std::optional<mesh::Mesh> finer = add(*op, k < most_meshes);
      if (!finer) return _solved;
      mesh = std::move(*finer);
    }
  }

 private:
  PreparedLoad load_on(const MeshOperator& op, double t) const {
    const std::vector<fem::Load>& loads = _job.spec->loads;
    fem::Load load = loads[_number / at(_job.spec->growth->final_positions)];
    if (const std::string& dead = _job.spec->growth->dead; !dead.empty())
      load = fem::sum(*std::ranges::find(loads, dead, &fem::Load::name), t, load,
                      op.mesh().subdomains);
    return prepare_one(_job, op, load);
  }

  /// Solves on one mesh. Returns the next, if there is to be one.
  std::optional<mesh::Mesh> add(const MeshOperator& op, bool may_go_on) {
    const double before = width();
    std::vector<double> indicator;
    for (std::size_t i = 0; i < _request.loads.size(); ++i)
      if (!add(op, i, indicator)) return {};
    _in_vain = width() > hardly * before ? _in_vain + 1 : 0;
    if (width() <= _request.aim) return {};
    if (may_go_on && _in_vain < most_in_vain) return bisected(op.mesh(), indicator);
    _solved.reason = "finer meshes no longer help";
    return {};
  }

  /// Under one load. Adds to the indicator; false: there are no bounds.
  bool add(const MeshOperator& op, std::size_t i, std::vector<double>& indicator) {
    const std::stop_token stop = _job.stop.get_token();
    const PreparedLoad load = load_on(op, _request.loads[i]);
    contact::Answer answer = solve_quietly(_job, op, load);
    if (answer.status != contact::Status::converged) {
      _solved.reason = answer.reason;
      return false;
    }
    const PreparedLoad* const loads[] = {&load};
    contact::Answer* const answers[] = {&answer};
    op.recover_fields(loads, answers);
    MeshOperator::Estimate estimate{&load, &answer, stop};
    estimate.of_energy = true;
    op.estimate({&estimate, 1});
    if (estimate.failure) std::rethrow_exception(estimate.failure);
    if (i == 0 && _request.front >= 0) {
      op.find_tips(load, answer, stop);
      const std::size_t front = at(_request.front);
      const mesh::Point& place = _fronts.fronts[front].track.place[_request.state.at[front]];
      for (const contact::TipAnswer& tip : answer.tips)
        if (tip.x == place[0] && tip.y == place[1]) {
          _solved.release = tip.closed ? 0 : tip.energy_release_rate;
          _solved.no_release = tip.reason;
        }
    }
    if (!answer.energy_lower || !answer.energy_upper) {
      _solved.reason = answer.no_bracket;
      return false;
    }
    // Bounds of finer meshes count beside those before.
    Bracket& energy = _solved.energy[i];
    energy.lower = std::max(energy.lower, *answer.energy_lower);
    energy.upper = std::min(energy.upper, *answer.energy_upper);
    indicator.resize(estimate.indicator.size(), 0);
    for (std::size_t k = 0; k < indicator.size(); ++k) indicator[k] += estimate.indicator[k];
    return true;
  }

  double width() const {
    double width = 0;
    for (const Bracket& energy : _solved.energy)
      width = std::max(width, energy.upper - energy.lower);
    return width;
  }

  /// The next mesh; none, with the reason, beyond a limit.
  std::optional<mesh::Mesh> bisected(const mesh::Mesh& mesh, const std::vector<double>& indicator) {
    const double reduction = std::clamp(width() / _request.aim, 2., estimate::most_reduction);
    try {
      return mesh::refine(mesh, estimate::levels(indicator, reduction), _request.max_triangles);
    } catch (const Error& error) {
      if (error.reason() != Reason::limit_exceeded) throw;
      _solved.reason = fmt::format("a mesh may have {} triangles", _request.max_triangles);
      return {};
    }
  }

  const LiveJob& _job;
  meshes::MeshCatalogue& _catalogue;
  const growth::Fronts& _fronts;
  const std::size_t _number;
  const PositionRequest& _request;
  SolvedPosition _solved;
  int _in_vain = 0;  ///< the last meshes whose bounds are hardly closer
};

/// Throws errors::Error (limit_exceeded) where this server's limit would change the numbers, and
/// (storage) for a state of other fronts.
void require_solvable(const PositionRequest& request, const growth::Fronts& fronts,
                      const meshes::MeshCatalogue& catalogue) {
  const std::size_t count = fronts.fronts.size();
  const std::vector<std::size_t>& places = request.state.at;
  bool fits = places.size() == count && request.state.fate.size() == count &&
              request.front < static_cast<std::int64_t>(count);
  for (std::size_t i = 0; fits && i < count; ++i)
    fits = places[i] < fronts.fronts[i].track.place.size();
  if (!fits)
    throw Error(Reason::storage, "a position has other fronts than its job: submit the job again");
  if (request.max_triangles != catalogue.max_triangles())
    throw Error(Reason::limit_exceeded, "a mesh may have {} triangles here, and {} for this job",
                catalogue.max_triangles(), request.max_triangles);
}

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

EndedChunk solve_position(const Task& task, meshes::MeshCatalogue& catalogue) {
  EndedChunk ended{task};
  const LiveJob& job = *task.job;
  const stop::Scope scope(job.stop.get_token());
  try {
    const PositionRequest request = unpack_request(task.request);
    const growth::Fronts fronts =
        growth::find_fronts(job.mesh_operator->mesh(), job.spec->growth->paths);
    require_solvable(request, fronts, catalogue);
    ended.position = pack(Position(job, catalogue, fronts, task.index, request).solve());
  } catch (...) {
    const Error error = error_of(std::current_exception());
    if (error.reason() != Reason::cancelled) ended.failure = error;
  }
  return ended;
}

void add_final(const PreparedCase& prepared, EngineCore& core, const growth::Fronts& fronts,
               const std::vector<growth::Row>& rows, const std::vector<GrownState>& states,
               contact::Answer& answer, const std::function<void(std::size_t)>& told) {
  const JobPtr& job = prepared.task.job;
  const records::GrowthSpec& spec = *job->spec->growth;
  const double error = spec.final_error > 0 ? spec.final_error : default_error;
  const std::vector<std::size_t> chosen = final_rows(rows, at(spec.final_positions));
  std::vector<SolvedPosition> found(chosen.size());
  const bool driven = !spec.dead.empty();
  const mesh::Mesh& open = job->mesh_operator->mesh();
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
    double least = unbounded;
    if (k > 0) least = freed(k - 1);
    if (k + 1 < chosen.size()) least = std::min(least, freed(k));
    return error * least;
  };
  const auto fill = [&](std::size_t k) {
    contact::GrowthRow& row = answer.growth[chosen[k]];
    row.g1_final = found[k].release;
    const Bracket& energy = found[k].energy.front();
    if (bounded(energy) && row.load) {
      const double scale = driven ? 1 : *row.load * *row.load;
      row.energy_lower = energy.lower * scale;
      row.energy_upper = energy.upper * scale;
    }
    if (k + 1 == chosen.size() || !bounded(energy) || !bounded(found[k + 1].energy.back())) return;
    const growth::MeanRelease mean =
        growth::mean_release(energy, found[k + 1].energy.back(), between(k));
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
  const auto request_of = [&](std::size_t k) {
    return PositionRequest{states[chosen[k]].state, rows[chosen[k]].leader, loads_of(k), aim_of(k),
                           core.catalogue.max_triangles()};
  };
  const std::size_t first = prepared.task.index * at(spec.final_positions);
  if (core.queue != nullptr) {
    std::vector<store::Portion> portions;
    for (std::size_t k = 0; k < chosen.size(); ++k)
      portions.push_back({first + k, first + k, 1, pack(request_of(k))});
    solve_portions(core, job, portions, [&](std::size_t k, const std::string& body) {
      found[k] = unpack_position(body, loads_of(k).size());
      in_order.done(k);
    });
  } else {
    base::at_once(chosen.size(), base::Threads::allowed(), [&] {
      return [&](std::size_t k) {
        const PositionRequest request = request_of(k);
        found[k] = Position(*job, core.catalogue, fronts, first + k, request).solve();
        in_order.done(k);
      };
    });
  }
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto note = [&](const char* what, const std::string& why) {
      answer.growth_notes.push_back(fmt::format("row {} has {}: {}", chosen[k], what, why));
    };
    if (!found[k].reason.empty())
      note(bounded(found[k].energy.front()) ? "no closer bounds" : "no bounds", found[k].reason);
    if (!found[k].release && !found[k].no_release.empty()) note("no G1_final", found[k].no_release);
  }
}

}  // namespace anticrack::jobs
