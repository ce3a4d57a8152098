// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace anticrack::operators {

/// Index of `name` among the mesh's `what` ("subdomain", "inclusion"). Throws errors::Error
/// (invalid_argument at `field`) with the names there are.
std::size_t index_of(const std::vector<std::string>& names, const std::string& name,
                     const std::string& what, const std::string& field);

}  // namespace anticrack::operators
