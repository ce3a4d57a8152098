// SPDX-License-Identifier: GPL-3.0-or-later
//
// The domain's records as answers. Pure functions.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "anticrack/v1/mesh.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "store/block.hpp"
#include "store/records.hpp"

namespace anticrack::jobs {
struct SampleRun;
}

namespace anticrack::rpc {

/// A job's message is kept below this, so that it fits in gRPC's 4 MiB with what is around it.
constexpr std::size_t max_job_message_bytes = 3u << 20;

/// `pinned`: its operators stay in memory.
v1::Mesh from_domain(const store::MeshRecord& record, bool pinned);

/// Names of a mesh's interfaces, by index.
using InterfaceNames = std::vector<std::string>;

/// The whole job. Where it would be larger than max_job_message_bytes its contact intervals are
/// left out: ReadResult has them as traces.
v1::Job from_domain(const store::JobRecord& record, const InterfaceNames& interfaces);

/// One for one.
v1::Job::State from_domain(store::JobState state) noexcept;

/// `name` of the load case.
v1::LoadCaseAnswer from_domain(const store::CaseRecord& record, const std::string& name,
                               const InterfaceNames& interfaces);

/// What of a block a client needs to read it.
v1::BlockLayout layout_of(const store::BlockSource& block);

/// Appends every sample to every array: one allocation an array, one copy an array and run.
void append(v1::Samples& samples, const std::vector<jobs::SampleRun>& runs);

/// To the nanosecond.
google::protobuf::Timestamp to_timestamp(store::Clock::time_point time);
google::protobuf::Duration to_duration(std::chrono::nanoseconds duration);

}  // namespace anticrack::rpc
