// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/grow.hpp"

#include <utility>

#include "contact/answer.hpp"
#include "errors/errors.hpp"
#include "growth/preview.hpp"
#include "operators/mesh_parts.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {

struct Growth::Parts {
  std::shared_ptr<const MeshOperator> mesh_operator;
  PreparedLoad load;
  ForceOnTriangles force;
  growth::Preview preview;
};

Growth::Growth(std::shared_ptr<const MeshOperator> mesh_operator, PreparedLoad load,
               std::span<const growth::Path> paths, const std::stop_token& stop) {
  const stop::Scope scope(stop);
  mesh_operator->require_prepared(load, true);
  const PreparedLoad::Data& data = *load._data;
  if (data.balanced)
    throw errors::Error(errors::Reason::internal, "growth under a combination of loads");
  const MeshOperator::Parts& on_mesh = *mesh_operator->_parts;
  ForceOnTriangles force(data.condensed.parts, on_mesh.decomposition.subdomains);
  const growth::PreviewLoad on_paths{data.loads(), force.of_subdomains,
                                     data.condensed.parts.points};
  _parts.reset(new Parts{std::move(mesh_operator),
                         std::move(load),
                         std::move(force),
                         {*on_mesh.contact, *on_mesh.mesh, on_paths, paths}});
}

Growth::~Growth() = default;

std::vector<growth::Track> Growth::tracks() const { return _parts->preview.tracks(); }

const growth::Fronts& Growth::fronts() const noexcept { return _parts->preview.fronts(); }

std::vector<contact::Field> Growth::fields(const growth::State& state,
                                           const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.fields(state);
}

std::vector<contact::TipAnswer> Growth::ends(const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.ends();
}

contact::Answer Growth::answer(const growth::State& state, const contact::ActiveSetOptions& options,
                               contact::Observer& observer) {
  contact::Answer answer = _parts->preview.answer(state, options, observer);
  _parts->load._data->add_warnings(answer);
  return answer;
}

growth::Measured Growth::measure(const growth::State& state, const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.measure(state);
}

}  // namespace anticrack::operators
