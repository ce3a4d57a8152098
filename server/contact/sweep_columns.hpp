// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers to many load cases as columns: plain data, no linear algebra types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/answer.hpp"

namespace anticrack::contact {

/// Entry k of every column belongs to row k. Made at its size once; filled row by row.
struct SweepColumns {
  /// Every entry of every column is there, to be written.
  SweepColumns(std::size_t row_count, std::size_t inclusion_count, std::size_t contact_count);

  /// Of all columns.
  std::size_t rows() const noexcept { return status.size(); }

  std::size_t inclusions = 0;
  std::size_t contacts = 0;
  std::vector<Status> status;          ///< no number of a row is right but where converged
  std::vector<std::int32_t> steps;     ///< of the active set
  std::vector<double> energy;          ///< Pi(u)
  std::vector<double> contact_length;  ///< over all cracks and delaminated parts
  std::vector<double> kkt;             ///< largest of the relative KktResiduals
  std::vector<double> displacement;    ///< (rows, inclusions), row-major: A of equation (5)
  std::vector<std::uint8_t> contact;   ///< (rows, contacts), row-major: 1 closed under pressure
};
ANTICRACK_FIELDS(SweepColumns, inclusions, contacts, status, steps, energy, contact_length, kkt,
                 displacement, contact)

}  // namespace anticrack::contact
