// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a solver tells of its iterations.
#pragma once

#include "contact/residuals.hpp"

namespace anticrack::contact {

/// One iteration as the paper and its users see it.
struct Sample {
  int iteration = 0;      ///< from 1
  double criterion = 1;   ///< max_i |u_k - u_{k-1}|_V^2 / |u_k|_V^2, step 3; 1 in the first
  double energy = 0;      ///< Pi_1 + Pi_2 at the iterate
  int contact_count = 0;  ///< crack nodes with positive pressure
  KktResiduals kkt;
};

/// Called at every iteration, on the solving thread; must be quick and must not throw.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Returns false to stop the load case (it ends cancelled).
  virtual bool on_iteration(const Sample& sample) = 0;
};

}  // namespace anticrack::contact
