// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/version.hpp"

namespace anticrack::rpc {

const char* version() noexcept { return ANTICRACK_VERSION; }
const char* build() noexcept { return ANTICRACK_BUILD; }

}  // namespace anticrack::rpc
