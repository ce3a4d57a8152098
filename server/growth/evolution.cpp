// SPDX-License-Identifier: GPL-3.0-or-later
#include "growth/evolution.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/at.hpp"
#include "errors/errors.hpp"
#include "growth/drive.hpp"

namespace anticrack::growth {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What is increased, per unit of t.
double per_load(const Row& row, Control control) {
  return control.inclusion < 0 ? 1 : std::abs(row.displacement[at(control.inclusion)]) / row.load;
}

}  // namespace

Evolution::Evolution(std::vector<Track> tracks, Control control, double step)
    : _tracks(std::move(tracks)), _control(control), _step(step) {
  for (const Track& track : _tracks) {
    if (track.position.size() < 2 || track.toughness.size() != track.position.size())
      throw errors::Error(errors::Reason::invalid_argument,
                          "the path \"{}\" has no edge to grow along: take a finer mesh",
                          track.name);
    for (const double toughness : track.toughness)
      if (!(toughness > 0 && toughness < infinity))
        throw errors::Error(errors::Reason::invalid_argument,
                            "Gc is {} on the path \"{}\"; it must be above 0 everywhere",
                            errors::shown(toughness), track.name);
  }
  _state = {std::vector<std::size_t>(_tracks.size(), 0),
            std::vector<Fate>(_tracks.size(), Fate::grows)};
}

Sought Evolution::sought() const {
  Sought sought{{}, _last, _highest};
  for (std::size_t i = 0; i < _tracks.size(); ++i)
    sought.toughness.push_back(_tracks[i].toughness[_state.at[i]]);
  return sought;
}

std::optional<Row> Evolution::take(const Measured& measured) {
  if (drop_unmeasured(measured)) return {};
  Row row = row_of(measured);
  row.stable = row.leader >= 0 && row.control > _highest;
  if (row.leader < 0) {
    _ending =
        measured.driven
            ? fmt::format("no higher load makes a front grow: G is at most {} Gc, at the load {}",
                          errors::shown(measured.driven->most),
                          errors::shown(measured.driven->most_at))
            : "every front is closed: no load of this kind makes it grow";
  } else {
    _highest = std::max(_highest, row.control);
    _last = row.load;
    ++_rows;
    advance(at(row.leader));
  }
  return row;
}

/// Whether a front that grows has no G.
bool Evolution::drop_unmeasured(const Measured& measured) {
  bool dropped = false;
  for (std::size_t i = 0; i < _tracks.size(); ++i) {
    if (_state.fate[i] != Fate::grows || measured.release[i]) continue;
    set_fate(i, _tracks[i].breaks_through ? Fate::snapped : Fate::not_followed);
    dropped = true;
  }
  return dropped;
}

Row Evolution::row_of(const Measured& measured) const {
  Row row;
  row.load = infinity;
  for (std::size_t i = 0; i < _tracks.size(); ++i) {
    const bool grows = _state.fate[i] == Fate::grows;
    const double G1 = grows ? *measured.release[i] : std::numeric_limits<double>::quiet_NaN(),
                 Gc = _tracks[i].toughness[_state.at[i]];
    row.position.push_back(_tracks[i].position[_state.at[i]]);
    row.G1.push_back(G1);
    row.toughness.push_back(Gc);
    const double starts = measured.driven ? measured.driven->starts[i] : std::sqrt(Gc / G1);
    row.starts.push_back(grows && (measured.driven || G1 > 0) ? starts : infinity);
    if (row.starts[i] < row.load) {
      row.load = row.starts[i];
      row.leader = static_cast<int>(i);
    }
  }
  for (std::size_t i = 0; i < _tracks.size(); ++i)
    if (static_cast<int>(i) != row.leader && row.starts[i] <= (1 + tie) * row.load &&
        row.leader >= 0)
      row.ties.push_back(static_cast<int>(i));
  row.contact_length = measured.contact_length;
  if (measured.driven) {
    row.alone = measured.driven->alone;
    row.held = measured.driven->held;
  }
  if (row.leader < 0) return row;
  const double scale = measured.driven ? 1 : row.load;
  for (const double a : measured.displacement) row.displacement.push_back(scale * a);
  row.energy = scale * scale * measured.energy;
  row.control = row.load * per_load(row, _control);
  return row;
}

void Evolution::advance(std::size_t leader) {
  const std::vector<double>& position = _tracks[leader].position;
  const std::size_t last = position.size() - 1;
  std::size_t& here = _state.at[leader];
  if (here == last) {
    set_fate(leader, _tracks[leader].breaks_through ? Fate::snapped : Fate::end_of_path);
  } else {
    constexpr double rounding = 1e-9;
    const double from = position[here];
    while (++here < last && std::abs(position[here] - from) < (1 - rounding) * _step) {
    }
  }
  const int facing = _tracks[leader].facing;
  if (facing < 0 || _state.fate[leader] != Fate::grows) return;
  // The positions of both are those of one path, from either end.
  if (here + _state.at[at(facing)] >= last) set_fate(leader, Fate::snapped);
}

void Evolution::set_fate(std::size_t front, Fate fate) {
  const auto set = [&](std::size_t i) {
    if (_state.fate[i] == fate) return;
    _state.fate[i] = fate;
    _events.push_back({_rows, i, fate});
  };
  set(front);
  if (fate == Fate::snapped && _tracks[front].facing >= 0) set(at(_tracks[front].facing));
  if (std::ranges::find(_state.fate, Fate::grows) == _state.fate.end())
    _ending = "every front has come to the end of its path";
}

std::vector<Jump> jumps(const std::vector<Row>& rows, Control control) {
  std::vector<Jump> result;
  for (std::size_t k = 0; k + 1 < rows.size();) {
    if (rows[k].leader < 0) break;
    if (rows[k + 1].leader >= 0 && rows[k + 1].control > rows[k].control) {
      ++k;
      continue;
    }
    Jump jump{k, {}, 0};
    std::size_t m = k + 1;
    // G - Gc of a row's leader while what is increased stays at that of row k.
    const auto surplus = [&](std::size_t row, std::size_t front) {
      if (!rows[row].held.empty()) {
        const double left = rows[row].held[front] - rows[row].toughness[front];
        return row == k ? std::max(left, 0.0) : left;  // held at what was increased before
      }
      const double t = rows[k].control / per_load(rows[row], control);
      return t * t * rows[row].G1[front] - rows[row].toughness[front];
    };
    for (; m < rows.size() && rows[m].leader >= 0; ++m) {
      const auto front = at(rows[m - 1].leader);
      const double moved = std::abs(rows[m].position[front] - rows[m - 1].position[front]);
      const bool ends = rows[m].control > rows[k].control;
      const double before = surplus(m - 1, front), after = surplus(m, front);
      if (moved > 0 && !std::isnan(after))  // it ends where G falls to Gc, between two rows
        jump.not_dissipated += ends && before > 0 && after < 0
                                   ? moved * before * before / (before - after) / 2
                                   : moved * (before + after) / 2;
      if (ends) break;
    }
    if (m < rows.size() && rows[m].leader >= 0) jump.to = m;
    result.push_back(jump);
    if (!jump.to) break;
    k = m;
  }
  return result;
}

}  // namespace anticrack::growth
