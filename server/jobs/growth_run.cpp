// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/growth_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <variant>

#include "contact/answer.hpp"
#include "expression/function.hpp"
#include "jobs/growth_final.hpp"
#include "jobs/result_block.hpp"
#include "operators/grow.hpp"

namespace anticrack::jobs {
namespace {

using errors::Error;
using errors::Reason;
using growth::Evolution;

constexpr std::size_t most_paths = 100;
constexpr std::int32_t default_positions = 200, most_positions = 1'000;

std::int32_t positions_of(const records::GrowthSpec& growth) {
  return growth.positions == 0 ? default_positions : growth.positions;
}

growth::Control control_of(const records::GrowthSpec& growth, const mesh::Mesh& mesh) {
  if (growth.inclusion.empty()) return {};
  const auto found = std::ranges::find(mesh.inclusions, growth.inclusion);
  if (found == mesh.inclusions.end())
    throw Error(Reason::invalid_argument,
                "the mesh has no inclusion \"{}\" whose displacement could be increased",
                growth.inclusion)
        .at("inclusion");
  return {static_cast<int>(found - mesh.inclusions.begin())};
}

/// The length that makes so many positions of all paths.
double step_of(const std::vector<growth::Track>& tracks, std::int32_t positions) {
  double length = 0;
  for (const growth::Track& track : tracks)
    length += std::abs(track.position.back() - track.position.front()) / (track.facing < 0 ? 1 : 2);
  return length / positions;
}

std::string shown(const growth::Track& track, double position) {
  return fmt::format("the front on \"{}\" at {}", track.name, errors::shown(position));
}

contact::GrowthRow row_of(const growth::Row& row, const growth::Measured& measured,
                          const growth::State& state, const Evolution& evolution, int inclusion) {
  contact::GrowthRow result;
  result.front = row.leader;
  result.contact_length = row.contact_length;
  if (row.leader < 0) return result;
  const auto i = static_cast<std::size_t>(row.leader);
  const growth::Track& track = evolution.tracks()[i];
  result.interface = track.name;
  result.position = row.position[i];
  result.x = track.place[state.at[i]][0];
  result.y = track.place[state.at[i]][1];
  result.load = row.load;
  if (!row.alone.empty()) result.g_dead = row.alone[i];
  if (!measured.displacement.empty())
    result.displacement = row.displacement[static_cast<std::size_t>(std::max(inclusion, 0))];
  result.g1 = row.G1[i];
  result.toughness = row.toughness[i];
  result.energy = row.energy;
  result.stable = row.stable;
  result.ties = static_cast<std::int32_t>(row.ties.size());
  return result;
}

/// What happened, in words.
std::vector<std::string> notes_on(const std::vector<growth::Row>& rows, const Evolution& evolution,
                                  growth::Control control) {
  std::vector<std::string> notes;
  const auto at_0 = std::ranges::find_if(
      rows, [](const growth::Row& row) { return row.leader >= 0 && row.load == 0; });
  if (at_0 != rows.end()) {
    const auto i = static_cast<std::size_t>(at_0->leader);
    notes.push_back(fmt::format("{} grows under the dead load alone, by which G is {} and Gc {}",
                                shown(evolution.tracks()[i], at_0->position[i]),
                                errors::shown(at_0->alone[i]), errors::shown(at_0->toughness[i])));
  }
  const char* const increased = control.inclusion < 0 ? "load" : "displacement";
  for (const growth::Jump& jump : growth::jumps(rows, control)) {
    const growth::Row& from = rows[jump.from];
    const auto i = static_cast<std::size_t>(from.leader);
    const std::string front = shown(evolution.tracks()[i], from.position[i]);
    if (jump.to) {
      const growth::Row& to = rows[*jump.to];
      notes.push_back(fmt::format(
          "{} runs at the {} {}, to row {}, where it stops; {} of the energy is not used", front,
          increased, errors::shown(from.control), *jump.to, errors::shown(jump.not_dissipated)));
      if (to.leader != from.leader) notes.back() += " (others move on the way)";
    } else {
      notes.push_back(fmt::format(
          "{} runs at the {} {} and does not stop on its path; {} of the energy is not used", front,
          increased, errors::shown(from.control), errors::shown(jump.not_dissipated)));
    }
  }
  for (const growth::Event& event : evolution.events()) {
    const growth::Track& track = evolution.tracks()[event.front];
    const std::string front = shown(track, track.position[evolution.state().at[event.front]]);
    switch (event.fate) {
      case growth::Fate::snapped:
        notes.push_back(front +
                        (track.facing < 0
                             ? " comes so near to the end that the rest comes off at once"
                             : " meets that from the other side: the rest comes off at once"));
        break;
      case growth::Fate::end_of_path:
        notes.push_back(front + " is at the end of its path");
        break;
      case growth::Fate::not_followed:
        notes.push_back(front + " is not followed further: G takes ten edges of room about it");
        break;
      case growth::Fate::grows:
        break;
    }
  }
  notes.push_back(evolution.ending());
  return notes;
}

/// l0 under the load 1 of the fronts that leave an open delaminated end, with a note on each.
std::vector<std::optional<double>> initial_lengths(const growth::Fronts& fronts,
                                                   const std::vector<contact::TipAnswer>& ends,
                                                   std::vector<std::string>& notes) {
  std::vector<std::optional<double>> lengths(ends.size());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const growth::Front& front = fronts.fronts[i];
    if (!front.leaves()) continue;
    std::string& note = notes.emplace_back(
        fmt::format("the crack on \"{}\" leaves a delaminated end: ", front.track.name));
    if (!ends[i].release_factor) {
      note += "no l0, as " + ends[i].reason;
    } else if (ends[i].closed) {
      note += "it is closed, so that nothing starts there at first";
    } else {
      const double power = 1 / (1 - 2 * *ends[i].exponent);
      lengths[i] = std::pow(*ends[i].release_factor / front.track.toughness.front(), power);
      note += fmt::format(
          "it starts under every load t, at first with the length l0 = {} t^{}, and is followed "
          "from the length {} on",
          errors::shown(*lengths[i]), errors::shown(2 * power), errors::shown(front.length));
    }
  }
  return lengths;
}

/// Fills in u of `count` rows, or, for 0, of the first, the last, and rows at which fronts begin to
/// run, or stop.
void add_membranes(const std::vector<growth::Row>& rows, const std::vector<GrownState>& states,
                   growth::Control control, std::int32_t count, operators::Growth& preview,
                   const std::stop_token& stop, contact::Answer& answer) {
  constexpr std::size_t most = 8;
  std::set<std::size_t> chosen{0, rows.size() - 1};
  if (count > 0)
    for (const std::size_t row : final_rows(rows, static_cast<std::size_t>(count)))
      chosen.insert(row);
  else
    for (const growth::Jump& jump : growth::jumps(rows, control))
      for (const std::size_t row : {jump.from, jump.to.value_or(jump.from)})
        if (chosen.size() < most) chosen.insert(row);
  for (const std::size_t row : chosen) {
    answer.membrane_rows.push_back(static_cast<std::int32_t>(row));
    const double load = rows[row].leader < 0 ? 1 : rows[row].load;
    for (const contact::Field& field : preview.fields(states[row].state, load, stop))
      answer.membranes.insert(answer.membranes.end(), field.u.begin(), field.u.end());
  }
  answer.fields = preview.fields(states[0].state, 1, stop);
}

/// The load that acts beside this one, if there is one.
std::optional<operators::PreparedLoad> dead_load(const PreparedCase& prepared,
                                                 const store::Store& store) {
  LiveJob& job = *prepared.task.job;
  const std::string& name = job.spec->growth->dead;
  if (name.empty() || job.spec->loads[prepared.task.index].name == name) return {};
  const fem::Load load =
      job.arrays.resolve(*std::ranges::find(job.spec->loads, name, &fem::Load::name), store);
  return prepare_one(job, *job.mesh_operator, load);
}

contact::Answer grown(const PreparedCase& prepared, EngineCore& core, contact::Observer& observer) {
  const LiveJob& job = *prepared.task.job;
  const records::GrowthSpec& spec = *job.spec->growth;
  const std::stop_token stop = job.stop.get_token();
  const growth::Control control = control_of(spec, job.mesh_operator->mesh());
  std::optional<operators::PreparedLoad> dead = dead_load(prepared, core.store);
  const bool driven = dead.has_value();
  operators::Growth preview(job.mesh_operator, prepared.load, spec.paths, stop, std::move(dead));
  std::vector<growth::Track> tracks = preview.tracks();
  const double step = step_of(tracks, positions_of(spec));
  Evolution evolution(std::move(tracks), control, step);
  contact::Answer answer = preview.answer(
      evolution.state(), std::get<contact::ActiveSetOptions>(job.spec->solver), observer);
  if (answer.status != contact::Status::converged) return answer;
  if (job.spec->loads[prepared.task.index].name == spec.dead) {
    answer.growth_notes.push_back("it acts beside each of the other loads, and is not scaled");
    return answer;
  }
  std::vector<std::optional<double>> initial =
      initial_lengths(preview.fronts(), preview.ends(stop), answer.growth_notes);
  std::vector<growth::Row> rows;
  std::vector<GrownState> states;
  const auto tell = [&](std::size_t row) {
    job.log->append(GrowthEvent{static_cast<std::int32_t>(prepared.task.index),
                                static_cast<std::int32_t>(row),
                                std::make_shared<const contact::GrowthRow>(answer.growth[row])});
  };
  while (!evolution.over()) {
    const growth::State state = evolution.state();
    const growth::Measured measured =
        driven ? preview.measure(state, evolution.sought(), stop) : preview.measure(state, stop);
    const std::optional<growth::Row> row = evolution.take(measured);
    if (!row) continue;
    answer.growth.push_back(row_of(*row, measured, state, evolution, control.inclusion));
    if (row->leader >= 0)  // of its first row only
      std::swap(answer.growth.back().initial_length,
                initial[static_cast<std::size_t>(row->leader)]);
    tell(rows.size());
    rows.push_back(*row);
    states.push_back({state, measured.energy});
  }
  std::ranges::copy(notes_on(rows, evolution, control), std::back_inserter(answer.growth_notes));
  if (job.spec->fields && !rows.empty())
    add_membranes(rows, states, control, spec.membranes, preview, stop, answer);
  if (spec.final_positions > 0)
    add_final(prepared, core, preview.fronts(), rows, states, answer, tell);
  return answer;
}

/// The load that acts beside the others.
void check_dead(const records::JobSpec& spec) {
  const records::GrowthSpec& growth = *spec.growth;
  const auto refuse = [&](const std::string& why) {
    throw Error(Reason::invalid_argument, why).at("growth.dead");
  };
  const auto dead = std::ranges::find(spec.loads, growth.dead, &fem::Load::name);
  if (dead == spec.loads.end())
    refuse(fmt::format("no load is named \"{}\": name the one that is not scaled", growth.dead));
  if (spec.loads.size() == 1)
    refuse(
        fmt::format("\"{}\" is the only load: add one that is increased beside it", growth.dead));
  if (!growth.inclusion.empty())
    refuse("beside a dead load only the load can be increased: leave inclusion out");
  if (growth.final_positions == 0) return;
  for (const fem::Load& load : spec.loads)
    if (const std::string why = fem::obstacle_to_sum(dead->force, load.force); !why.empty())
      refuse(fmt::format(
          "f of \"{}\" and of \"{}\" cannot be summed on the meshes of positions, as {}: give both "
          "as an expression",
          growth.dead, load.name, why));
}

void check_final(const records::JobSpec& spec) {
  const records::GrowthSpec& growth = *spec.growth;
  if (growth.final_positions < 2 || growth.final_positions > most_positions)
    throw Error(Reason::invalid_argument, "{} positions with bounds: take 2 to {}",
                growth.final_positions, most_positions)
        .at("growth.final_positions");
  if (growth.final_error != 0 && !(growth.final_error >= 1e-3 && growth.final_error <= 1))
    throw Error(Reason::invalid_argument, "{:g} is no error of G1: give a relative one, 0.001 to 1",
                growth.final_error)
        .at("growth.final_error");
  if (spec.without_bounds)
    throw Error(Reason::invalid_argument,
                "positions of growth have bounds: leave one of the two out")
        .at("without_bounds");
  for (std::size_t i = 0; i < spec.loads.size(); ++i)
    if (std::holds_alternative<fem::Array>(spec.loads[i].force))
      throw Error(Reason::invalid_argument,
                  "an array belongs to one mesh, and positions of growth have their own: give f as "
                  "an expression")
          .at(fmt::format("load_cases[{}].force", i));
}

}  // namespace

