// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/uzawa_block.hpp"

#include <optional>
#include <utility>

#include "base/at.hpp"
#include "contact/uzawa_block.hpp"
#include "errors/errors.hpp"
#include "operators/mesh_parts.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

struct UzawaBlock::State {
  State(std::shared_ptr<const MeshOperator> of_mesh, const contact::TraceProblem& problem,
        contact::Mass mass, int capacity)
      : mesh_operator(std::move(of_mesh)),
        columns(problem, mesh_operator->mesh(), mass, capacity),
        loads(at(capacity)),
        stops(at(capacity)) {}

  std::shared_ptr<const MeshOperator> mesh_operator;
  contact::UzawaBlock columns;                     // refers to the operator and to the loads
  std::vector<std::optional<PreparedLoad>> loads;  // by place
  std::vector<std::stop_token> stops;              // by place
};

UzawaBlock::UzawaBlock(std::shared_ptr<const MeshOperator> mesh_operator, contact::Mass mass,
                       int capacity) {
  const MeshOperator::Parts& parts = *mesh_operator->_parts;
  if (!parts.uzawa_obstacle.empty())
    throw errors::Error(errors::Reason::not_implemented, parts.uzawa_obstacle).at("uzawa");
  _state = std::make_unique<State>(std::move(mesh_operator), parts.problem, mass, capacity);
}

UzawaBlock::~UzawaBlock() = default;

int UzawaBlock::columns() const noexcept { return _state->columns.columns(); }

int UzawaBlock::capacity() const noexcept { return _state->columns.capacity(); }

int UzawaBlock::add(PreparedLoad load, const contact::UzawaOptions& options, bool fields,
                    contact::Observer& observer, std::stop_token stop) {
  _state->mesh_operator->require_prepared(load, fields);
  // The column refers to the load's data, which stay in place when the PreparedLoad moves.
  const int place = _state->columns.add(load._data->loads(), options, fields, observer);
  _state->loads[at(place)] = std::move(load);
  _state->stops[at(place)] = std::move(stop);
  return place;
}

void UzawaBlock::step() { _state->columns.step(); }

/// An answer that is stopped meanwhile is cancelled.
void UzawaBlock::measure(const PreparedLoad& load, contact::Answer& answer,
                         const std::stop_token& stop) const {
  if (answer.status == contact::Status::cancelled) return;
  try {
    const stop::Scope scope(stop);
    const MeshOperator& mesh_operator = *_state->mesh_operator;
    const bool recovered = answer.fields.empty() && load._data->has_interior;
    if (recovered) {
      const PreparedLoad* const loads[] = {&load};
      contact::Answer* const answers[] = {&answer};
      mesh_operator.recover_fields(loads, answers);
    }
    if (!answer.fields.empty()) mesh_operator.find_boundary(load, answer);
    mesh_operator.find_tips(load, answer, stop);
    if (recovered) answer.fields.clear();
  } catch (const errors::Error& error) {
    if (error.reason() != errors::Reason::cancelled || !stop.stop_requested()) throw;
  }
  if (stop.stop_requested()) answer.status = contact::Status::cancelled;
}

std::vector<UzawaBlock::Ended> UzawaBlock::take_ended() {
  std::vector<Ended> ended;
  for (contact::UzawaBlock::Ended& one : _state->columns.take_ended()) {
    std::optional<PreparedLoad>& load = _state->loads[at(one.place)];
    load->_data->add_warnings(one.answer);
    measure(*load, one.answer, _state->stops[at(one.place)]);
    load.reset();
    ended.push_back({one.place, std::move(one.answer)});
  }
  return ended;
}

}  // namespace anticrack::operators
