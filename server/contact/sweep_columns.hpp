// SPDX-License-Identifier: GPL-3.0-or-later
//
// Answers to many load cases, as columns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "contact/status.hpp"
#include "fields/fields.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::contact {

struct AnswerSummary;
struct TipAnswer;

/// Whether an inclusion of the mesh tilts.
inline bool tilts(const mesh::Mesh& mesh) noexcept {
  return std::ranges::any_of(mesh.motions, &mesh::Motion::tilt);
}

/// Entry k of every column belongs to row k.
struct SweepColumns {
  SweepColumns(std::size_t row_count, std::size_t inclusion_count, std::size_t contact_count,
               bool tilting = false, bool bounded = false, std::size_t tip_count = 0)
      : inclusions(inclusion_count),
        contacts(contact_count),
        tips(tip_count),
        status(row_count, Status::not_converged),
        steps(row_count, 0),
        energy(row_count, 0),
        energy_lower(bounded ? row_count : 0, std::numeric_limits<double>::quiet_NaN()),
        energy_upper(energy_lower),
        energy_mesh(energy_lower.size(), 0),
        contact_length(row_count, 0),
        kkt(row_count, 0),
        displacement(row_count * inclusion_count, 0),
        displacement_lower(energy_lower.size() * inclusion_count,
                           std::numeric_limits<double>::quiet_NaN()),
        displacement_upper(displacement_lower),
        displacement_mesh(displacement_lower.size(), 0),
        slope(tilting ? row_count * inclusion_count * 2 : 0, 0),
        contact(row_count * contact_count, 0),
        intensity(row_count * tip_count, std::numeric_limits<double>::quiet_NaN()),
        energy_release_rate(intensity),
        energy_release_rate_spread(intensity) {}

  std::size_t rows() const noexcept { return status.size(); }
  /// Takes the energy and A of a row with their bounds from the answer; the columns must have been
  /// made with `bounded`.
  void take_bounds(std::size_t row, const AnswerSummary& answer);
  /// Takes the numbers of a tip, by its index; the columns must have been made with its count.
  void take_tip(std::size_t row, std::size_t tip, const TipAnswer& answer);

  std::size_t inclusions = 0;
  std::size_t contacts = 0;
  std::size_t tips = 0;             ///< 0 if their numbers were not asked for
  std::vector<Status> status;       ///< only converged rows hold results
  std::vector<std::int32_t> steps;  ///< of the active set
  std::vector<double> energy;       ///< Pi(u), as in AnswerSummary
  /// Bounds of the exact Pi, NaN where a row has none; empty if bounds were not asked for.
  std::vector<double> energy_lower, energy_upper;
  std::vector<double> energy_mesh;     ///< Pi of u on the mesh; empty if bounds were not asked for
  std::vector<double> contact_length;  ///< over all cracks and delaminated parts
  std::vector<double> kkt;             ///< largest of the relative KktResiduals
  std::vector<double> displacement;    ///< (rows, inclusions), row-major: A of equation (5)
  std::vector<double> displacement_lower, displacement_upper;  ///< bounds of A, as for the energy
  std::vector<double> displacement_mesh;                       ///< A on the mesh, as for the energy
  /// (rows, inclusions, 2), row-major: Bx, By of each on the mesh; empty where none tilts.
  std::vector<double> slope;
  std::vector<std::uint8_t> contact;  ///< (rows, contacts), row-major: 1 closed under pressure
  /// (rows, tips), row-major: as in TipAnswer, NaN where a tip has no such number.
  std::vector<double> intensity, energy_release_rate, energy_release_rate_spread;
};
ANTICRACK_FIELDS(SweepColumns, inclusions, contacts, tips, status, steps, energy, energy_lower,
                 energy_upper, energy_mesh, contact_length, kkt, displacement, displacement_lower,
                 displacement_upper, displacement_mesh, slope, contact, intensity,
                 energy_release_rate, energy_release_rate_spread)

}  // namespace anticrack::contact
