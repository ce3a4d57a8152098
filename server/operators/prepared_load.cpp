// SPDX-License-Identifier: GPL-3.0-or-later
#include <span>
#include <utility>

#include "contact/answer.hpp"
#include "errors/errors.hpp"
#include "operators/mesh_parts.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

void PreparedLoad::Data::add_warnings(contact::Answer& answer) const {
  answer.warnings.insert(answer.warnings.end(), condensed.warnings.begin(),
                         condensed.warnings.end());
}

void MeshOperator::require_prepared(const PreparedLoad& load, bool fields) const {
  if (!load._data || load._data->mesh_operator.get() != this)
    throw errors::Error(errors::Reason::internal, "a load that was prepared on another mesh");
  if (fields && !load._data->has_interior) {
    throw errors::Error(
        errors::Reason::internal,
        "a combination of loads has no fields; prepare it as a load of its own, or the "
        "basis with bounds");
  }
}

std::vector<std::variant<PreparedLoad, errors::Error>> MeshOperator::prepare(
    std::span<const fem::Load* const> loads, const std::stop_token& stop) const {
  const stop::Scope scope(stop);
  std::vector<CondensedOutcome> condensed = condense_loads(
      loads, *_parts->mesh, _parts->decomposition, _parts->condense(), _parts->neumann, true);
  std::vector<std::variant<PreparedLoad, errors::Error>> prepared;
  prepared.reserve(condensed.size());
  for (auto& one : condensed) {
    if (auto* load = std::get_if<LoadOnTraces>(&one)) {
      for (ddm::CondensedLoad& on_subdomain : load->subdomains)
        on_subdomain.z_boundary.resize(0);  // large, and only bases need it
      prepared.emplace_back(PreparedLoad(std::make_shared<const PreparedLoad::Data>(
          PreparedLoad::Data{shared_from_this(), std::move(*load)})));
    } else {
      prepared.emplace_back(std::get<errors::Error>(std::move(one)));
    }
  }
  return prepared;
}

contact::Answer MeshOperator::solve(const PreparedLoad& load,
                                    const contact::ActiveSetOptions& options, bool fields,
                                    contact::Observer& observer) const {
  require_prepared(load, fields);
  contact::Answer answer = contact::solve_active_set(
      *_parts->contact, *_parts->mesh, load._data->loads(), options, fields, observer);
  load._data->add_warnings(answer);
  return answer;
}

void MeshOperator::recover_fields(std::span<const PreparedLoad* const> loads,
                                  std::span<contact::Answer* const> answers) const {
  std::vector<contact::SolvedCase> cases;
  cases.reserve(loads.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    require_prepared(*loads[i], true);
    cases.push_back({loads[i]->_data->condensed.subdomains, *answers[i]});
  }
  _parts->contact->recover_fields(cases);
}

}  // namespace anticrack::operators
