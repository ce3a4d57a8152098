// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/identity.hpp"

#include <variant>

#include "store/canonical.hpp"

namespace anticrack::meshes {

namespace {

/// Clears options that have no effect with the preset.
mesh::MeshOptions effective(mesh::MeshOptions options) {
  if (options.preset == mesh::Preset::paper) options.size = 0;
  if (!mesh::graded(options.preset)) {
    options.tip_size = 0;
    options.grading = 0;
  }
  return options;
}

}  // namespace

std::string identity(const records::MeshDefinition& definition) {
  store::CanonicalHash hash;
  if (const auto* upload = std::get_if<records::UploadRef>(&definition)) {
    hash.add(std::string("upload")).add(upload->sha256).add_all(effective(upload->options));
  } else if (const auto* refinement = std::get_if<records::Refinement>(&definition)) {
    hash.add(std::string("refinement")).add_all(*refinement);
  } else {
    const auto& source = std::get<records::GeometrySource>(definition);
    hash.add(std::string("geometry")).add_all(source.geometry).add_all(effective(source.options));
  }
  return hash.finish();
}

std::string identity(const records::MeshDefinition& definition, const std::string& owner) {
  const std::string own = identity(definition);
  return owner.empty() ? own : store::CanonicalHash().add(own).add(owner).finish();
}

}  // namespace anticrack::meshes
