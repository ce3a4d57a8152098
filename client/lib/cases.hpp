// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cases, read by the server (CaseService; requests and answers are those of
// anticrack/v1/case.proto).
#pragma once

#include <stop_token>

#include "anticrack/v1/case.pb.h"
#include "connection.hpp"
#include "error.hpp"

namespace anticrack::client {

/// The requests for which a case stands. Threads, retries and Interrupted are as in meshes.hpp.
/// Error: invalid_argument (Details::reason CASE_INVALID; what() has place, value and cure).
v1::ReadCaseResponse read_case(Connection& connection, const v1::ReadCaseRequest& request,
                               const std::stop_token& stop = {});

/// The meaning of the keys of cases that a name selects. Threads, retries and Interrupted are as
/// above. Error: invalid_argument (no such key; what() has the nearest).
v1::ListCaseKeysResponse list_case_keys(Connection& connection,
                                        const v1::ListCaseKeysRequest& request,
                                        const std::stop_token& stop = {});

}  // namespace anticrack::client
