// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "postgres/schema.hpp"

namespace anticrack::group {

/// The tables of the store and of its queue.
postgres::Tables tables();

}  // namespace anticrack::group
