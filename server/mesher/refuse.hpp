// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "errors/errors.hpp"

namespace anticrack::mesher {

/// Throws errors::Error (mesh_invalid): the file is not a mesh that can be solved on.
[[noreturn]] inline void refuse(const std::string& message) {
  throw errors::Error(errors::Reason::mesh_invalid, message);
}

}  // namespace anticrack::mesher
