// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_file.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "mesher/freefem_file.hpp"
#include "mesher/mesh_start.hpp"
#include "mesher/msh_entities.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

constexpr int line_type = 1;
constexpr int triangle_type = 2;
constexpr int point_type = 15;

/// The dimension of a name in format 2.0, which does not give it.
constexpr int any_dimension = -1;

std::string refused_element(int type) {
  constexpr const char* volumes =
      "; a plane mesh has no volumes, so mesh in two dimensions (gmsh -2)";
  constexpr const char* first_order = "; save first-order elements (gmsh -order 1)";
  constexpr const char* triangles = "; make triangles only (no Recombine)";
  struct Known {
    int type;
    const char* name;
    const char* cure;
  };
  for (const Known& known :
       {Known{3, "4-node quadrangles", triangles}, Known{4, "tetrahedra", volumes},
        Known{5, "hexahedra", volumes}, Known{6, "prisms", volumes}, Known{7, "pyramids", volumes},
        Known{8, "3-node lines", first_order}, Known{9, "6-node triangles", first_order},
        Known{10, "9-node quadrangles", triangles}, Known{16, "8-node quadrangles", triangles}})
    if (type == known.type) return std::string(known.name) + known.cure;
  return fmt::format(
      "elements of type {}; only 3-node triangles (type 2) and 2-node lines (type 1) are "
      "read, so save first order and two dimensions",
      type);
}

class Reader {
 public:
  Reader(std::string_view bytes, std::size_t max_triangles)
      : _in(bytes), _max_triangles(max_triangles) {}

  MshFile read() {
    read_format();
    while (!_in.at_end()) read_section();
    _in.enter("");
    check_sections();
    check_parts();
    give_names();
    return std::move(_file);
  }

 private:
  void read_format() {
    _in.skip_mark();
    std::string_view name = _in.word();
    while (name == "$Comments") {
      skip_section(name);
      name = _in.word();
    }
    _in.enter("$MeshFormat");
    if (name != "$MeshFormat") _in.fail("expected $MeshFormat, found \"{}\"", printable(name));
    const std::string version(_in.word());
    if (!std::set<std::string>{"2", "2.0", "2.1", "2.2", "4.1"}.contains(version)) {
      _in.fail(
          "format {} is not read; convert it to MSH 4.1 or 2.2: gmsh old.msh -save -format msh41 "
          "-o new.msh",
          printable(version));
    }
    _version4 = version == "4.1";
    const int type = _in.text_number<int>();
    const int size = _in.text_number<int>();
    if (type != 0 && type != 1) _in.fail("file type {}; it must be 0 (ascii) or 1 (binary)", type);
    if (size != 8) _in.fail("numbers of {} bytes; only 8 are read", size);
    if (type == 1) {
      _in.rest_of_line();
      if (_in.raw<std::int32_t>() != 1)
        _in.fail("the binary numbers are not little-endian; save the mesh as ascii");
    }
    _in.expect("$EndMeshFormat");
    _in.set_binary(type == 1);
  }

  void read_section() {
    const std::string name(_in.word());
    _in.enter(printable(name));
    if (name.size() < 2 || name.front() != '$')
      _in.fail("expected a section, found \"{}\"", printable(name));
    static const std::set<std::string> known{"$PhysicalNames",       "$Entities",
                                             "$PartitionedEntities", "$Nodes",
                                             "$ParametricNodes",     "$Elements"};
    if (!known.contains(name)) return skip_section(name);
    const bool parametric = name == "$ParametricNodes";
    if (!_seen.insert(parametric ? "$Nodes" : name).second) _in.fail("the section occurs twice");
    // binary data begin right after the line's end
    if (_in.binary()) _in.rest_of_line();
    if (name == "$PhysicalNames") read_names();
    if (name == "$Entities") read_entities(&MshEntities::read);
    if (name == "$PartitionedEntities") read_entities(&MshEntities::read_partitioned);
    if (name == "$Nodes") _version4 ? read_nodes_41() : read_nodes_22(false);
    if (parametric) read_nodes_22(true);
    if (name == "$Elements") _version4 ? read_elements_41() : read_elements_22();
    _in.expect("$End" + name.substr(1));
  }

