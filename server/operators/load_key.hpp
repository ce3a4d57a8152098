// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include "fem/load.hpp"

namespace anticrack::operators {

/// Key of a list of loads: equal if and only if all their fields but the names are; an array is
/// represented by the hash of its upload. None if an array has no hash.
std::optional<std::string> key_of(std::span<const fem::Load* const> loads);

}  // namespace anticrack::operators
