// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtk/export.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "output/file.hpp"
#include "output/stems.hpp"

namespace anticrack::vtk {
namespace {

namespace fs = std::filesystem;
using results::Load;
using results::Result;

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void write(const fs::path& path, const std::string& bytes, Exported& exported) {
  output::write_file(path, bytes);
  exported.files.push_back(path);
}

bool exportable(const Result& result, const std::string& source, const Load& load,
                Exported& exported) {
  if (load.traces.empty() && load.fields.empty()) {
    exported.notes.push_back("load \"" + load.name() + "\" has no answer (" +
                             results::status_name(load.answer.status()) + "): nothing to export");
    return false;
  }
  if (load.fields.empty() && !result.sweep) {
    throw results::Error(source + ": load \"" + load.name() + "\"",
                         "the result has no fields: u is known only along the interfaces",
                         results::fields_cure(result));
  }
  return true;
}

using Corners = std::array<std::int32_t, 3>;

/// The corners of a triangle sorted, to find it from any corner and in any direction.
Corners sorted(Corners corners) {
  std::ranges::sort(corners);
  return corners;
}

/// The indicators by cell, since fields have the triangles of a subdomain in another order. NaN for
/// a triangle that is not in the mesh.
std::vector<double> indicator_by_cell(const results::Mesh& mesh, const Load& load) {
  const auto corners = [](const std::vector<std::int32_t>& all, std::size_t triangle) {
    return Corners{all[3 * triangle], all[3 * triangle + 1], all[3 * triangle + 2]};
  };
  std::vector<std::pair<Corners, double>> known;
  known.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t)
    known.emplace_back(sorted(corners(mesh.triangles, t)), load.indicator[t]);
  std::ranges::sort(known);
  std::vector<double> values;
  values.reserve(known.size());
  for (const results::Field& field : load.fields) {
    for (std::size_t t = 0; 3 * t < field.triangles.size(); ++t) {
      Corners nodes = corners(field.triangles, t);
      for (std::int32_t& node : nodes) node = field.nodes[static_cast<std::size_t>(node)];
      nodes = sorted(nodes);
      const auto found =
          std::ranges::lower_bound(known, nodes, {}, &decltype(known)::value_type::first);
      values.push_back(found != known.end() && found->first == nodes ? found->second
                                                                     : results::unknown);
    }
  }
  return values;
}

}  // namespace

UnstructuredGrid membrane(const Result& result, const Load& load) {
  UnstructuredGrid grid;
  std::vector<double> u, tension;
  std::vector<std::int32_t> node, subdomain;
  for (std::size_t d = 0; d < load.fields.size(); ++d) {
    const results::Field& field = load.fields[d];
    const auto first = static_cast<std::int32_t>(node.size());
    append(node, field.nodes);
    append(u, field.u);
    for (const std::int32_t corner : field.triangles) grid.corners.push_back(first + corner);
    const std::size_t cells = field.triangles.size() / 3;
    subdomain.insert(subdomain.end(), cells, static_cast<std::int32_t>(d));
    tension.insert(tension.end(), cells,
                   result.mesh.info.subdomains(static_cast<int>(d)).tension());
  }
  grid.xy.reserve(2 * node.size());
  for (const std::int32_t index : node) {
    const auto at = 2 * static_cast<std::size_t>(index);
    grid.xy.push_back(result.mesh.xy[at]);
    grid.xy.push_back(result.mesh.xy[at + 1]);
  }
  const auto unit = [&](const char* dimension) {
    return results::label_of(result.units, dimension);
  };
  grid.points = {{"u", std::move(u), unit("L")}, {"node", std::move(node)}};
  grid.cells = {{"tension", std::move(tension), unit("F/L")}, {"subdomain", std::move(subdomain)}};
  if (!load.indicator.empty())
    grid.cells.push_back({"error_indicator", indicator_by_cell(result.mesh, load), unit("F L")});
  return grid;
}

UnstructuredGrid interfaces(const Result& result, const Load& load) {
  UnstructuredGrid grid;
  grid.shape = Cell::line;
  std::vector<double> u_minus, u_plus, jump, pressure, s;
  std::vector<std::int32_t> kind, contact, index, inclusion;
  for (std::size_t i = 0; i < load.traces.size(); ++i) {
    const results::Interface& line = result.interfaces[i];
    const results::Trace& trace = load.traces[i];
    const auto first = static_cast<std::int32_t>(grid.xy.size() / 2);
    const auto count = static_cast<std::int32_t>(line.node_count());
    for (std::size_t k = 0; k < line.node_count(); ++k) {
      grid.xy.insert(grid.xy.end(), {line.x[k], line.y[k]});
      kind.push_back(line.kind[k]);
    }
    for (std::int32_t k = 0; k + 1 < count; ++k) {
      grid.corners.insert(grid.corners.end(), {first + k, first + k + 1});
      index.push_back(static_cast<std::int32_t>(i));
    }
    append(u_minus, trace.u_minus);
    append(u_plus, trace.u_plus);
    append(jump, trace.jump);
    append(pressure, trace.pressure);
    append(s, line.s);
    append(contact, trace.contact);
    append(inclusion, line.edge_inclusion);
  }
  const std::string length = results::label_of(result.units, "L");
  grid.points = {{"u_minus", u_minus, length},
                 {"u_plus", u_plus, length},
                 {"jump", jump, length},
                 {"pressure", pressure, results::label_of(result.units, "F/L")},
                 {"s", s, length},
                 {"kind", kind},
                 {"contact", contact}};
  grid.cells = {{"interface", index}, {"inclusion", inclusion}};
  return grid;
}

Exported export_result(const Result& result, const std::string& source, const fs::path& folder) {
  const std::string fault = results::first_fault(result);
  if (!fault.empty()) throw results::Error(source, fmt::format("is inconsistent: {}", fault), "");
  std::vector<std::string> names;
  names.reserve(result.loads.size());
  for (const Load& load : result.loads) names.push_back(load.name());
  const std::vector<std::string> stems = output::file_stems(names, {"-interfaces"});

  Exported exported;
  std::vector<std::size_t> answered;
  for (std::size_t i = 0; i < result.loads.size(); ++i)
    if (exportable(result, source, result.loads[i], exported)) answered.push_back(i);
  if (answered.empty()) {
    throw results::Error(
        source, "no load has an answer to export",
        result.sweep ? "keep the traces of some rows, with --traces" : "solve the case first");
  }
  output::make_folder(folder);
  std::vector<Member> members;
  for (const std::size_t i : answered) {
    const Load& load = result.loads[i];
    if (!load.fields.empty()) {
      const std::string file = stems[i] + ".vtu";
      write(folder / file, to_vtu(membrane(result, load)), exported);
      members.push_back({load.name(), file, i, 0});
    }
    if (!load.traces.empty()) {
      const std::string lines = stems[i] + "-interfaces.vtu";
      write(folder / lines, to_vtu(interfaces(result, load)), exported);
      members.push_back({load.name() + ", interfaces", lines, i, 1});
    }
  }
  write(folder / "result.pvd", to_pvd(members), exported);
  return exported;
}

}  // namespace anticrack::vtk
