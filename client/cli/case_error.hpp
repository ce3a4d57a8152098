// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace anticrack::cli {

/// A fault in a case, a file of rows, or a flag about them. what(): place, bad value, cure.
class CaseError : public std::runtime_error {
 public:
  explicit CaseError(const std::string& message) : std::runtime_error(message) {}
  /// `place`: a file with its line, or the flag.
  CaseError(const std::string& place, const std::string& problem)
      : std::runtime_error(place + ": " + problem) {}
};

}  // namespace anticrack::cli
