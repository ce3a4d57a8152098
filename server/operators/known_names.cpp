// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/known_names.hpp"

#include <algorithm>

#include "errors/errors.hpp"
#include "mesh/at.hpp"

namespace anticrack::operators {

std::size_t index_of(const std::vector<std::string>& names, const std::string& name,
                     const std::string& what, const std::string& field) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return at(found - names.begin());
  constexpr std::size_t most_listed = 20;
  std::string known;
  for (std::size_t i = 0; i < std::min(names.size(), most_listed); ++i)
    known += (known.empty() ? "\"" : ", \"") + names[i] + "\"";
  known += names.size() > most_listed ? ", ..." : "";
  throw errors::Error(
      errors::Reason::invalid_argument,
      "the mesh has no " + what + " \"" + name + "\"; it has " + (known.empty() ? "none" : known))
      .at(field);
}

}  // namespace anticrack::operators
