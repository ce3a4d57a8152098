// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "errors/errors.hpp"

namespace anticrack::meshes {

/// Whether the same mesh would always meet this error again, so that the mesh has failed. After any
/// other error it stays as it was, and its waiters get the error.
inline bool lasting(const errors::Error& error) noexcept {
  using errors::Reason;
  const Reason reason = error.reason();
  return reason != Reason::busy && reason != Reason::cancelled && reason != Reason::disk_full &&
         reason != Reason::storage;
}

}  // namespace anticrack::meshes
