// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/answer.hpp"
#include "operators/mesh_parts.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

const tips::Tips& MeshOperator::Parts::all_tips() const {
  return tips.get([this] { return tips::Tips(*mesh, decomposition); });
}

ForceOnTriangles::ForceOnTriangles(const LoadParts& parts,
                                   const std::vector<ddm::Subdomain>& subdomains,
                                   const tips::Tips* tips)
    : linear(subdomains.size()) {
  for (std::size_t s = 0; s < subdomains.size(); ++s) {
    const ddm::Subdomain& one = subdomains[s];
    const std::size_t size = one.part.triangles.size();
    const auto room = [&] {
      linear[s] = std::make_unique_for_overwrite<double[]>(size);
      return linear[s].get();
    };
    std::optional<std::span<const std::int32_t>> only;
    if (tips != nullptr) only = tips->triangles(s);
    const bool made =
        fem::linear_load(one.part, parts.force, one.name, {one.node, one.triangle}, room, only);
    of_subdomains.emplace_back(made ? std::span<const double>(linear[s].get(), size)
                                    : parts.integrated[s].load);
  }
}

std::size_t MeshOperator::tip_count() const { return _parts->all_tips().size(); }

void MeshOperator::find_tips(const PreparedLoad& load, contact::Answer& answer,
                             const std::stop_token& stop) const {
  const stop::Scope scope(stop);
  require_prepared(load, false);
  const tips::Tips& tips = _parts->all_tips();
  if (tips.size() == 0) return;
  if (!load._data->has_interior || load._data->balanced) {  // which lacks f
    answer.tips = tips.without_numbers("rows of a sweep have no numbers of tips");
    return;
  }
  if (answer.status != contact::Status::converged) {
    answer.tips = tips.without_numbers("the load case did not converge");
    return;
  }
  const bool recovered = answer.fields.empty();
  if (recovered) {
    const PreparedLoad* const loads[] = {&load};
    contact::Answer* const answers[] = {&answer};
    recover_fields(loads, answers);
  }
  const LoadParts& parts = load._data->condensed.parts;
  const ForceOnTriangles force(parts, _parts->decomposition.subdomains, &tips);
  answer.tips = tips.of({answer, force.of_subdomains, parts.points});
  if (recovered) answer.fields.clear();
}

}  // namespace anticrack::operators
