// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesher/helper.hpp"

namespace anticrack::testing {

/// The helper of this build, within its default limits.
inline mesher::HelperOptions real_helper() {
  mesher::HelperOptions options;
  options.executable = mesher::default_executable();
  return options;
}

}  // namespace anticrack::testing
