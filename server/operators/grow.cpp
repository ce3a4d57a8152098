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
  /// What refers to a prepared load.
  struct Acting {
    Acting(PreparedLoad prepared, const MeshOperator::Parts& on_mesh)
        : load(std::move(prepared)),
          force(load._data->condensed.parts, on_mesh.decomposition.subdomains),
          on_paths{load._data->loads(), force.of_subdomains, load._data->condensed.parts.points} {
      if (load._data->balanced)
        throw errors::Error(errors::Reason::internal, "growth under a combination of loads");
    }
    PreparedLoad load;
    ForceOnTriangles force;
    growth::PreviewLoad on_paths;
  };
  Parts(std::shared_ptr<const MeshOperator> on_mesh, PreparedLoad load,
        std::optional<PreparedLoad> dead_load, std::span<const growth::Path> paths)
      : mesh_operator(std::move(on_mesh)),
        live(std::move(load), *mesh_operator->_parts),
        preview(*mesh_operator->_parts->contact, *mesh_operator->_parts->mesh, live.on_paths, paths,
                dead_load ? &dead.emplace(std::move(*dead_load), *mesh_operator->_parts).on_paths
                          : nullptr) {}

  std::shared_ptr<const MeshOperator> mesh_operator;
  Acting live;
  std::optional<Acting> dead;
  growth::Preview preview;
};

Growth::Growth(std::shared_ptr<const MeshOperator> mesh_operator, PreparedLoad load,
               std::span<const growth::Path> paths, const std::stop_token& stop,
               std::optional<PreparedLoad> dead) {
  const stop::Scope scope(stop);
  mesh_operator->require_prepared(load, true);
  if (dead) mesh_operator->require_prepared(*dead, true);
  _parts =
      std::make_unique<Parts>(std::move(mesh_operator), std::move(load), std::move(dead), paths);
}

Growth::~Growth() = default;

std::vector<growth::Track> Growth::tracks() const { return _parts->preview.tracks(); }

const growth::Fronts& Growth::fronts() const noexcept { return _parts->preview.fronts(); }

std::vector<contact::Field> Growth::fields(const growth::State& state, double t,
                                           const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.fields(state, t);
}

std::vector<contact::TipAnswer> Growth::ends(const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.ends();
}

contact::Answer Growth::answer(const growth::State& state, const contact::ActiveSetOptions& options,
                               contact::Observer& observer) {
  contact::Answer answer = _parts->preview.answer(state, options, observer);
  _parts->live.load._data->add_warnings(answer);
  if (_parts->dead) _parts->dead->load._data->add_warnings(answer);
  return answer;
}

growth::Measured Growth::measure(const growth::State& state, const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.measure(state);
}

growth::Measured Growth::measure(const growth::State& state, const growth::Sought& sought,
                                 const std::stop_token& stop) {
  const stop::Scope scope(stop);
  return _parts->preview.measure(state, sought);
}

}  // namespace anticrack::operators
