// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a user is told of Algorithm 2 when it did not converge, with what to change.
#pragma once

#include <string>

#include "contact/answer.hpp"

namespace anticrack::contact {

/// theta, theta_star and criterion of the answer are set.
std::string oscillation_reason(const Answer& answer);
std::string overflow_reason(const Answer& answer);
/// And the relative residuals.
std::string limit_reason(const Answer& answer, const UzawaOptions& options);

}  // namespace anticrack::contact
