// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace anticrack::app {

/// Days until the first certificate of `certificate` (PEM) expires; negative if it has. Throws
/// ConfigError: not a certificate, not a key (or one with a passphrase), or a key of another
/// certificate. Without this check gRPC only reports that it cannot listen.
int check_certificate(const std::string& certificate, const std::string& key);

/// Throws ConfigError unless `roots` (PEM) begins with a certificate.
void check_roots(const std::string& roots);

}  // namespace anticrack::app
