// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cases, read by the server, and jobs on it: submit them, watch them, read their results
// (CaseService, SolveService and ServerService; requests and answers, with units, are those of
// anticrack/v1/case.proto, job.proto, solve.proto and server.proto).
//
// Every function may be called from any thread. It returns when the server has answered, or throws:
//   Error        the server refused; each call lists its codes. A lost connection is first retried
//                with back-off (ConnectionOptions::retry) and becomes Error (unavailable) in the
//                end; RESOURCE_EXHAUSTED with a retry delay is retried, too. Retrying is safe:
//                every call here can be repeated.
//   Interrupted  once `stop` is requested. The job continues; only cancel_job ends it.
#pragma once

#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>

#include "anticrack/v1/case.pb.h"
#include "anticrack/v1/server.pb.h"
#include "anticrack/v1/solve.pb.h"
#include "block.hpp"
#include "connection.hpp"
#include "error.hpp"

namespace anticrack::client {

/// The requests for which a case stands. Error: invalid_argument (Details::reason CASE_INVALID;
/// what() has place, value and cure).
v1::ReadCaseResponse read_case(Connection& connection, const v1::ReadCaseRequest& request,
                               const std::stop_token& stop = {});

/// The meaning of the keys of cases that a name selects. Error: invalid_argument (no such key;
/// what() has the nearest).
v1::ListCaseKeysResponse list_case_keys(Connection& connection,
                                        const v1::ListCaseKeysRequest& request,
                                        const std::stop_token& stop = {});

/// A random UUID (version 4), 36 characters, which makes a submission idempotent.
std::string make_uuid();

/// Submits a job and returns it with its name, QUEUED or WAITING_FOR_MESH; it outlives this client
/// and the server's restarts from then on. `request_id` (see make_uuid) makes retries safe: one
/// id, one job. If it is empty, a lost response may leave two.
/// Error: invalid_argument (Details::fields names the fields), not_found (the mesh),
/// resource_exhausted (the queue or the disk is full), unimplemented (an older server).
v1::Job create_job(Connection& connection, const v1::JobSpec& spec, const std::string& request_id,
                   const std::stop_token& stop = {});

/// The present state of the job with this name ("jobs/ID"). Error: not_found.
v1::Job get_job(Connection& connection, const std::string& name, const std::stop_token& stop = {});

/// One page of the jobs this client may see, the newest first by default, without load cases and
/// answers unless the request asks for the full view. Error: invalid_argument (page token
/// or size).
v1::ListJobsResponse list_jobs(Connection& connection, const v1::ListJobsRequest& request,
                               const std::stop_token& stop = {});

/// Stops a job. Returns at once; the job ends CANCELLED within an iteration and keeps the load
/// cases that it has finished. A job that has ended is returned unchanged. Error: not_found.
v1::Job cancel_job(Connection& connection, const std::string& name,
                   const std::stop_token& stop = {});

/// Deletes a job that has ended, and its results. Error: not_found, failed_precondition (not
/// ended).
void delete_job(Connection& connection, const std::string& name, const std::stop_token& stop = {});

/// Whether a job has ended and no longer changes: SUCCEEDED, NOT_CONVERGED, FAILED or CANCELLED.
bool ended(v1::JobStatus::State state);

/// Passes on every event of a job after number `after_sequence` (0: from the earliest kept), in
/// order and once each, until it has ended; returns the job as it ended, also one that FAILED: see
/// JobStatus.state. After a lost connection goes on behind the last event; where the server keeps
/// that one no longer, starts over with a snapshot and the earliest event kept (their numbers may
/// then have been seen before). `event` is called on this thread, for snapshots and heartbeats too;
/// to leave early it requests `stop` rather than throw. Error: not_found.
v1::Job watch_job(Connection& connection, const std::string& name, std::uint64_t after_sequence,
                  const std::function<void(const v1::WatchJobResponse&)>& event,
                  const std::stop_token& stop = {});

/// Traces and histories of an ended job (ReadResultResponse in solve.proto lists the arrays); after
/// a lost connection the read goes on where it was. Error: not_found, failed_precondition (not
/// ended, ended without results, or expired), data_loss (damaged several times in a row).
Block read_result(Connection& connection, const std::string& name,
                  const std::stop_token& stop = {});

/// Version, features, limits and load of the server.
v1::ServerInfo server_info(Connection& connection, const std::stop_token& stop = {});

}  // namespace anticrack::client
