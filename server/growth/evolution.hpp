// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which front grows next, at which load, and where growth jumps, from the numbers of one position
// of the fronts after another. Loads scale together with t > 0 and contact does so with them, so
// with G1 the rate at t = 1 a front starts at t_c = sqrt(Gc / G1); a path is a sweep over fronts.
// Beside a load that is not scaled G is no such square, and need not rise with t: see drive.hpp.
//
// Irreversible: no front goes back, and what has come off does not hold again.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fields/fields.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::growth {

/// Where one front may be: its positions, the first of which it has at first.
struct Track {
  std::string name;               ///< of the path, for people
  std::vector<double> position;   ///< (n >= 2) arc length along its interface, [L]
  std::vector<double> toughness;  ///< (n) Gc > 0, [F]
  /// Whether nothing holds beyond the last position: the end of an inclusion, a free edge, another
  /// front. If not, the path ends where the membrane holds.
  bool breaks_through = false;
  int facing = -1;  ///< the front that comes towards this one on the same path; -1: none
  std::vector<mesh::Point> place{};  ///< (n) of the positions in the plane
};

/// What becomes of a front.
enum class Fate {
  grows,
  snapped,       ///< the last piece before its end, or another front, came off at once
  end_of_path,   ///< its path ends, and the membrane holds there
  not_followed,  ///< G cannot be computed any further
};

/// The positions of all fronts.
struct State {
  std::vector<std::size_t> at;  ///< index into Track::position
  std::vector<Fate> fate;       ///< a front that snapped has no stretch left that holds
};
ANTICRACK_FIELDS(State, at, fate)

/// What a state is asked beside a dead load.
struct Sought {
  std::vector<double> toughness;  ///< Gc where each front is
  double from = 0;                ///< t of the row before
  double highest = 0;             ///< the highest t so far
};

/// Beside a dead load: numbers of each front, NaN if it does not grow any more.
struct Driven {
  std::vector<double> starts;  ///< t at which each front starts; infinite: none, or far above
  std::vector<double> alone;   ///< G under the dead load alone
  std::vector<double> held;    ///< G at Sought::highest
  /// G over Gc where it is largest from there on, if no front starts, and t there.
  double most = 0, most_at = 0;
};

/// Numbers of a state at t = 1, or, beside a dead load, at the least of Driven::starts, and at
/// Sought::highest if there is none.
struct Measured {
  /// G1 of each front that grows: >= 0, 0 if it is closed; empty where it is too near to something
  /// to be computed.
  std::vector<std::optional<double>> release;
  std::vector<double> displacement;  ///< A of each inclusion
  double contact_length = 0;
  double energy = 0;  ///< Pi
  std::optional<Driven> driven{};
};

/// What is increased: t, or the displacement of an inclusion.
struct Control {
  int inclusion = -1;  ///< index; -1: t
};

/// A state, and the load at which the first of its fronts leaves it.
struct Row {
  std::vector<double> position;  ///< of each front
  /// At t = 1, beside a dead load at `load`; of each front, NaN where it does not grow any more.
  std::vector<double> G1;
  std::vector<double> toughness;  ///< Gc where each front is
  /// t at which each front starts; infinite where it is closed or does not grow any more.
  std::vector<double> starts;
  double load = 0;                   ///< the least of them
  std::vector<double> displacement;  ///< of each inclusion, at this load
  double control = 0;                ///< what is increased: the load, or |A| of the inclusion
  double contact_length = 0;
  double energy = 0;                ///< Pi at this load
  int leader = -1;                  ///< the front that starts; -1: all are closed
  std::vector<int> ties;            ///< others that start at a load at most 1 % above
  bool stable = false;              ///< control is above that of all rows before
  std::vector<double> alone, held;  ///< as in Driven; empty without a dead load
};

/// A change of a front's fate.
struct Event {
  std::size_t row = 0;  ///< number of rows before it
  std::size_t front = 0;
  Fate fate = Fate::grows;
};

/// Goes through the states. The leader advances by a small step and all is measured again; at a tie
/// the first front leads, and the others are reported.
class Evolution {
 public:
  /// `step`: length by which the leader advances at once, at least by one position. Throws
  /// errors::Error (invalid_argument) for tracks without positions, or with Gc that is not above 0.
  Evolution(std::vector<Track> tracks, Control control, double step);

  const std::vector<Track>& tracks() const noexcept { return _tracks; }
  const State& state() const noexcept { return _state; }
  /// What is asked of state() beside a dead load.
  Sought sought() const;
  const std::vector<Event>& events() const noexcept { return _events; }
  /// Whether nothing grows any more; `ending` says why.
  bool over() const noexcept { return !_ending.empty(); }
  const std::string& ending() const noexcept { return _ending; }

  /// Takes the numbers of state() and moves on. Returns no row if a front of it could not be
  /// measured, which changes that front's fate and nothing else. O(fronts).
  std::optional<Row> take(const Measured& measured);

 private:
  Row row_of(const Measured& measured) const;
  bool drop_unmeasured(const Measured& measured);
  void set_fate(std::size_t front, Fate fate);
  void advance(std::size_t leader);

  std::vector<Track> _tracks;
  Control _control;
  double _step;
  State _state;
  std::vector<Event> _events;
  std::size_t _rows = 0;
  double _highest = 0, _last = 0;  // of what is increased; of t in the last row
  std::string _ending;
};

/// Where what is increased cannot follow the rows: while it stays at that of row `from`, fronts run
/// to where row `to` leaves it higher, or, without such a row, to the end.
struct Jump {
  std::size_t from = 0;
  std::optional<std::size_t> to;
  /// What growth does not use of the energy that the jump sets free, [F L]: the sum over the rows
  /// between of int (G - Gc) da, by the trapezoidal rule, without pieces that snap. Under control
  /// by a displacement it is right only if the force on that inclusion is the whole load.
  double not_dissipated = 0;
};
/// `rows` of one Evolution.
std::vector<Jump> jumps(const std::vector<Row>& rows, Control control);

}  // namespace anticrack::growth
