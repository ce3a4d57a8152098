// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace anticrack::casefile {

/// The place where a value of a case was written.
struct Spot {
  std::string key;     ///< dotted path, entries by name or index: "load.up.f"; empty: the whole
  std::string source;  ///< the case's file, or the --set that wrote it
  unsigned line = 0;   ///< from 1; 0: no line (a --set, or the whole file)
};

/// The place as text: "case.toml:12", "case.toml" if no line is known, "line 12" if the case has no
/// name.
std::string where(const Spot& spot);

/// The beginning of a message: "case.toml:12: solver.theta: ", without the unknown parts.
std::string prefix(const Spot& spot);

/// A case that cannot be read. what() gives file, line, key, the bad value and the cure.
class Error : public std::runtime_error {
 public:
  Error(Spot spot, const std::string& problem)
      : std::runtime_error(prefix(spot) + problem), _spot(std::move(spot)) {}

  const Spot& spot() const noexcept { return _spot; }

 private:
  Spot _spot;
};

}  // namespace anticrack::casefile
