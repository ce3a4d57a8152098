// SPDX-License-Identifier: GPL-3.0-or-later
//
// Records as the caller may see them: a record of somebody else is not_found, in exactly the words
// of one that does not exist.
#pragma once

#include <optional>
#include <string>

#include "access/identity.hpp"
#include "rpc/backend.hpp"

namespace anticrack::records {
struct JobRecord;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::rpc {

/// The record of an id, if visible. They throw errors::Error (not_found).
records::MeshRecord visible_mesh(const Backend& backend, const access::Identity& who,
                                 const std::string& id);
records::JobRecord visible_job(const Backend& backend, const access::Identity& who,
                               const std::string& id);

/// The value for Page::owner: an administrator sees all, or only what belongs to `owner` (empty: no
/// filter). Throws errors::Error (permission_denied) if a user asks for another's records.
std::optional<std::string> owner_filter(const access::Identity& who, const std::string& owner);

}  // namespace anticrack::rpc
