// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handles a sweep's matrix that came with the job.
#pragma once

#include <string>

#include "anticrack/v1/job.pb.h"
#include "store/store.hpp"

namespace anticrack::rpc {

/// Whether it is a sweep whose matrix came with it.
bool has_packed_matrix(const v1::JobSpec& spec);

/// Keeps it as an upload of `owner`, as if it had been uploaded before: from there on the two ways
/// are one. The same again changes nothing but the upload's age. `spec` has a packed matrix and was
/// taken by to_spec(). Blocks on the disk.
/// Throws errors::Error with the path in the spec: invalid_argument (a value that is not finite);
/// disk_full and storage without one.
void keep_packed_matrix(const v1::JobSpec& spec, store::Store& store, const std::string& owner);

}  // namespace anticrack::rpc
