// SPDX-License-Identifier: GPL-3.0-or-later
//
// The method ReadCase of the API (case.proto).
#pragma once

#include <cstddef>

#include "anticrack/v1/case.pb.h"

namespace anticrack::casefile {

struct Limits {
  int load_cases = 1'000;                            ///< most load cases of one job
  std::size_t request_bytes = std::size_t{4} << 20;  ///< most bytes of the requests made from it
};

/// The requests for which a case stands. Throws errors::Error: case_invalid, limit_exceeded. Linear
/// in the text.
v1::ReadCaseResponse read_case(const v1::ReadCaseRequest& request, const Limits& limits);

}  // namespace anticrack::casefile
