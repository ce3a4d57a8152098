// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which side of an interface is its plus side.
#pragma once

#include <set>
#include <span>
#include <string>
#include <utility>

#include "mesh/mesh.hpp"
#include "mesher/interface_chains.hpp"

namespace anticrack::mesher {

/// The lines of a file: first node, second node.
using DirectedLines = std::set<std::pair<std::int32_t, std::int32_t>>;

struct Oriented {
  Chain chain;       ///< plus side on its left
  std::string note;  ///< not empty: a warning that rule 3 applied
};

/// The plus side is, by the first rule that applies:
///   1. between two subdomains: the one called `plus`, or the one that faces `minus`;
///   2. the side left of the lines on its cracks and inclusions (else of all lines), if they agree;
///   3. between two subdomains: the one with the higher number; inside one: the left of the chain
///      from its end with the lower x (then y), or the inside of a ring.
/// Rule 3 gives no note for a chain of glue only: no answer depends on it.
Oriented orient(Chain chain, const mesh::Mesh& mesh, const DirectedLines& lines);

}  // namespace anticrack::mesher
