// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "contact/joined_membrane.hpp"
#include "ddm/subdomain_factor.hpp"

namespace anticrack::contact {

/// The joined membrane with every contact open: a factor of K on [x d] of its own, with which unit
/// forces take two solves each, many at once. Keeps a reference.
class OpenMembrane {
 public:
  /// As JoinedMembrane.
  explicit OpenMembrane(const JoinedMembrane& membrane);

  /// u of a unit force on each sum, as fields_of; empty where rounding decides it. Bits are those
  /// of each alone.
  std::vector<std::vector<double>> fields(std::span<const ddm::Terms* const> sums) const;

 private:
  const JoinedMembrane& _membrane;
  ddm::SubdomainFactor _factor;
};

}  // namespace anticrack::contact
