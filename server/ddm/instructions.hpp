// SPDX-License-Identifier: GPL-3.0-or-later
//
// Instruction sets that the inner loops are compiled for.
#pragma once

namespace anticrack::ddm {

enum class Instructions { baseline, avx2, avx512 };

/// Whether this processor has them.
bool has(Instructions instructions) noexcept;

/// The widest of them it has.
Instructions best_instructions() noexcept;

/// The version of a function compiled for the instructions; null where the processor lacks them.
template <class Function>
Function* version_for(Instructions instructions, Function* baseline, Function* avx2,
                      Function* avx512) noexcept {
  if (!has(instructions)) return nullptr;
  if (instructions == Instructions::baseline) return baseline;
  return instructions == Instructions::avx2 ? avx2 : avx512;
}

}  // namespace anticrack::ddm
