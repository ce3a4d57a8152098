// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace anticrack::rpc {

const char* version() noexcept;  ///< e.g. "0.1.0"
const char* build() noexcept;    ///< compiler and build type

}  // namespace anticrack::rpc
