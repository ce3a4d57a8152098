// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "casefile/case.hpp"
#include "words/nearest_field.hpp"

namespace anticrack::casefile {

/// 20 lines; the tests count on them.
inline const std::string sample_text = R"(title = "A plate"

[geometry]
boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
interface = [[-1, 0], [1, 0]]

[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to   = [0.5, 0]

[solver]
theta = 1.5
method = "uzawa"
[[load]]
name = "one"
f = 1
[[load]]
name = "two"
f = "y > 0 ? 1 : -1"
)";

inline Case parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_case(text, "plate.toml", overrides);
}

/// `sample_text` with the first `from` replaced; `from` has to be there.
inline std::string sample_with(const std::string& from, const std::string& to) {
  std::string text = sample_text;
  return text.replace(text.find(from), from.size(), to);
}

inline const Spot* locate(const Case& the_case, const std::string& field) {
  return words::nearest_field(the_case.spots, field);
}

/// The message of the error that reading gives; empty when there is none.
inline std::string complaint(const std::string& text,
                             const std::vector<std::string>& overrides = {}) {
  try {
    parse(text, overrides);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace anticrack::casefile
