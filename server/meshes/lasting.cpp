// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/lasting.hpp"

namespace anticrack::meshes {

bool lasting(const errors::Error& error) noexcept {
  switch (error.reason()) {
    case errors::Reason::busy:
    case errors::Reason::cancelled:
    case errors::Reason::disk_full:
    case errors::Reason::storage:
      return false;
    default:
      return true;
  }
}

}  // namespace anticrack::meshes
