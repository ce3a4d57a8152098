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

/// Directions of the lines of a file.
class LineDirections {
 public:
  /// Every line counts from its first node to its second.
  explicit LineDirections(std::span<const CurveEdge> lines);

  enum class Along { forwards, backwards, both, none };
  /// Of the lines on its cracks and inclusions if there are any, else of all.
  Along of(const Chain& chain) const;

 private:
  Along of(const Chain& chain, bool glue_too) const;

  std::set<std::pair<std::int32_t, std::int32_t>> _directed;
};

struct Oriented {
  Chain chain;       ///< plus side on its left
  std::string note;  ///< not empty: how the side was guessed, for a warning
};

/// The first of these that decides:
///   1. between two subdomains: the one called `plus`, or the one facing the one called `minus`;
///   2. what lies left of the lines on it, if all run the same way;
///   3. between two subdomains: the one with the higher number; inside one: the left of the chain
///      walked from its end with the lower x (then y), the inside of a ring.
/// A chain of nothing but glue is guessed without a note: no answer depends on it.
Oriented orient(Chain chain, const mesh::Mesh& mesh, const LineDirections& directions);

}  // namespace anticrack::mesher
