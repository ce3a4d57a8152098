// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers to many load cases as columns: plain data, no linear algebra types.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/answer.hpp"

namespace anticrack::contact {

/// Entry k of every column belongs to row k.
struct SweepColumns {
  SweepColumns(std::size_t row_count, std::size_t inclusion_count, std::size_t contact_count)
      : inclusions(inclusion_count),
        contacts(contact_count),
        status(row_count, Status::not_converged),
        steps(row_count, 0),
        energy(row_count, 0),
        contact_length(row_count, 0),
        kkt(row_count, 0),
        displacement(row_count * inclusion_count, 0),
        contact(row_count * contact_count, 0) {}

  std::size_t rows() const noexcept { return status.size(); }

  std::size_t inclusions = 0;
  std::size_t contacts = 0;
  std::vector<Status> status;          ///< only converged rows hold results
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
