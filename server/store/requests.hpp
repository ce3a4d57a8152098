// SPDX-License-Identifier: GPL-3.0-or-later
//
// The rules of requests and of what they refer to, and what is said where they are broken: the same
// in every store.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::records {
struct JobSpec;
struct MeshRecord;
}  // namespace anticrack::records

namespace anticrack::store {

/// The uploads to which a job refers, each once.
std::vector<std::string> uploads_of(const records::JobSpec& spec);
/// The upload of which a mesh is made; empty if of none.
std::string upload_of(const records::MeshRecord& record);

/// Throws errors::Error (request_id_reused) if the job `id`, which was made by this request id, had
/// another fingerprint.
void require_same_request(const std::string& request_id, const std::string& id,
                          const std::string& its_fingerprint, const std::string& fingerprint);

/// Throws errors::Error (internal) unless this is the encoding of the record's triangulation.
void require_triangulation(const records::MeshRecord& record, std::span<const std::byte> encoded);

/// The error (not_found) for an unknown id.
errors::Error unknown(const std::string& collection, const std::string& id);
/// The error (in_use) of an upload that cannot be erased yet.
errors::Error upload_in_use(const std::string& sha256);

}  // namespace anticrack::store
