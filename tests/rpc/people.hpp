// SPDX-License-Identifier: GPL-3.0-or-later
//
// A server that knows three people by their tokens.
#pragma once

#include <string>

#include "access/tokens.hpp"
#include "digest/digest.hpp"
#include "rpc/running_server.hpp"

namespace anticrack::testing {

inline const std::string owner_token = "token-of-ada";
inline const std::string other_token = "token-of-bob";
inline const std::string admin_token = "token-of-root";
inline const std::string wrong_token = "token-of-nobody";

inline access::TokenTable people() {
  const auto hash = [](const std::string& token) { return digest::Sha256().add(token).finish(); };
  return access::TokenTable::parse("ada user " + hash(owner_token) + "\nbob user " +
                                       hash(other_token) + "\nroot admin " + hash(admin_token),
                                   "people");
}

}  // namespace anticrack::testing
