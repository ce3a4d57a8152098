// SPDX-License-Identifier: GPL-3.0-or-later
//
// A private authority and certificates of it, made when a test needs them.
#pragma once

#include <string>

namespace anticrack::client {

struct Pem {
  std::string certificate;
  std::string key;
};

/// An authority; valid for a day.
Pem make_authority(const std::string& name);
/// A certificate for `name`, as common name and as DNS name or IPv4 address, signed by the authority.
Pem make_certificate(const std::string& name, const Pem& authority);

}  // namespace anticrack::client
