// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/answer.hpp"
#include "operators/mesh_parts.hpp"
#include "operators/row_tips.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

const tips::Tips& MeshOperator::Parts::all_tips() const {
  return tips.get([this] { return tips::Tips(*mesh, decomposition); });
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
  const auto forces = forces_on_corners(_parts->decomposition.subdomains, parts);
  const std::vector<std::span<const double>> force(forces.begin(), forces.end());
  answer.tips = tips.of({answer, force, parts.points});
  if (recovered) answer.fields.clear();
}

}  // namespace anticrack::operators
