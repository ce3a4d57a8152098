// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/identity.hpp"

#include <cstdint>
#include <variant>

#include "store/canonical.hpp"

namespace anticrack::meshes {

namespace {

using store::CanonicalHash;

void add(CanonicalHash& hash, const mesh::Point& point) {
  hash.add(point[0]).add(point[1]);
}

void add(CanonicalHash& hash, const std::vector<mesh::Point>& points) {
  hash.add(std::uint64_t{points.size()});
  for (const mesh::Point& point : points) {
    add(hash, point);
  }
}

void add(CanonicalHash& hash, const mesh::Part& part) {
  add(hash, part.from);
  add(hash, part.to);
}

void add(CanonicalHash& hash, const mesh::Geometry& geometry) {
  add(hash, geometry.boundary);
  add(hash, geometry.interface);
  hash.add(std::uint64_t{geometry.inclusions.size()});
  for (const mesh::InclusionSpec& inclusion : geometry.inclusions) {
    hash.add(inclusion.name);
    add(hash, inclusion.part);
    hash.add(std::uint64_t{inclusion.delaminated.size()});
    for (const mesh::Part& part : inclusion.delaminated) {
      add(hash, part);
    }
  }
  hash.add(std::uint64_t{geometry.cracks.size()});
  for (const mesh::CrackSpec& crack : geometry.cracks) {
    hash.add(crack.name);
    add(hash, crack.part);
  }
}

}  // namespace

std::string identity(const store::MeshDefinition& definition) {
  CanonicalHash hash;
  if (const auto* upload = std::get_if<store::UploadRef>(&definition)) {
    return hash.add(std::string("upload")).add(upload->sha256).finish();
  }
  const auto& source = std::get<store::GeometrySource>(definition);
  const bool uniform = source.options.preset == mesh::Preset::uniform;
  hash.add(std::string(uniform ? "uniform" : "paper")).add(uniform ? source.options.size : 0.0);
  add(hash, source.geometry);
  return hash.finish();
}

}  // namespace anticrack::meshes
