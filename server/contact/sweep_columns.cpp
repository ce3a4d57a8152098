// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/sweep_columns.hpp"

namespace anticrack::contact {

SweepColumns::SweepColumns(std::size_t row_count, std::size_t inclusion_count,
                           std::size_t contact_count)
    : inclusions(inclusion_count),
      contacts(contact_count),
      status(row_count, Status::not_converged),
      steps(row_count, 0),
      energy(row_count, 0),
      contact_length(row_count, 0),
      kkt(row_count, 0),
      displacement(row_count * inclusion_count, 0),
      contact(row_count * contact_count, 0) {}

}  // namespace anticrack::contact
