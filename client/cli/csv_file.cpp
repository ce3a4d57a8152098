// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/csv_file.hpp"

#include <span>

#include "casefile/error.hpp"
#include "results/file.hpp"
#include "results/replace_file.hpp"

namespace anticrack::cli {

namespace fs = std::filesystem;

fs::path csv_file(const std::string& csv, const fs::path& result_file) {
  if (csv.empty()) return {};
  results::check_writable(csv);
  if (fs::absolute(csv) == fs::absolute(result_file)) {
    throw casefile::Error({"", "--csv " + csv, 0},
                          "this is also the result file; name another one");
  }
  return csv;
}

void write_csv(const fs::path& file, const std::string& text) {
  results::replace_file(file, std::as_bytes(std::span(text)));
}

}  // namespace anticrack::cli
