// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/csv_file.hpp"

#include "cli/case_error.hpp"
#include "output/file.hpp"
#include "output/target.hpp"

namespace anticrack::cli {

namespace fs = std::filesystem;

fs::path csv_file(const std::string& csv, const fs::path& result_file) {
  if (csv.empty()) return {};
  output::check_writable(csv);
  const output::Target target = output::target_of(csv);
  if (target.kind == output::Target::Kind::file &&
      fs::weakly_canonical(target.path) ==
          fs::weakly_canonical(output::target_of(result_file).path)) {
    throw CaseError("--csv " + csv, "this is also the result file; name another one");
  }
  return csv;
}

}  // namespace anticrack::cli
