// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/sweep.hpp"

#include <algorithm>
#include <cmath>

#include "results/result.hpp"

namespace anticrack::results {
namespace {

void widen(SweepSummary::Range& range, double value) {
  range.low = std::fmin(range.low, value);  // fmin passes over NaN
  range.high = std::fmax(range.high, value);
}

bool has_status(std::int32_t status, Status wanted) {
  return status == static_cast<std::int32_t>(wanted);
}

std::string wrong_length(const char* name, std::size_t have, std::size_t want) {
  return have == want ? std::string()
                      : std::string("sweep.") + name + " has " + std::to_string(have) +
                            " entries instead of " + std::to_string(want);
}

std::string length_fault(const Sweep& sweep) {
  const std::size_t rows = sweep.rows();
  for (const std::string& fault :
       {wrong_length("steps", sweep.steps.size(), rows),
        wrong_length("energy", sweep.energy.size(), rows),
        wrong_length("contact_length", sweep.contact_length.size(), rows),
        wrong_length("kkt", sweep.kkt.size(), rows),
        wrong_length("displacement", sweep.displacement.size(), rows * sweep.inclusions.size()),
        wrong_length("contact_nodes", sweep.contact_nodes.size(), 2 * sweep.contacts()),
        wrong_length("contact", sweep.contact.size(), rows * sweep.contacts()),
        sweep.coefficients.empty()
            ? std::string()
            : wrong_length("coefficients", sweep.coefficients.size(), rows * sweep.loads.size())}) {
    if (!fault.empty()) return fault;
  }
  return {};
}

std::string entry(const char* name, std::size_t index) {
  return std::string("sweep.") + name + "[" + std::to_string(index) + "]";
}

bool is_node(std::int32_t interface, std::int32_t node,
             const std::vector<std::size_t>& interface_nodes) {
  return interface >= 0 && static_cast<std::size_t>(interface) < interface_nodes.size() &&
         node >= 0 &&
         static_cast<std::size_t>(node) < interface_nodes[static_cast<std::size_t>(interface)];
}

std::string range_fault(const Sweep& sweep, const std::vector<std::size_t>& interface_nodes) {
  for (std::size_t i = 0; i < sweep.rows(); ++i) {
    if (name(static_cast<Status>(sweep.status[i])).empty()) {
      return entry("status", i) + " is " + std::to_string(sweep.status[i]) + ", no status";
    }
  }
  for (std::size_t i = 0; i < sweep.contacts(); ++i) {
    if (!is_node(sweep.contact_nodes[2 * i], sweep.contact_nodes[2 * i + 1], interface_nodes)) {
      return entry("contact_nodes", i) + " is no node of an interface";
    }
  }
  const auto odd = std::find_if(sweep.contact.begin(), sweep.contact.end(),
                                [](std::uint8_t value) { return value > 1; });
  if (odd != sweep.contact.end()) return "sweep.contact has a value other than 0 and 1";
  for (std::size_t i = 0; i < sweep.kept.size(); ++i) {
    const std::int32_t row = sweep.kept[i];
    if (row < 0 || static_cast<std::size_t>(row) >= sweep.rows() ||
        (i > 0 && row <= sweep.kept[i - 1])) {
      return entry("kept", i) + " is " + std::to_string(row) +
             ", out of order or no row of the sweep";
    }
  }
  return {};
}

}  // namespace

SweepSummary summary(const Sweep& sweep) {
  SweepSummary result;
  const std::size_t inclusions = sweep.inclusions.size();
  result.displacement.resize(inclusions);
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    const std::int32_t status = sweep.status[row];
    result.not_converged += has_status(status, Status::not_converged) ? 1U : 0U;
    result.failed += has_status(status, Status::failed) ? 1U : 0U;
    if (!has_status(status, Status::converged)) continue;
    ++result.converged;
    result.most_steps = std::max(result.most_steps, sweep.steps[row]);
    result.worst_kkt = std::fmax(result.worst_kkt, sweep.kkt[row]);
    widen(result.energy, sweep.energy[row]);
    widen(result.contact_length, sweep.contact_length[row]);
    for (std::size_t i = 0; i < inclusions; ++i) {
      widen(result.displacement[i], sweep.displacement[row * inclusions + i]);
    }
  }
  result.other = sweep.rows() - result.converged - result.not_converged - result.failed;
  return result;
}

std::string row_name(std::int64_t row) {
  return "row-" + std::to_string(row);
}

std::string first_fault(const Sweep& sweep, const std::vector<std::size_t>& interface_nodes) {
  const std::string fault = length_fault(sweep);
  return fault.empty() ? range_fault(sweep, interface_nodes) : fault;
}

}  // namespace anticrack::results
