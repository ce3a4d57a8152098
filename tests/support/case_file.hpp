// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "casefile/case.hpp"

namespace anticrack::testing {

/// A case in a file. Throws casefile::Error.
inline casefile::Case read_case_file(const std::filesystem::path& path,
                                     const std::vector<std::string>& overrides = {}) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return casefile::parse_case(text.str(), path.string(), overrides);
}

}  // namespace anticrack::testing
