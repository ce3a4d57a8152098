// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/instructions.hpp"

namespace anticrack::ddm {

bool has(Instructions instructions) noexcept {
#if defined(__x86_64__) && !defined(__clang__)  // clang 14 does not know the levels
  switch (instructions) {
    case Instructions::avx512:
      return __builtin_cpu_supports("x86-64-v4") != 0;
    case Instructions::avx2:
      return __builtin_cpu_supports("x86-64-v3") != 0;
    case Instructions::baseline:
      break;
  }
#endif
  return instructions == Instructions::baseline;
}

Instructions best_instructions() noexcept {
  if (has(Instructions::avx512)) return Instructions::avx512;
  return has(Instructions::avx2) ? Instructions::avx2 : Instructions::baseline;
}

}  // namespace anticrack::ddm
