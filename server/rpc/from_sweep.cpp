// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/from_sweep.hpp"

#include <algorithm>
#include <chrono>

#include "rpc/from_domain.hpp"
#include "rpc/names.hpp"

namespace anticrack::rpc {
namespace {

template <class To, class From>
void append_rows(To& to, const std::vector<From>& from, std::size_t first, std::size_t count) {
  const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
  to.Add(begin, begin + static_cast<std::ptrdiff_t>(count));
}

}  // namespace

v1::Sweep from_domain(const store::SweepSpec& sweep) {
  v1::Sweep to;
  v1::Sweep::Matrix& matrix = sweep.cases == store::SweepSpec::Cases::combinations
                                  ? *to.mutable_coefficients()
                                  : *to.mutable_nodal_forces();
  matrix.set_upload(upload_name(sweep.upload));
  to.mutable_traces()->Add(sweep.traces.begin(), sweep.traces.end());
  return to;
}

v1::SweepAnswer from_domain(const store::SweepSpec& sweep, const store::SweepRecord& record) {
  v1::SweepAnswer to;
  to.set_rows(sweep.rows);
  to.set_converged(record.converged);
  to.set_not_converged(record.not_converged);
  to.set_failed(record.failed);
  to.set_most_steps(record.most_steps);
  to.set_worst_kkt(record.worst_kkt);
  *to.mutable_solve_time() = to_duration(std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::duration<double>(record.seconds)));
  to.mutable_warnings()->Assign(record.warnings.begin(), record.warnings.end());
  return to;
}

v1::LoadCaseAnswer::Status from_domain(contact::Status status) noexcept {
  switch (status) {
    case contact::Status::converged:
      return v1::LoadCaseAnswer::STATUS_CONVERGED;
    case contact::Status::not_converged:
      return v1::LoadCaseAnswer::STATUS_NOT_CONVERGED;
    case contact::Status::cancelled:
      return v1::LoadCaseAnswer::STATUS_CANCELLED;
  }
  return v1::LoadCaseAnswer::STATUS_UNSPECIFIED;
}

void append(v1::SweepRows& rows, const jobs::RowsEvent& event, std::size_t first,
            std::size_t count) {
  const contact::SweepColumns& from = *event.rows;
  if (first >= from.rows()) return;
  count = std::min(count, from.rows() - first);
  if (rows.status().empty()) rows.set_first_row(event.first_row + first);
  rows.mutable_status()->Reserve(rows.status_size() + static_cast<int>(count));
  for (std::size_t row = first; row < first + count; ++row) {
    rows.add_status(from_domain(from.status[row]));
  }
  append_rows(*rows.mutable_steps(), from.steps, first, count);
  append_rows(*rows.mutable_energy(), from.energy, first, count);
  append_rows(*rows.mutable_contact_length(), from.contact_length, first, count);
  append_rows(*rows.mutable_kkt(), from.kkt, first, count);
  append_rows(*rows.mutable_displacement(), from.displacement, first * from.inclusions,
              count * from.inclusions);
}

}  // namespace anticrack::rpc