  void skip_section(std::string_view name) {
    const std::string end = "$End" + std::string(name.substr(1));
    if (!_in.skip_past(end))
      _in.fail("there is no {}; the file is truncated, save it again", printable(end));
  }

  void check_sections() const {
    if (_entities.any() && !_seen.contains("$Nodes") && !_seen.contains("$Elements")) {
      _in.fail(
          "the file has geometry but no mesh; mesh it before saving (gmsh case.geo -2 -o "
          "case.msh)");
    }
    for (const char* wanted : {"$Nodes", "$Elements"})
      if (!_seen.contains(wanted))
        _in.fail("there is no {} section; the file is truncated, save it again", wanted);
  }

  /// gmsh can save each part of a partitioned mesh as a file of its own.
  void check_parts() const {
    const auto refuse_part = [this](const std::string& which) {
      _in.fail(
          "the file is {} of a mesh that was saved in parts; save the whole mesh in one file "
          "(Mesh.PartitionSplitMeshFiles = 0)",
          which);
    };
    if (_entities.parts() > _entities.parts_here() && !_file.triangles.empty())
      refuse_part(fmt::format("{} of {} parts", _entities.parts_here(), _entities.parts()));
    const auto here = [this](int part) { return _own_parts.contains(part); };
    if (_own_parts.size() == 1 && *_own_parts.begin() > 1)
      refuse_part(fmt::format("part {}", *_own_parts.begin()));
    if (!std::all_of(_ghost_parts.begin(), _ghost_parts.end(), here))
      refuse_part(_own_parts.size() == 1 ? fmt::format("part {}", *_own_parts.begin()) : "a part");
  }

  void read_names() {
    const auto count = _in.text_number<std::size_t>();
    _in.require_room(count, text_bytes(2));
    for (std::size_t i = 0; i < count; ++i) {
      int dimension = _in.text_number<int>();
      int tag = dimension;
      if (_in.next() == '"') {
        dimension = any_dimension;
      } else {
        tag = _in.text_number<int>();
      }
      const std::string_view line = _in.rest_of_line();
      const std::size_t open = line.find('"');
      const std::size_t close = line.rfind('"');
      if (open == std::string_view::npos || open == close)
        _in.fail("expected a name in quotation marks, found \"{}\"", printable(line));
      const std::string name(line.substr(open + 1, close - open - 1));
      if (!_version4 && name.starts_with("_part{")) {
        _in.fail(
            "gmsh gave each part of the partitioned mesh groups of its own (\"{}\"); save the mesh "
            "without partitions, as MSH 4.1, or with Mesh.PartitionOldStyleMsh2 = 1",
            printable(name));
      }
      if (dimension == any_dimension) {
        _names_of_any.emplace_back(tag, name);
      } else if (dimension == 1 || dimension == 2) {
        add_name(dimension, tag, name);
      }
    }
  }

  /// Format 2.0 does not say whether a name is that of a curve or of a surface: it is given to
  /// whichever has the tag.
  void give_names() {
    const auto has = [](const auto& elements, int tag) {
      return std::any_of(elements.begin(), elements.end(),
                         [tag](const auto& element) { return element.group == tag; });
    };
    for (const auto& [tag, name] : _names_of_any) {
      if (has(_file.lines, tag)) add_name(1, tag, name);
      if (has(_file.triangles, tag)) add_name(2, tag, name);
    }
  }

  void add_name(int dimension, int tag, const std::string& name) {
    auto& names = dimension == 1 ? _file.curve_names : _file.surface_names;
    const char* what = dimension == 1 ? "curves" : "surfaces";
    const auto [known, fresh] = _tag_of.emplace(std::pair(dimension, name), tag);
    if (!name.empty() && !fresh) {
      _in.fail(
          "physical {} {} and {} are both named \"{}\"; give each its own name, or make them one "
          "group",
          what, known->second, tag, printable(name));
    }
    if (!names.emplace(tag, name).second) _in.fail("physical {} {} has two names", what, tag);
  }

