// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tension_laws.hpp"

#include <fmt/core.h>

#include <string>
#include <variant>

#include "base/at.hpp"
#include "errors/placed.hpp"
#include "fem/tension.hpp"

namespace anticrack::meshes {
namespace {

std::string region_field(std::size_t i) { return fmt::format("regions[{}].tension_law", i); }
std::string option_field(const std::string& name) { return "options.tension_laws[" + name + "]"; }

/// The field in which the law of a subdomain was written.
std::string field_of(const records::MeshDefinition& definition, const std::string& subdomain) {
  if (std::holds_alternative<records::UploadRef>(definition)) return option_field(subdomain);
  if (const auto* source = std::get_if<records::GeometrySource>(&definition)) {
    const std::vector<mesh::RegionSpec>& regions = source->geometry.regions;
    for (std::size_t i = 0; i < regions.size(); ++i)
      if (regions[i].name == subdomain) return "geometry." + region_field(i);
  }
  return "tension_law";
}

/// The triangles of a subdomain, with their own numbers of nodes.
fem::Triangulation part_of(const mesh::Mesh& mesh, std::size_t subdomain) {
  fem::Triangulation part;
  std::vector<std::int32_t> local(mesh.node_count(), -1);
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    if (at(mesh.subdomain[c / 3]) != subdomain) continue;
    std::int32_t& node = local[at(mesh.triangles[c])];
    if (node < 0) {
      node = static_cast<std::int32_t>(part.node_count());
      const mesh::Point place = mesh::position(mesh, mesh.triangles[c]);
      part.xy.insert(part.xy.end(), place.begin(), place.end());
    }
    part.triangles.push_back(node);
  }
  return part;
}

}  // namespace

void check_laws(const records::MeshDefinition& definition, std::size_t max_expression_bytes) {
  if (const auto* source = std::get_if<records::GeometrySource>(&definition)) {
    const std::vector<mesh::RegionSpec>& regions = source->geometry.regions;
    for (std::size_t i = 0; i < regions.size(); ++i) {
      if (!regions[i].tension_law) continue;
      // A region with an outline has no point of its own.
      errors::below(region_field(i), [&] {
        fem::check(*regions[i].tension_law, max_expression_bytes,
                   regions[i].outline ? nullptr : &regions[i].at);
      });
    }
  } else if (const auto* upload = std::get_if<records::UploadRef>(&definition)) {
    for (const auto& [name, law] : upload->options.tension_laws)
      errors::below(option_field(name),
                    [&law = law, max_expression_bytes] { fem::check(law, max_expression_bytes); });
  }
}

void summarize_tension(const mesh::Mesh& mesh, records::MeshRecord& record) {
  for (std::size_t s = 0; s < record.subdomains.size(); ++s) {
    records::SubdomainSummary& to = record.subdomains[s];
    if (!mesh.tension.empty()) to.tension = mesh.tension[s];
    if (mesh.tension_laws.empty() || mesh.tension_laws[s].along.empty()) continue;
    to.tension_law = mesh.tension_laws[s];
    errors::below(field_of(record.definition, to.name), [&] {
      to.tension = fem::tension(part_of(mesh, s), *to.tension_law, to.name).mean;
    });
  }
}

}  // namespace anticrack::meshes
