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

/// That of a function's versions that is compiled for the instructions; null where the processor
/// does not have them.
template <class Function>
Function* version_for(Instructions instructions, Function* baseline, Function* avx2,
                      Function* avx512) noexcept {
  if (!has(instructions)) return nullptr;
  if (instructions == Instructions::baseline) return baseline;
  return instructions == Instructions::avx2 ? avx2 : avx512;
}

}  // namespace anticrack::ddm
