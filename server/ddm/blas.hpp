// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::ddm {

/// Throws errors::Error (internal) unless BLAS is the pthread build of OpenBLAS: under threads, the
/// serial build gave 40 wrong factors of 44, without an error. Sets one thread per caller.
void require_threadsafe_blas();

}  // namespace anticrack::ddm
