// SPDX-License-Identifier: GPL-3.0-or-later
#include <span>
#include <utility>

#include "errors/errors.hpp"
#include "operators/mesh_parts.hpp"

namespace anticrack::operators {

PreparedLoad::PreparedLoad(std::unique_ptr<Data> data) : _data(std::move(data)) {}
PreparedLoad::PreparedLoad(PreparedLoad&&) noexcept = default;
PreparedLoad& PreparedLoad::operator=(PreparedLoad&&) noexcept = default;
PreparedLoad::~PreparedLoad() = default;

void PreparedLoad::Data::add_warnings(contact::Answer& answer) const {
  answer.warnings.insert(answer.warnings.end(), condensed.warnings.begin(),
                         condensed.warnings.end());
}

void MeshOperator::require_prepared(const PreparedLoad& load, bool fields) const {
  if (!load._data || load._data->mesh_operator.get() != this)
    throw errors::Error(errors::Reason::internal, "a load that was prepared on another mesh");
  if (fields && !load._data->has_interior) {
    throw errors::Error(errors::Reason::internal,
                        "a combination of loads has no fields; prepare it as a load of its own");
  }
}

std::vector<std::variant<PreparedLoad, errors::Error>> MeshOperator::prepare(
    std::span<const fem::Load* const> loads, const std::stop_token& stop) const {
  std::vector<CondensedOutcome> condensed = condense_loads(
      loads, *_parts->mesh, _parts->decomposition, _parts->operators, _parts->neumann, stop);
  std::vector<std::variant<PreparedLoad, errors::Error>> prepared;
  prepared.reserve(condensed.size());
  for (auto& one : condensed) {
    if (auto* load = std::get_if<LoadOnTraces>(&one)) {
      for (ddm::CondensedLoad& on_subdomain : load->subdomains)
        on_subdomain.z_boundary.resize(0);  // as long as the interior, and for a basis alone
      prepared.emplace_back(PreparedLoad(std::make_unique<PreparedLoad::Data>(
          PreparedLoad::Data{shared_from_this(), std::move(*load)})));
    } else {
      prepared.emplace_back(std::get<errors::Error>(std::move(one)));
    }
  }
  return prepared;
}

contact::Answer MeshOperator::solve(const fem::Load& load, const contact::SolverOptions& options,
                                    bool fields, contact::Observer& observer,
                                    const std::stop_token& stop) const {
  if (std::holds_alternative<contact::UzawaOptions>(options))
    _parts->require_uzawa();  // before the work on the load
  const fem::Load* const one[] = {&load};
  const std::variant<PreparedLoad, errors::Error> prepared = std::move(prepare(one, stop).front());
  if (const auto* error = std::get_if<errors::Error>(&prepared)) throw errors::Error(*error);
  return solve(std::get<PreparedLoad>(prepared), options, fields, observer);
}

contact::Answer MeshOperator::solve(const PreparedLoad& load, const contact::SolverOptions& options,
                                    bool fields, contact::Observer& observer) const {
  const auto* uzawa = std::get_if<contact::UzawaOptions>(&options);
  if (uzawa != nullptr) _parts->require_uzawa();
  require_prepared(load, fields);
  const contact::CaseLoads loads = load._data->loads();
  contact::Answer answer =
      uzawa != nullptr
          ? contact::solve_uzawa(_parts->problem, *_parts->mesh, loads, *uzawa, fields, observer)
          : contact::solve_active_set(_parts->skeleton, *_parts->mesh, loads,
                                      std::get<contact::ActiveSetOptions>(options), fields,
                                      observer);
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
  contact::recover_fields(_parts->problem, cases);
}

}  // namespace anticrack::operators
