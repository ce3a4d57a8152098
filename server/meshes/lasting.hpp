// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "errors/errors.hpp"

namespace anticrack::meshes {

/// An error that the same mesh would meet again, however long one waits: the mesh has failed. After
/// any other it is as it was, and who waits is told.
bool lasting(const errors::Error& error) noexcept;

}  // namespace anticrack::meshes
