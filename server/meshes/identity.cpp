// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/identity.hpp"

#include <cstdint>
#include <map>
#include <variant>
#include <vector>

#include "store/canonical.hpp"

namespace anticrack::meshes {

namespace {

using store::CanonicalHash;

template <class Enum>
void add_choice(CanonicalHash& hash, Enum value) {
  hash.add(static_cast<std::uint64_t>(value));
}

void add(CanonicalHash& hash, const mesh::Point& point) {
  hash.add(point[0]).add(point[1]);
}

void add(CanonicalHash& hash, const mesh::Part& part) {
  add(hash, part.from);
  add(hash, part.to);
}

template <class Item>
void add(CanonicalHash& hash, const std::vector<Item>& items);

void add(CanonicalHash& hash, const std::map<std::int32_t, std::string>& names) {
  hash.add(std::uint64_t{names.size()});
  for (const auto& [tag, name] : names) {
    hash.add(static_cast<std::uint64_t>(tag)).add(name);
  }
}

void add(CanonicalHash& hash, const std::map<std::string, double>& values) {
  hash.add(std::uint64_t{values.size()});
  for (const auto& [name, value] : values) {
    hash.add(name).add(value);
  }
}

void add(CanonicalHash& hash, const mesh::InterfaceSpec& interface) {
  hash.add(interface.name);
  add_choice(hash, interface.shape);
  add(hash, interface.points);
  add_choice(hash, interface.closed);
}

void add(CanonicalHash& hash, const mesh::InclusionSpec& inclusion) {
  hash.add(inclusion.name);
  add(hash, inclusion.part);
  add(hash, inclusion.delaminated);
}

void add(CanonicalHash& hash, const mesh::CrackSpec& crack) {
  hash.add(crack.name);
  add(hash, crack.part);
}

void add(CanonicalHash& hash, const mesh::RegionSpec& region) {
  hash.add(region.name);
  add(hash, region.at);
  hash.add(region.tension);
}

/// The length first, so that no item can move to the next list unseen.
template <class Item>
void add(CanonicalHash& hash, const std::vector<Item>& items) {
  hash.add(std::uint64_t{items.size()});
  for (const Item& item : items) {
    add(hash, item);
  }
}

void add(CanonicalHash& hash, const mesh::Geometry& geometry) {
  add(hash, geometry.boundary);
  add(hash, geometry.interfaces);
  add(hash, geometry.inclusions);
  add(hash, geometry.cracks);
  add(hash, geometry.neumann);
  add(hash, geometry.regions);
}

void add(CanonicalHash& hash, const mesh::MeshOptions& options) {
  add_choice(hash, options.preset);
  const bool graded = options.preset == mesh::Preset::graded;
  hash.add(options.preset == mesh::Preset::paper ? 0.0 : options.size);
  hash.add(graded ? options.tip_size : 0.0);
  hash.add(graded ? options.grading : 0.0);
  add(hash, options.align);
  add(hash, options.curve_groups);
  add(hash, options.surface_groups);
  add(hash, options.tension);
}

}  // namespace

std::string identity(const store::MeshDefinition& definition) {
  CanonicalHash hash;
  if (const auto* upload = std::get_if<store::UploadRef>(&definition)) {
    hash.add(std::string("upload")).add(upload->sha256);
    add(hash, upload->options);
  } else {
    const auto& source = std::get<store::GeometrySource>(definition);
    hash.add(std::string("geometry"));
    add(hash, source.geometry);
    add(hash, source.options);
  }
  return hash.finish();
}

std::string identity(const store::MeshDefinition& definition, const std::string& owner) {
  const std::string own = identity(definition);
  return owner.empty() ? own : CanonicalHash().add(own).add(owner).finish();
}

}  // namespace anticrack::meshes
