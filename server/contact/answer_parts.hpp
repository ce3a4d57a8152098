// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "contact/answer.hpp"
#include "contact/uzawa.hpp"

namespace anticrack::contact {

/// Fills traces, contact, inclusions and (when asked) fields from the last iterate.
void describe(const TraceProblem& problem, const mesh::Mesh& mesh,
              std::span<const ddm::CondensedLoad> loads, const Uzawa& uzawa, bool fields,
              Answer& answer);

}  // namespace anticrack::contact
