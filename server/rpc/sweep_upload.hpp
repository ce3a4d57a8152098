// SPDX-License-Identifier: GPL-3.0-or-later
//
// Handles a sweep's matrix that came with the job.
#pragma once

#include <string>

#include "anticrack/v1/solve.pb.h"
#include "store/store.hpp"

namespace anticrack::rpc {

/// Whether the job is a sweep whose matrix came with it.
bool has_packed_matrix(const v1::Job& job);

/// Keeps the matrix as an upload of `owner`, as if it had been uploaded before, so that both ways
/// are the same from there on. Keeping the same matrix again changes only the upload's age. `job`
/// must have a packed matrix and have been accepted by to_spec(). Blocks on the disk. Throws
/// errors::Error with the path in the job: invalid_argument (a value that is not finite); disk_full
/// and storage without one.
void keep_packed_matrix(const v1::Job& job, store::Store& store, const std::string& owner);

}  // namespace anticrack::rpc