void check_growth(const records::JobSpec& spec, const EngineOptions& options) {
  const records::GrowthSpec& growth = *spec.growth;
  if (growth.paths.empty())
    throw Error(Reason::invalid_argument, "growth needs at least one path").at("growth.paths");
  if (growth.paths.size() > most_paths)
    throw Error(Reason::limit_exceeded, "{} paths: growth may have {}", growth.paths.size(),
                most_paths)
        .at("growth.paths");
  if (growth.positions != 0 && (growth.positions < 2 || growth.positions > most_positions))
    throw Error(Reason::invalid_argument, "{} positions: take 2 to {}", growth.positions,
                most_positions)
        .at("growth.positions");
  constexpr std::int32_t most_membranes = 100;
  if (growth.membranes != 0 && (growth.membranes < 2 || growth.membranes > most_membranes))
    throw Error(Reason::invalid_argument, "{} membranes: take 2 to {}", growth.membranes,
                most_membranes)
        .at("growth.membranes");
  if (growth.membranes != 0 && !spec.fields)
    throw Error(Reason::invalid_argument,
                "membranes of positions are u in their nodes: ask for the output fields, too")
        .at("growth.membranes");
  if (growth.final_positions != 0) check_final(spec);
  if (!growth.dead.empty()) check_dead(spec);
  for (std::size_t i = 0; i < growth.paths.size(); ++i) {
    const growth::Path& path = growth.paths[i];
    const std::string field = fmt::format("growth.paths[{}].toughness", i);
    if (path.toughness.empty())
      throw Error(Reason::invalid_argument,
                  "Gc is missing; write a number above 0, or an "
                  "expression in x and y")
          .at(field);
    if (path.toughness.size() > options.max_expression_bytes)
      throw Error(Reason::limit_exceeded, "Gc has {} bytes and may have {}", path.toughness.size(),
                  options.max_expression_bytes)
          .at(field);
    const expression::Function checked(path.toughness, field);
  }
  if (!std::holds_alternative<contact::ActiveSetOptions>(spec.solver))
    throw Error(Reason::invalid_argument,
                "growth takes the method \"active-set\": fronts are contacts that are tied")
        .at("solver.uzawa");
  if (spec.indicators)
    throw Error(Reason::invalid_argument, "a job with growth has no indicators: leave them out")
        .at("outputs");
  if (!spec.probes.empty())
    throw Error(Reason::invalid_argument, "a job with growth has no probes: leave them out")
        .at("probes");
  constexpr std::uint64_t a_row = 270;  // 22 numbers and a name
  const auto rows = static_cast<std::uint64_t>(positions_of(growth)) * spec.loads.size();
  if (rows * a_row > max_answer_bytes)
    throw Error(Reason::limit_exceeded,
                "{} positions under each of {} load cases do not fit in a message: take fewer, or "
                "make several jobs",
                positions_of(growth), spec.loads.size())
        .at("growth.positions");
}

contact::Answer grow(const PreparedCase& prepared, EngineCore& core, contact::Observer& observer) {
  try {
    return grown(prepared, core, observer);
  } catch (Error& error) {
    if (!error.fields().empty()) error.below("growth");
    throw;
  }
}

}  // namespace anticrack::jobs
