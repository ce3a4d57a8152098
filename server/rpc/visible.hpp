// SPDX-License-Identifier: GPL-3.0-or-later
//
// Records through the eyes of who asks: another's is not_found, in the very words in which one that
// does not exist is.
#pragma once

#include <optional>
#include <string>

#include "access/identity.hpp"
#include "records/records.hpp"
#include "rpc/backend.hpp"

namespace anticrack::rpc {

/// The record of an id. Throw errors::Error (not_found).
records::MeshRecord visible_mesh(const Backend& backend, const access::Identity& who,
                                 const std::string& id);
records::JobRecord visible_job(const Backend& backend, const access::Identity& who,
                               const std::string& id);

/// What Page::owner is to be: an administrator sees all, or what is of `owner` (empty: no filter).
/// Throws errors::Error (permission_denied) where a user asks for what is another's.
std::optional<std::string> owner_filter(const access::Identity& who, const std::string& owner);

}  // namespace anticrack::rpc
