// SPDX-License-Identifier: GPL-3.0-or-later
//
// SolveService and ServerService. Every function throws Error, and Interrupted once `stop` is
// requested; a lost connection is retried with back-off first.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

#include "anticrack/v1/server.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "client/block.hpp"
#include "client/connection.hpp"
#include "client/error.hpp"

namespace anticrack::client {

/// `request_id` (see make_uuid) makes the retries harmless: one id, one job.
v1::Job create_job(Connection& connection, const v1::Job& job, const std::string& request_id,
                   const std::stop_token& stop = {});

v1::Job get_job(Connection& connection, const std::string& name, const std::stop_token& stop = {});

v1::ListJobsResponse list_jobs(Connection& connection, const v1::ListJobsRequest& request,
                               const std::stop_token& stop = {});

v1::Job cancel_job(Connection& connection, const std::string& name,
                   const std::stop_token& stop = {});

void delete_job(Connection& connection, const std::string& name, const std::stop_token& stop = {});

/// Whether a job will not change any more.
bool ended(v1::Job::State state);

/// Passes on every event of a job after number `after_sequence`, in order and once each, until it
/// has ended; returns the job as it ended. After a lost connection goes on behind the last event;
/// where the server keeps that one no longer, starts over with a snapshot and the earliest event
/// kept (their numbers may then have been seen before). `event` is called on this thread; snapshots
/// and heartbeats are passed on too.
v1::Job watch_job(Connection& connection, const std::string& name, std::uint64_t after_sequence,
                  const std::function<void(const v1::WatchJobResponse&)>& event,
                  const std::stop_token& stop = {});

/// Traces and histories of an ended job; an interrupted read goes on where it was.
Block read_result(Connection& connection, const std::string& name,
                  const std::stop_token& stop = {});

v1::ServerInfo server_info(Connection& connection, const std::stop_token& stop = {});

}  // namespace anticrack::client
