// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/mesh_operator.hpp"

#include <algorithm>
#include <optional>

#include "base/at_once.hpp"
#include "contact/condensed_problem.hpp"
#include "contact/joined_problem.hpp"
#include "contact/traces.hpp"
#include "ddm/blas.hpp"
#include "operators/mesh_parts.hpp"
#include "operators/working.hpp"
#include "stop/stop.hpp"

namespace anticrack::operators {
namespace {

std::vector<ddm::SubdomainOperator> factorise_subdomains(
    const std::vector<ddm::Subdomain>& subdomains, int threads) {
  std::vector<std::optional<ddm::SubdomainOperator>> done(subdomains.size());
  // If there are fewer subdomains than threads, several threads share one.
  const int each = std::max(1, threads / std::max(1, static_cast<int>(subdomains.size())));
  base::at_once(subdomains.size(), threads,
                [&] { return [&](std::size_t s) { done[s].emplace(subdomains[s], each); }; });
  std::vector<ddm::SubdomainOperator> operators;
  operators.reserve(done.size());
  for (std::optional<ddm::SubdomainOperator>& subdomain : done)
    operators.push_back(std::move(*subdomain));
  return operators;
}

constexpr const char* joined_obstacle =
    "the interfaces have too many nodes for the dense matrices of Algorithm 2; use the method "
    "\"active-set\"";

template <class Value>
std::size_t bytes_of(const std::vector<Value>& values) {
  return values.capacity() * sizeof(Value);
}

std::size_t bytes_of(const mesh::Mesh& mesh) {
  std::size_t bytes = bytes_of(mesh.xy) + bytes_of(mesh.triangles) + bytes_of(mesh.subdomain) +
                      bytes_of(mesh.dirichlet);
  for (const mesh::Interface& interface : mesh.interfaces)
    bytes += bytes_of(interface.nodes) + bytes_of(interface.kind) + bytes_of(interface.inclusion);
  return bytes;
}

std::size_t bytes_of(const ddm::Decomposition& decomposition) {
  std::size_t bytes = bytes_of(decomposition.pairs) + bytes_of(decomposition.edges);
  for (const ddm::Subdomain& subdomain : decomposition.subdomains) {
    bytes += bytes_of(subdomain.part.xy) + bytes_of(subdomain.part.triangles) +
             bytes_of(subdomain.node) + bytes_of(subdomain.triangle) + bytes_of(subdomain.rigid) +
             bytes_of(subdomain.unknown) + subdomain.tension.bytes();
  }
  for (const std::vector<ddm::SidePair>& sides : decomposition.interface_sides)
    bytes += bytes_of(sides);
  return bytes;
}

}  // namespace

MeshOperator::Parts::Parts(std::shared_ptr<const mesh::Mesh> cut_mesh, int threads,
                           std::size_t condensed_up_to)
    : mesh(std::move(cut_mesh)),
      decomposition(ddm::cut(*mesh, threads)),
      neumann(*mesh, decomposition),
      operators(contact::is_joined(decomposition, condensed_up_to)
                    ? std::vector<ddm::SubdomainOperator>()
                    : factorise_subdomains(decomposition.subdomains, threads)),
      uzawa_obstacle(contact::is_joined(decomposition, condensed_up_to)
                         ? joined_obstacle
                         : ddm::uzawa_obstacle(decomposition, *mesh)),
      problem(decomposition, operators, uzawa_obstacle.empty()),
      sweep_geometry(problem),
      geometry(contact::trace_geometry(decomposition, *mesh)) {
  const bool joined = contact::is_joined(decomposition, condensed_up_to);
  const auto make_contact = [&] {
    if (joined)
      contact = std::make_unique<contact::JoinedProblem>(
          problem, threads, condensed_up_to == 0 ? 0 : contact::dense_contacts(problem));
    else
      contact = std::make_unique<contact::CondensedProblem>(problem);
  };
  // Most steps towards the factor of a joined membrane take one thread, and there are many tips:
  // another thread finds them meanwhile.
  base::at_once(joined && threads > 1 ? 2 : 1, threads, [&] {
    return [&](std::size_t part) {
      if (part == 0) return make_contact();
      // They are the longer part of many short cracks, and would end on one thread: a tenth of the
      // time of a thousand fibres. While both parts work, one thread more than `threads` does.
      const base::Threads helped(threads);
      try {
        all_tips();
      } catch (...) {  // the first load that asks for them tries again, and tells
      }
    };
  });
}

Condense MeshOperator::Parts::condense() const {
  return [this](std::size_t subdomain, const auto& of_nodes, const auto& dirichlet) {
    return contact->loads(subdomain, of_nodes, dirichlet);
  };
}

std::shared_ptr<const MeshOperator> MeshOperator::factorise(std::shared_ptr<const mesh::Mesh> mesh,
                                                            int threads, std::stop_token stop,
                                                            std::size_t condensed_up_to) {
  require_threadsafe_blas();
  const stop::Scope scope(stop);
  const base::Threads allowed(threads);
  stop::look("factorising a mesh");
  auto parts = std::make_shared<const Parts>(std::move(mesh), threads, condensed_up_to);
  return std::shared_ptr<const MeshOperator>(new MeshOperator(std::move(parts)));
}

const std::string& MeshOperator::uzawa_obstacle() const noexcept { return _parts->uzawa_obstacle; }

const mesh::Mesh& MeshOperator::mesh() const noexcept { return *_parts->mesh; }

const std::vector<contact::TraceGeometry>& MeshOperator::trace_geometry() const noexcept {
  return _parts->geometry;
}

const std::vector<std::int32_t>& MeshOperator::field_nodes(std::size_t subdomain) const {
  return _parts->decomposition.subdomains.at(subdomain).node;
}

const std::vector<std::int32_t>& MeshOperator::field_triangles(std::size_t subdomain) const {
  return _parts->decomposition.subdomains.at(subdomain).part.triangles;
}

std::vector<double> MeshOperator::field_tension(std::size_t subdomain) const {
  const ddm::Subdomain& one = _parts->decomposition.subdomains.at(subdomain);
  std::vector<double> all;
  for (std::size_t t = 0; t < one.part.triangle_count(); ++t) {
    const std::array<double, 3> tension = one.tension.matrix(t);
    all.insert(all.end(), tension.begin(), tension.end());
  }
  return all;
}

double MeshOperator::theta_star() const {
  return _parts->problem.theta_star(contact::Mass::lumped);
}

std::size_t MeshOperator::bytes() const noexcept {
  std::size_t bytes = sizeof(Parts) + _parts->at_work + bytes_of(*_parts->mesh) +
                      bytes_of(_parts->decomposition) + _parts->neumann.bytes();
  for (const ddm::SubdomainOperator& subdomain : _parts->operators) bytes += subdomain.bytes();
  bytes += _parts->contact->bytes();
  if (const estimate::CutMesh* cut = _parts->cut.known()) bytes += cut->bytes();
  if (const auto* duals = _parts->mesh_duals.known())
    bytes += duals->capacity() * sizeof(estimate::MeshDual);
  if (const auto* stiff = _parts->stiff.known(); stiff != nullptr && *stiff)
    bytes += (*stiff)->has.capacity();
  if (const tips::Tips* tips = _parts->tips.known()) bytes += tips->bytes();
  if (const BoundaryForces* boundary = _parts->boundary.known()) bytes += boundary->bytes();
  return bytes + _parts->sweep_geometry.bytes();
}

const estimate::CutMesh& MeshOperator::Parts::cut_mesh() const {
  return cut.get([this] { return estimate::cut_mesh(*mesh, decomposition); });
}

const estimate::StiffPart* MeshOperator::Parts::stiff_part() const {
  constexpr std::size_t bytes_per_triangle = 1200;  // of the factors
  const std::optional<estimate::StiffPart>& found = stiff.get([this] {
    const Working counted(at_work, bytes_per_triangle * mesh->triangle_count());
    return estimate::stiff_part(*mesh, decomposition, cut_mesh());
  });
  return found ? &*found : nullptr;
}

void require_threadsafe_blas() { ddm::require_threadsafe_blas(); }

}  // namespace anticrack::operators
