// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the disk answers, as errors a client understands.
#pragma once

#include <string>

#include "errors/errors.hpp"

namespace anticrack::store {

/// disk_full with a retry delay, for no space and for a budget that is spent.
errors::Error disk_full(const std::string& what);

/// No space, a quota, or the limit of a file's size: ENOSPC, EDQUOT, EFBIG.
bool no_space(int code) noexcept;

/// Of a failed system call: disk_full where there is no space, else storage.
/// `action` e.g. "write /data/meshes/part-a1b2".
errors::Error disk_error(const std::string& action, int code);

}  // namespace anticrack::store
