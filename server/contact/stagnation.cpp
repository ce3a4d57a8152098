// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/stagnation.hpp"

#include <algorithm>

namespace anticrack::contact {

bool StagnationMonitor::add(double criterion, bool turned) {
  ++_count;
  _turns += turned ? 1 : 0;
  _smallest = std::min(_smallest, criterion);
  if (_count < window) {
    return false;
  }
  const bool stagnant =
      _smallest > rounding && _smallest >= progress * _previous_smallest && 2 * _turns > window;
  _count = _turns = 0;
  _previous_smallest = _smallest;
  _smallest = std::numeric_limits<double>::infinity();
  _stagnant_windows = stagnant ? _stagnant_windows + 1 : 0;
  return _stagnant_windows >= 2;
}

}  // namespace anticrack::contact