  void read_entities(void (MshEntities::*section)(MshScanner&)) {
    if (!_version4) _in.fail("format 2 has no such section");
    if (_seen.contains("$Elements")) _in.fail("the section must stand before $Elements");
    (_entities.*section)(_in);
  }

  void read_nodes_22(bool parametric) {
    const auto count = _in.text_number<std::size_t>();
    if (_in.binary()) _in.rest_of_line();
    _in.require_room(count, _in.binary() ? 28 : text_bytes(4));
    for (std::size_t i = 0; i < count; ++i) {
      _file.node_tags.push_back(read_node_22());
      read_coordinates();
      if (parametric) skip_parameters();
    }
  }

  /// Reads the number of a node: 4 bytes in binary files, any length as text.
  std::uint64_t read_node_22() {
    const std::int64_t tag =
        _in.binary() ? _in.raw<std::int32_t>() : _in.text_number<std::int64_t>();
    if (tag < 0) _in.fail("node {}; node numbers are positive", tag);
    return static_cast<std::uint64_t>(tag);
  }

  /// Skips the entity of a node and the node's parameters on it.
  void skip_parameters() {
    if (!_in.binary()) {
      _in.rest_of_line();
      return;
    }
    const auto dimension = _in.raw<std::int32_t>();
    _in.raw<std::int32_t>();
    const int parameters = dimension == 1 || dimension == 2 ? dimension : 0;
    for (int i = 0; i < parameters; ++i) _in.raw<double>();
  }

  void read_nodes_41() {
    const auto blocks = _in.number<std::size_t>();
    const auto count = _in.number<std::size_t>();
    _in.number<std::size_t>();
    _in.number<std::size_t>();
    _in.require_room(blocks, text_bytes(4));
    for (std::size_t block = 0; block < blocks; ++block) {
      const int dimension = _in.number<int>();
      _in.number<int>();
      const bool parametric = _in.number<int>() != 0;
      const auto nodes = _in.number<std::size_t>();
      _in.require_room(nodes, _in.binary() ? 32 : text_bytes(4));
      for (std::size_t i = 0; i < nodes; ++i)
        _file.node_tags.push_back(_in.number<std::uint64_t>());
      for (std::size_t i = 0; i < nodes; ++i) {
        read_coordinates();
        for (int k = 0; parametric && k < dimension; ++k) _in.number<double>();
      }
    }
    check_count(count, _file.node_tags.size(), "nodes");
  }

  void read_coordinates() {
    for (const char* axis : {"x", "y", "z"}) {
      const auto value = _in.number<double>();
      if (!std::isfinite(value)) {
        _in.fail("{} of node {} is not a finite number", axis,
                 _file.node_tags[_file.xyz.size() / 3]);
      }
      _file.xyz.push_back(value);
    }
  }

  void read_elements_22() {
    const auto count = _in.text_number<std::size_t>();
    if (_in.binary()) _in.rest_of_line();
    _in.require_room(count, _in.binary() ? 8 : text_bytes(4));
    for (std::size_t read = 0; read < count;) {
      if (_in.binary()) {
        read += read_block_22(count - read);
      } else {
        const auto tag = _in.number<std::uint64_t>();
        const int type = _in.number<int>();
        read_element_22(tag, type, _in.number<int>());
        ++read;
      }
    }
  }

  /// Reads a block of binary elements, which have a common header. Returns their number.
  std::size_t read_block_22(std::size_t left) {
    const int type = _in.number<std::int32_t>();
    const int follow = _in.number<std::int32_t>();
    const int tags = _in.number<std::int32_t>();
    if (follow < 1 || static_cast<std::size_t>(follow) > left)
      _in.fail("a block of {} elements where {} are left; the file is damaged", follow, left);
    for (int i = 0; i < follow; ++i)
      read_element_22(static_cast<std::uint64_t>(_in.number<std::int32_t>()), type, tags);
    return static_cast<std::size_t>(follow);
  }

