// SPDX-License-Identifier: GPL-3.0-or-later
//
// What has become of a load case.
#pragma once

#include <cstdint>

namespace anticrack::contact {

/// The state of a load case. One that is solved ends converged, not_converged or cancelled.
enum class Status : std::int32_t {
  pending = 1,
  running,
  converged,
  not_converged,
  failed,
  cancelled,
};

}  // namespace anticrack::contact
