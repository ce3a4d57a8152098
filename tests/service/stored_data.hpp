// SPDX-License-Identifier: GPL-3.0-or-later
//
// The data folder of a server that does not run.
#pragma once

#include <string>
#include <vector>

namespace anticrack::service_test {

/// What is wrong with it, one line each; none for a folder that is sound: the database passes its
/// integrity check, every file it refers to is there, no other file is, and none is half-written.
std::vector<std::string> flaws_of(const std::string& data);

}  // namespace anticrack::service_test
