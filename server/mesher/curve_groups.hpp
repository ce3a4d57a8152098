// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the groups of curves are called, by the file or by the request.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesher/msh_file.hpp"

namespace anticrack::mesher {

enum class CurveRole { neumann, dirichlet, glue, crack, inclusion, delaminated };

struct CurveMeaning {
  CurveRole role = CurveRole::glue;
  std::string name;  ///< of the inclusion or crack, else empty
};

/// One keyword of the API read: dirichlet, neumann, glue, crack, crack:NAME, inclusion:NAME,
/// delaminated:NAME, in upper or lower case. Neither a meaning nor a fault: a name of one's own.
struct ReadMeaning {
  std::optional<CurveMeaning> meaning;
  std::string fault;  ///< not empty: what is wrong with the NAME of a keyword
};
/// Blanks around its words do not count.
ReadMeaning read_meaning(const std::string& text);

struct CurveGroup {
  std::int32_t tag = 0;
  std::string title;                    ///< for messages: curve group 7 "gamma_c"
  std::optional<CurveMeaning> meaning;  ///< none: adjacency decides
};

struct CurveGroups {
  /// In a file whose lines are in no physical group the elementary curves take their place.
  bool physical = true;
  std::map<std::int32_t, CurveGroup> groups;

  /// Group of a line, null for none.
  const CurveGroup* of(const MshElement<2>& line) const;
};

/// `given` (physical tag -> meaning) wins over the names of the file.
/// Throws errors::Error: invalid_argument at "options.curve_groups[TAG]" for a tag the file lacks
/// and for what is not a keyword; mesh_invalid for a keyword with a bad NAME, and for a NAME shared
/// by a crack and an inclusion.
CurveGroups read_curve_groups(const MshFile& file,
                              const std::map<std::int32_t, std::string>& given);

/// "3, 4, 7", at most twenty of them.
std::string list_of(const std::vector<std::int32_t>& tags);

}  // namespace anticrack::mesher
