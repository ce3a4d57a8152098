// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace anticrack::results {

/// Makes `folder` and those above it where they are missing. Throws Error where that fails, and
/// where no file can be put into it.
void make_folder(const std::filesystem::path& folder);

}  // namespace anticrack::results
