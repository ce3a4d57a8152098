// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <string>

#include "fem/load.hpp"

namespace anticrack::operators {

/// Bytes that are the same for two lists of loads exactly where all their fields are, names apart;
/// an array stands for itself by the hash of its upload. None where an array has no hash.
std::optional<std::string> key_of(std::span<const fem::Load* const> loads);

}  // namespace anticrack::operators
