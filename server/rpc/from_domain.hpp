// SPDX-License-Identifier: GPL-3.0-or-later
//
// Records and events as messages for clients: the messages in which records are stored
// (api/translations.hpp), cut to what fits in an answer. Pure functions.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "anticrack/v1/upload.pb.h"
#include "jobs/event_log.hpp"
#include "store/store.hpp"

namespace anticrack::rpc {

/// A job's message is kept below this, so that an answer with it fits in gRPC's 4 MiB.
constexpr std::size_t max_job_message_bytes = 3u << 20;

/// A mesh. `pinned`: whether its operators stay in memory.
v1::Mesh from_domain(const records::MeshRecord& record, bool pinned);

/// An upload. `ttl`: how long uploads are kept; 0: for ever.
v1::Upload from_domain(const store::UploadRecord& record, std::chrono::milliseconds ttl);

/// The whole job. If it would be larger than max_job_message_bytes, its tips, forces on the
/// boundary and contact intervals are left out; ReadResult has the latter as traces.
v1::Job from_domain(const records::JobRecord& record);
/// The job in JOB_VIEW_BASIC.
v1::Job basic(records::JobRecord record);

/// An answer, without tips and forces on the boundary if they do not fit. `name`: that of the load
/// case.
v1::LoadCaseAnswer from_domain(const records::CaseRecord& record, const std::string& name);

/// Appends the samples to the arrays, with one allocation per array and one copy per array and run.
void append(v1::Samples& samples, const std::vector<jobs::SampleRun>& runs);

}  // namespace anticrack::rpc
