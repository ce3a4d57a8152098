// SPDX-License-Identifier: GPL-3.0-or-later
//
// What both stores say of requests for jobs.
#pragma once

#include <string>
#include <vector>

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

}  // namespace anticrack::store
