// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/uzawa_reasons.hpp"

#include <sstream>

namespace anticrack::contact {

std::string oscillation_reason(const Answer& answer) {
  std::ostringstream text;
  text << "the iteration oscillates and cannot converge: theta = " << answer.theta
       << " is above theta* = " << answer.theta_star
       << " of this mesh (Theorem 4), criterion stuck near " << answer.criterion
       << "; set theta to auto, or below " << answer.theta_star;
  return text.str();
}

std::string overflow_reason(const Answer& answer) {
  std::ostringstream text;
  text << "the iterates are no longer finite with theta = " << answer.theta
       << ", theta* = " << answer.theta_star << "; scale the load down"
       << (answer.theta > answer.theta_star ? ", and set theta to auto" : "");
  return text.str();
}

std::string limit_reason(const Answer& answer, const UzawaOptions& options) {
  const KktResiduals& relative = answer.kkt_relative;
  std::ostringstream text;
  text << "after " << options.max_iterations << " iterations ";
  if (options.kkt_tolerance) {
    text << "the relative residuals are " << relative.equilibrium << " (equilibrium), "
         << relative.gap << " (gap), " << relative.sign << " (sign), " << relative.complementarity
         << " (complementarity), not all below kkt_tolerance = " << *options.kkt_tolerance;
  } else {
    text << "the criterion is " << answer.criterion << ", not below epsilon = " << options.epsilon;
  }
  text << " (theta = " << answer.theta << ", theta* = " << answer.theta_star
       << "); raise max_iterations or " << (options.kkt_tolerance ? "kkt_tolerance" : "epsilon");
  if (answer.theta < answer.theta_star / 2 || answer.theta > answer.theta_star) {
    text << ", or set theta to auto";
  }
  return text.str();
}

}  // namespace anticrack::contact
