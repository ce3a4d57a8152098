// SPDX-License-Identifier: GPL-3.0-or-later
#include "store/disk_errors.hpp"

#include <cerrno>
#include <chrono>
#include <system_error>

namespace anticrack::store {

using errors::Error;
using errors::Reason;

namespace {

constexpr std::chrono::seconds retry_delay{5};

}  // namespace

Error disk_full(const std::string& what) {
  return Error(Reason::disk_full,
               "{}; try again when there is space: results expire, and meshes and jobs that are "
               "not needed can be deleted",
               what)
      .retry_after(retry_delay);
}

bool no_space(int code) noexcept { return code == ENOSPC || code == EDQUOT || code == EFBIG; }

Error disk_error(const std::string& action, int code) {
  const std::string what =
      std::string("cannot ") + action + ": " + std::generic_category().message(code);
  if (no_space(code)) return disk_full(what);
  return {Reason::storage, what + "; check that the data folder is there, writable and sound"};
}

}  // namespace anticrack::store
