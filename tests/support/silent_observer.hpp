// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "contact/observer.hpp"

namespace anticrack::testing {

/// Hears of every iteration and lets all go on.
class Silent : public contact::Observer {
 public:
  bool on_iteration(const contact::Sample&) override { return true; }
};

}  // namespace anticrack::testing
