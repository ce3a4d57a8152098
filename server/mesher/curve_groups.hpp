// SPDX-License-Identifier: GPL-3.0-or-later
//
// Groups of curves and their meanings, from the file or from the request.
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

/// A text read as a keyword. Neither a meaning nor a fault: the text is not a keyword.
struct ReadMeaning {
  std::optional<CurveMeaning> meaning;
  std::string fault;  ///< not empty: what is wrong with the NAME of a keyword
};
/// Reads dirichlet, neumann, glue, crack, crack:NAME, inclusion:NAME or delaminated:NAME, in upper
/// or lower case, with or without blanks around the words.
ReadMeaning read_meaning(const std::string& text);

struct CurveGroup {
  std::int32_t tag = 0;
  std::string title;                    ///< for messages: curve group 7 "gamma_c"
  std::optional<CurveMeaning> meaning;  ///< none: the surroundings decide
};

struct CurveGroups {
  /// False if no line is in a physical group: the groups are then the elementary curves.
  bool physical = true;
  std::map<std::int32_t, CurveGroup> groups;

  /// The group of a line, or null.
  const CurveGroup* of(const MshElement<2>& line) const;
};

/// `given` (physical tag -> meaning) overrides the names of the file. Throws errors::Error:
/// invalid_argument at "options.curve_groups[TAG]" for a tag that the file lacks or a text that is
/// not a keyword; mesh_invalid for a bad NAME, or one shared by a crack and an inclusion.
CurveGroups read_curve_groups(const MshFile& file,
                              const std::map<std::int32_t, std::string>& given);

}  // namespace anticrack::mesher
