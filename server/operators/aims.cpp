// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/aims.hpp"

#include <algorithm>
#include <memory>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "contact/open_membrane.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

fem::Load Aim::force(const mesh::Mesh& mesh) const {
  fem::Load load;
  const std::string& name = mesh.inclusions[inclusion];
  if (value == &contact::InclusionAnswer::displacement_mesh)
    load.inclusion_forces[name] = 1;
  else
    load.inclusion_moments[name] = moment;
  return load;
}

std::vector<estimate::ForceOn> Aim::unit(std::size_t inclusions) const {
  std::vector<estimate::ForceOn> forces(inclusions);
  if (value == &contact::InclusionAnswer::displacement_mesh)
    forces[inclusion].force = 1;
  else
    forces[inclusion].moment = {moment.x, moment.y};
  return forces;
}

std::vector<Aim> aims(const MeshOperator::Parts& parts) {
  using Of = contact::InclusionAnswer;
  std::vector<Aim> aims;
  const std::vector<ddm::RigidMotion>& motions = parts.decomposition.skeleton.motions;
  for (std::size_t j = 0; j < motions.size(); ++j) {
    aims.push_back({motions[j].displacement,
                    j,
                    {},
                    &Of::displacement_mesh,
                    &Of::displacement_lower,
                    &Of::displacement_upper,
                    &Of::displacement_estimated_error,
                    &Of::displacement_scale});
    if (!motions[j].slope_x.empty())
      aims.push_back({motions[j].slope_x,
                      j,
                      {1, 0},
                      &Of::slope_x_mesh,
                      &Of::slope_x_lower,
                      &Of::slope_x_upper});
    if (!motions[j].slope_y.empty())
      aims.push_back({motions[j].slope_y,
                      j,
                      {0, 1},
                      &Of::slope_y_mesh,
                      &Of::slope_y_lower,
                      &Of::slope_y_upper});
  }
  return aims;
}

std::vector<contact::UnitForce> unit_forces(const MeshOperator::Parts& parts,
                                            std::span<const Aim> goals) {
  std::vector<contact::UnitForce> forces;
  for (const Aim& aim : goals) {
    stop::look("computing bounds of A");
    forces.push_back(parts.contact->unit_force(aim.goal));
  }
  return forces;
}

namespace {

std::vector<const ddm::Terms*> sums(std::span<const Aim> goals) {
  std::vector<const ddm::Terms*> sums;
  for (const Aim& aim : goals) sums.push_back(&aim.goal);
  return sums;
}

/// Fields of the unit forces, as by contact::OpenMembrane::fields.
std::vector<std::vector<double>> open_fields(const MeshOperator::Parts& parts,
                                             std::span<const Aim> goals) {
  std::vector<Eigen::VectorXd> r;
  for (contact::UnitForce& force : unit_forces(parts, goals)) r.push_back(std::move(force.r));
  const std::vector<contact::Opened> opened = parts.contact->solve_open({}, r);
  std::vector<contact::Displaced> displaced;
  for (std::size_t k = 0; k < goals.size(); ++k) displaced.push_back({&goals[k].goal, opened[k].d});
  std::vector<std::vector<double>> fields = parts.contact->fields_of(displaced);
  for (std::size_t k = 0; k < goals.size(); ++k)
    if (!opened[k].solved) fields[k].clear();
  return fields;
}

}  // namespace

const std::vector<estimate::MeshDual>& mesh_duals(const MeshOperator::Parts& parts,
                                                  const estimate::CutMesh& cut,
                                                  std::span<const Aim> goals) {
  constexpr std::size_t together = 8;  // fields in memory at once, for each thread
  constexpr std::size_t few = 8;       // another factor costs more than conjugate gradients
  return parts.mesh_duals.get([&] {
    const int threads = base::Threads::allowed();
    std::size_t bytes = at(threads) * together * sizeof(double) * cut.at.size();
    const bool factors = !parts.contact->condensed() && goals.size() > few;
    if (factors) bytes += parts.contact->bytes();  // as much as the first factor
    const Working counted(parts.at_work, bytes);
    std::unique_ptr<const contact::OpenMembrane> open;
    if (factors) open = parts.contact->open_membrane();
    // Ways lead out what one solve leaves; without them it has to be known that it is rounding.
    const bool refined = !std::isfinite(cut.ways.triangle);
    std::vector<estimate::MeshDual> duals(goals.size());
    base::at_once((goals.size() + together - 1) / together, threads, [&] {
      return [&](std::size_t block) {
        const std::size_t first = block * together;
        const auto some = goals.subspan(first, std::min(together, goals.size() - first));
        const std::vector<std::vector<double>> fields =
            open ? open->fields(sums(some), refined) : open_fields(parts, some);
        std::vector<std::vector<estimate::ForceOn>> units;
        for (const Aim& aim : some) units.push_back(aim.unit(parts.mesh->inclusions.size()));
        std::ranges::copy(
            estimate::mesh_duals(cut, fields, parts.contact->compliances(sums(some)), units),
            duals.begin() + static_cast<std::ptrdiff_t>(first));
      };
    });
    return duals;
  });
}

}  // namespace anticrack::operators
