// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steps of plan(), in their order, over the lines of geometry_network.hpp.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mesh/geometry.hpp"
#include "mesh/geometry_network.hpp"

namespace anticrack::mesh {

// Ends that lie a little off their line, as rounded coordinates on an oblique line do.

/// A point nearer than this to the line on which it must lie is moved onto it: 1e-6 of the
/// boundary's diagonal.
double snap_distance(const Network& network) noexcept;

/// Moves points of `geometry` that are on no line of the network within its tolerance, but within
/// snap_distance of one: ends of interfaces onto the boundary or another interface, ends of parts
/// onto an interface, ends of Neumann parts onto the boundary. `warnings` lists up to a hundred of
/// them. `network`: that of the same geometry. Returns whether a point was moved. O(points times
/// lines).
bool snap_ends(const Network& network, Drawn& geometry, std::vector<std::string>& warnings);

/// The names of the interfaces, with empty ones filled in. Throws errors::Error (geometry_invalid,
/// or limit_exceeded) at "interfaces[0].name", "inclusions[0].name", ... for a malformed name or
/// one used twice. Inclusions and cracks share one set of names, and so do sides and holes;
/// interfaces and regions have sets of their own.
std::vector<std::string> check_names(const Drawn& geometry);

/// The names of the sides of the boundary in the order in which they were written, then those of
/// the holes, with empty ones filled in.
std::vector<std::string> side_names(const Geometry& geometry);

/// `name`, or the first of `name`-2, `name`-3, ... not in `used`; added to `used`.
std::string unused_name(const std::string& name, std::vector<std::string>& used);

// Places inclusions and cracks on the interfaces, and the Neumann boundary, as stretches of lines.

/// A stretch of an interface that is not glue. On a closed one `end` may lie past the line's last
/// parameter.
struct Stretch {
  int line = 0;
  double begin = 0;
  double end = 0;
  Kind kind = Kind::crack;
  int inclusion = -1;
  bool plus_off = false;  ///< delaminated: the plus side comes off, not the minus side
};

/// A whole inclusion or crack.
struct PlacedPart {
  int line = 0;
  Station begin;
  Station end;
  Field field{""};        ///< of the inclusion or crack
  int inclusion = -1;     ///< -1: a crack
  bool reversed = false;  ///< `begin` is the part's `to`
  bool own = false;       ///< it is all of a line of its own
};

/// The field in which the part was given.
Field place_of(const PlacedPart& part);

struct Layout {
  std::vector<PlacedPart> parts;
  std::vector<Stretch> stretches;
  std::vector<Stretch> neumann;  ///< stretches of the boundary
};

/// Places the parts on the lines, which get stations at their ends; a tip keeps the coordinates it
/// was given. Throws errors::Error (geometry_invalid) at "inclusions[1].part.from",
/// "neumann[0].to", ... for a part off every interface, without length, or overlapping another one;
/// at "inclusions[0].fixed" for a motion with a fault.
Layout lay_parts(const Drawn& geometry, Network& network);

/// The stretches where the boundary is Neumann. Throws errors::Error (geometry_invalid) at
/// "neumann[0].to", "neumann_sides[1]", ... for a part off the boundary or overlapping another one,
/// for an unknown name, and for a part that is all but one straight side, which was probably
/// written in reverse.
std::vector<Stretch> lay_neumann(const Geometry& geometry, Network& network);

/// The stretch that holds a chord; null if there is none.
const Stretch* stretch_of(const std::vector<Stretch>& stretches, const Network& network,
                          const Chord& chord) noexcept;

// Chains of curves.

/// How a curve must be walked by its chain.
enum class Walk { either, as_written, reversed };

/// Splits the curves that are left of each interface into chains; a chain also ends where the next
/// curve must be walked in another direction. The first chain of an interface keeps its name.
/// Throws errors::Error (geometry_invalid) at "interfaces[i].polyline" if nothing is left.
void add_chains(const Network& network, const std::vector<std::string>& names,
                const std::vector<bool>& kept, const std::vector<Walk>& walks, Plan& plan);

/// Reverses the chains that must be reversed, and their curves.
void turn_chains(const std::vector<Walk>& walks, Plan& plan);

// Makes faces, subdomains and interface chains from chords with their conditions.

/// Fills the faces, `left` and `right` of the curves and the interfaces of a plan whose curves are
/// the chords of the network, one by one, with role, kind and inclusion set. Glue with the same
/// subdomain on both sides is removed; an interface becomes the chains that are left of it. Faces
/// that only align lines separate, or only cracks and inclusions within the outline of a region,
/// are one subdomain and share its name. Subdomains are numbered in the order in which a walk along
/// the interfaces meets them, minus side first, before chains are reversed. `names`: those of the
/// interfaces. `walks`: per curve. Throws errors::Error (geometry_invalid) as add_chains() does, at
/// "regions[i].at" for a region outside the membrane, on a line, or in a subdomain that another
/// region names, at "regions[i].outline" for a region that an interface divides.
void lay_subdomains(const Drawn& geometry, const Network& network,
                    const std::vector<std::string>& names, const std::vector<Walk>& walks,
                    Plan& plan);

// Decides into how many pieces each curve is cut.

/// Distributes `total` intervals over curves in proportion to their lengths, which must be
/// positive, by largest remainders; each curve gets at least one (so the sum is max(total,
/// curves)), and ties go to the earlier curve. O(k log k) for k curves and a total of that order.
std::vector<int> apportion(std::span<const double> lengths, int total);

/// Section 8 of the paper: 80 intervals on all glue together, 80 on the rest of the interface, 80
/// on the outer boundary of each subdomain. For a plan of two faces and one interface.
void set_paper_intervals(Plan& plan);

/// Cuts curves that are too long for what is near them: an edge is at most twice as long as the
/// distance to a curve with which it shares no point, or as the shortest curve at its end; away
/// from there it may grow by `growth` per unit length. Curves that `size` makes short enough stay
/// whole. Other curves are replaced by several, with the pieces as their `intervals`. Throws
/// errors::Error (limit_exceeded) beyond `max_curves` pieces. O(c^2).
void cut_near(Plan& plan, double size, double growth, std::size_t max_curves);

/// Replaces the plan's curves. `pieces`: for each old curve, the new ones it became, in its own
/// direction; empty for a curve that was removed.
void replace_curves(Plan& plan, std::vector<PlannedCurve> curves,
                    const std::vector<std::vector<int>>& pieces);

/// Cuts the intervals of each curve but chords of bends into equal ones of at most `size`.
void set_intervals(Plan& plan, double size);

/// The distance of the curve's end points.
double length_of(const Plan& plan, const PlannedCurve& curve) noexcept;

}  // namespace anticrack::mesh
