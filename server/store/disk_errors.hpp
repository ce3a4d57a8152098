// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors of the disk as errors that a client understands.
#pragma once

#include <string>

#include "errors/errors.hpp"

namespace anticrack::store {

/// The error disk_full with a retry delay, for no space and for a budget that is used up.
errors::Error disk_full(const std::string& what);

/// Whether an errno means no space, a quota, or the limit of a file's size: ENOSPC, EDQUOT, EFBIG.
bool no_space(int code) noexcept;

/// The error of a failed system call: disk_full if there is no space, else storage. `action`: e.g.
/// "write /data/meshes/part-a1b2".
errors::Error disk_error(const std::string& action, int code);

}  // namespace anticrack::store
