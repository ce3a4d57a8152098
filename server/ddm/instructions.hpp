// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sets of instructions that the inner loops are compiled for.
#pragma once

namespace anticrack::ddm {

enum class Instructions { baseline, avx2, avx512 };

/// Whether this processor has them.
bool has(Instructions instructions) noexcept;

/// The last that it has.
Instructions best_instructions() noexcept;

}  // namespace anticrack::ddm
