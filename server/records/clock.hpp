// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>

namespace anticrack::records {

using Clock = std::chrono::system_clock;

}  // namespace anticrack::records