  /// The first tag is the physical group, the second the elementary entity.
  void read_element_22(std::uint64_t tag, int type, int tags) {
    if (tags < 0 || tags > 1000) _in.fail("an element with {} tags", tags);
    EntityGroups of;
    of.groups = {tags > 0 ? MshEntities::read_group(_in) : 0};
    of.entity = tags > 1 ? _in.number<int>() : 0;
    // 2.2: the number of parts that the element is in, its own part, and as negatives the parts
    // whose ghost it is; an older file has only its own part
    const int parts = tags > 3 ? _in.number<int>() : 0;
    for (int i = 3; i < tags; ++i) {
      const int part = _in.number<int>();
      if (type == triangle_type && i - 3 < parts)
        (part < 0 ? _ghost_parts : _own_parts).insert(std::abs(std::max(part, -INT_MAX)));
    }
    if (tags == 3) _in.number<int>();
    take(tag, type, of, [this] { return read_node_22(); });
  }

  void read_elements_41() {
    const auto blocks = _in.number<std::size_t>();
    const auto count = _in.number<std::size_t>();
    _in.number<std::size_t>();
    _in.number<std::size_t>();
    _in.require_room(blocks, text_bytes(4));
    std::size_t read = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
      const int dimension = _in.number<int>();
      const int entity = _in.number<int>();
      const int type = _in.number<int>();
      const auto elements = _in.number<std::size_t>();
      _in.require_room(elements, _in.binary() ? 16 : text_bytes(2));
      const EntityGroups of = _entities.of(dimension, entity);
      for (std::size_t i = 0; i < elements; ++i, ++read) {
        const auto tag = _in.number<std::uint64_t>();
        take(tag, type, of, [this] { return _in.number<std::uint64_t>(); });
      }
    }
    check_count(count, read, "elements");
  }

  template <class ReadNode>
  void take(std::uint64_t tag, int type, const EntityGroups& of, ReadNode node) {
    if (type == point_type) {
      node();
    } else if (type == line_type) {
      const std::uint64_t a = node();
      const std::uint64_t b = node();
      if (of.between_parts) return;
      for (const int group : of.groups) {
        // a negative group contains the curve backwards
        const bool backwards = group < 0;
        _file.lines.push_back(
            {tag, {backwards ? b : a, backwards ? a : b}, backwards ? -group : group, of.entity});
      }
    } else if (type == triangle_type) {
      const std::uint64_t a = node();
      const std::uint64_t b = node();
      const std::uint64_t c = node();
      if (of.groups.size() > 1) {
        _in.fail("surface {} is in {} physical groups; a surface belongs to one subdomain",
                 of.entity, of.groups.size());
      }
      _file.triangles.push_back({tag, {a, b, c}, std::abs(of.groups[0]), of.entity});
      check_triangle_limit(_file, _max_triangles);
    } else {
      _in.fail("element {}: the mesh has {}", tag, refused_element(type));
    }
  }

  void check_count(std::size_t announced, std::size_t found, const char* what) const {
    if (announced == found) return;
    _in.fail("announces {} {}, has {}; the file is damaged, save it again", announced, what, found);
  }

  MshScanner _in;
  std::size_t _max_triangles;
  bool _version4 = false;
  std::set<std::string> _seen;
  MshEntities _entities;
  std::vector<std::pair<int, std::string>> _names_of_any;
  std::set<int> _own_parts;                            ///< of triangles in format 2
  std::set<int> _ghost_parts;                          ///< parts whose ghosts they are
  std::map<std::pair<int, std::string>, int> _tag_of;  ///< a name's physical tag, by dimension
  MshFile _file;
};

}  // namespace

void check_triangle_limit(const MshFile& file, std::size_t max_triangles) {
  if (file.triangles.size() <= max_triangles) return;
  throw errors::Error(errors::Reason::limit_exceeded,
                      "the mesh has more than {} triangles, the limit of this server; "
                      "make a coarser one",
                      max_triangles);
}

MshFile read_msh(std::string_view bytes, std::size_t max_triangles) {
  return Reader(bytes, max_triangles).read();
}

MshFile read_mesh_file(std::string_view bytes, std::size_t max_triangles) {
  switch (format_of(bytes)) {
    case FileFormat::freefem:
      return read_freefem(bytes, max_triangles);
    case FileFormat::medit:
      return read_medit(bytes, max_triangles);
    case FileFormat::msh:
      break;
  }
  return read_msh(bytes, max_triangles);
}

}  // namespace anticrack::mesher
