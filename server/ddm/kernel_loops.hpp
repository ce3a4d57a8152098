// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops of kernels.hpp: include it once in a file compiled for an instruction set, with
// ANTICRACK_KERNELS the name of the Kernels and ANTICRACK_ROWS the rows of a block that fit its
// registers. It calls no library function, because the linker could use an inline function compiled
// here in code for every processor.
#include "ddm/kernels.hpp"

namespace anticrack::ddm {
namespace {

/// Prefetches `count` values of L. The processor predicts long columns only, and most columns of a
/// factor are short: without this, forward substitution takes a sixth longer, backward three
/// tenths. Values go to the second-level cache, as the first holds the vector. Addresses outside
/// the factor do no harm.
inline void fetch(const double* values, int count) {
  constexpr int cache_line = 64 / sizeof(double);
  for (int i = 0; i < count; i += cache_line) __builtin_prefetch(values + i, 0, 2);
}

/// How far ahead, in values: some panels of a small supernode.
constexpr int ahead = 1024;

/// Calls Supernodes::look each time a certain amount of L has been used.
class Turns {
 public:
  /// `width`: of the block of right-hand sides.
  Turns(const Supernodes& factor, int width)
      : _look(factor.look), _each(a_turn / (width / lanes + 1)), _left(_each) {}

  /// To be called before the work on `columns` columns of this height.
  void take(long columns, int height) {
    _left -= columns * height;
    if (_left > 0) return;
    _left = _each;
    if (_look != nullptr) _look();
  }

 private:
  static constexpr long a_turn = 1 << 19;  // values of L, if the block has one column
  void (*const _look)();
  const long _each;
  long _left;
};

}  // namespace
}  // namespace anticrack::ddm

#include "ddm/forward_kernel.hpp"
// This uses names of the forward kernel.
#include "ddm/backward_kernel.hpp"
#include "ddm/front_kernel.hpp"

namespace anticrack::ddm {

extern const Kernels ANTICRACK_KERNELS{forward_solve, backward_solve, eliminate_small_front};

}  // namespace anticrack::ddm
