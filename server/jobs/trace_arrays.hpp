// SPDX-License-Identifier: GPL-3.0-or-later
//
// The arrays that the results of load cases and of sweeps have in common.
#pragma once

#include <string>
#include <vector>

#include "contact/answer.hpp"
#include "store/block.hpp"

namespace anticrack::jobs {

/// interfaces/I/s, x, y, kind.
void add_geometry(store::BlockBuilder& builder,
                  const std::vector<contact::TraceGeometry>& interfaces);

/// FOLDER I/u_minus, u_plus, jump, pressure, contact; `folder` ends with a slash.
void add_traces(store::BlockBuilder& builder, const std::string& folder,
                const std::vector<contact::Trace>& traces);

}  // namespace anticrack::jobs
