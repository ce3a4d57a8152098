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

/// The requests that a case stands for. Threads, retries and Interrupted: as in meshes.hpp.
/// Error: invalid_argument (Details::reason CASE_INVALID; what() names place, value and cure).
v1::ReadCaseResponse read_case(Connection& connection, const v1::ReadCaseRequest& request,
                               const std::stop_token& stop = {});

/// What the keys of cases mean, as far as a name chooses them. Threads, retries and Interrupted: as
/// above. Error: invalid_argument (no such key; what() names the nearest).
v1::ListCaseKeysResponse list_case_keys(Connection& connection,
                                        const v1::ListCaseKeysRequest& request,
                                        const std::stop_token& stop = {});

}  // namespace anticrack::client
