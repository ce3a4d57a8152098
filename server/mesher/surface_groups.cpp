// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/import_steps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "base/union_find.hpp"
#include "mesh/names.hpp"
#include "mesher/messages.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

using mesh::Mesh;

[[noreturn]] void refuse_option(const std::string& field, const std::string& message) {
  throw errors::Error(errors::Reason::invalid_argument, message).at(field);
}

/// The surfaces of the file: physical ones if it has any, else elementary ones.
class Surfaces {
 public:
  explicit Surfaces(const MshFile& file) : _file(file) {
    _physical = std::any_of(file.triangles.begin(), file.triangles.end(),
                            [](const auto& t) { return t.group != 0; });
    for (const auto& t : file.triangles) {
      if (_physical && t.group == 0) {
        refuse(
            "triangle {} of surface {} is in no physical surface, but others are; put every "
            "surface "
            "in one",
            t.tag, t.entity);
      }
      _tags.insert(tag_of(t));
    }
  }

  bool physical() const { return _physical; }
  const std::set<std::int32_t>& tags() const { return _tags; }
  std::int32_t tag_of(const MshElement<3>& t) const { return _physical ? t.group : t.entity; }

  std::string name(std::int32_t tag) const {
    const auto named = _file.surface_names.find(tag);
    const bool has_name = _physical && named != _file.surface_names.end() && !named->second.empty();
    return has_name ? printable(named->second) : std::to_string(tag);
  }

 private:
  const MshFile& _file;
  bool _physical = false;
  std::set<std::int32_t> _tags;
};

void check_given(const Surfaces& surfaces, const std::map<std::int32_t, std::string>& given) {
  const char* what = surfaces.physical() ? "surface group" : "surface";
  for (const auto& [tag, name] : given) {
    const std::string field = fmt::format("options.surface_groups[{}]", tag);
    if (!surfaces.tags().contains(tag)) {
      refuse_option(field, fmt::format("the file has no {0} {1}; its {0}s are {2}", what, tag,
                                       list_of(surfaces.tags())));
    }
    if (!mesh::valid_name(name)) {
      refuse_option(field, fmt::format("{} {} is given the name \"{}\"; a subdomain's name is {}",
                                       what, tag, printable(name), mesh::name_rule));
    }
  }
}

/// Makes a subdomain of each surface; surfaces to which the request gives the same name are one
/// subdomain, and other names must differ.
void take_tags(const MshFile& file, const Surfaces& surfaces,
               const std::map<std::int32_t, std::string>& given, Mesh& mesh) {
  struct Named {
    std::int32_t index = 0;
    std::int32_t tag = 0;
    bool given = false;
  };
  std::map<std::string, Named> by_name;
  std::map<std::int32_t, std::int32_t> index_of;
  for (const std::int32_t tag : surfaces.tags()) {
    const auto said = given.find(tag);
    const bool is_given = said != given.end();
    const std::string name = is_given ? said->second : surfaces.name(tag);
    const auto next = static_cast<std::int32_t>(mesh.subdomains.size());
    const auto [entry, added] = by_name.emplace(name, Named{next, tag, is_given});
    if (added) {
      mesh.subdomains.push_back(name);
    } else if (!is_given || !entry->second.given) {
      refuse(
          "surfaces {} and {} have the same name, \"{}\"; give each its own, or make them one "
          "physical group",
          entry->second.tag, tag, name);
    }
    index_of[tag] = entry->second.index;
  }
  for (const auto& t : file.triangles) mesh.subdomain.push_back(index_of.at(surfaces.tag_of(t)));
}

/// Makes a subdomain of every piece between the cuts, in the order of their first triangles.
void take_pieces(const mesh::EdgeTable& edges,
                 std::span<const std::pair<std::int32_t, std::int32_t>> cuts, Mesh& mesh) {
  base::UnionFind pieces(mesh.triangle_count());
  edges.each([&](std::span<const mesh::EdgeUse> uses) {
    const auto key = std::pair(uses[0].low(), uses[0].high());
    if (std::binary_search(cuts.begin(), cuts.end(), key)) return;
    for (std::size_t i = 1; i < uses.size(); ++i) pieces.unite(uses[0].triangle, uses[i].triangle);
  });
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto t = static_cast<std::int32_t>(i);
    const std::int32_t first = pieces.find(t);
    if (first == t) {
      mesh.subdomain.push_back(static_cast<std::int32_t>(mesh.subdomains.size()));
      mesh.subdomains.push_back(std::to_string(mesh.subdomains.size() + 1));
    } else {
      mesh.subdomain.push_back(mesh.subdomain[at(first)]);
    }
  }
  const std::size_t count = mesh.subdomains.size();
  mesh.warnings.push_back(
      "the file has one surface and no physical one: " +
      (count == 1 ? "it is one subdomain, \"1\""
                  : fmt::format("the {} pieces into which its lines cut it are the subdomains {}",
                                count, list_of(mesh.subdomains, "\""))));
}

/// The number of the subdomain for which a tension is given.
std::size_t subdomain_of(const std::string& name, const std::string& field, const Mesh& mesh) {
  const auto found = std::find(mesh.subdomains.begin(), mesh.subdomains.end(), name);
  if (found == mesh.subdomains.end()) {
    refuse_option(field,
                  fmt::format("tension is given for \"{}\", which is not a subdomain; they are {}",
                              printable(name), list_of(mesh.subdomains, "\"")));
  }
  return at(found - mesh.subdomains.begin());
}

void take_laws(const std::map<std::string, mesh::TensionLaw>& given, Mesh& mesh) {
  if (given.empty()) return;
  mesh.tension_laws.resize(mesh.subdomains.size());
  for (const auto& [name, law] : given) {
    const std::string field = fmt::format("options.tension_laws[{}]", printable(name));
    mesh.tension_laws[subdomain_of(name, field, mesh)] = law;
  }
}

void take_tension(const std::map<std::string, double>& given, Mesh& mesh) {
  if (given.empty()) return;
  mesh.tension.assign(mesh.subdomains.size(), 1.0);
  for (const auto& [name, value] : given) {
    const std::string field = fmt::format("options.tension[{}]", printable(name));
    const std::size_t subdomain = subdomain_of(name, field, mesh);
    if (!(value > 0) || !std::isfinite(value)) {
      refuse_option(
          field,
          fmt::format("the tension of \"{}\" is {:g}; give a finite number above 0", name, value));
    }
    mesh.tension[subdomain] = value;
  }
}

}  // namespace

void read_surfaces(const MshFile& file, const mesh::MeshOptions& options,
                   const mesh::EdgeTable& edges,
                   std::span<const std::pair<std::int32_t, std::int32_t>> cuts, Mesh& mesh) {
  const Surfaces surfaces(file);
  check_given(surfaces, options.surface_groups);
  mesh.subdomain.reserve(file.triangles.size());
  const bool single = !surfaces.physical() && surfaces.tags().size() == 1;
  if (single && options.surface_groups.empty()) {
    take_pieces(edges, cuts, mesh);
  } else {
    take_tags(file, surfaces, options.surface_groups, mesh);
    if (!surfaces.physical() && options.surface_groups.size() < surfaces.tags().size()) {
      mesh.warnings.push_back("the file has no physical surface: its surfaces are the subdomains " +
                              list_of(mesh.subdomains, "\""));
    }
  }
  take_tension(options.tension, mesh);
  take_laws(options.tension_laws, mesh);
}

}  // namespace anticrack::mesher
