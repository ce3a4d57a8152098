// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>

#include "errors/errors.hpp"
#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

constexpr int line_type = 1;
constexpr int triangle_type = 2;
constexpr int point_type = 15;

/// Bounds the copies of a line, one for each group it is in.
constexpr std::size_t max_groups = 64;

/// Least bytes of an entry written as text: digits and a separator each.
constexpr std::size_t text_bytes(std::size_t numbers) {
  return 2 * numbers;
}

std::string refused_element(int type) {
  const std::string volumes = "; a plane mesh has no volumes, so mesh in two dimensions (gmsh -2)";
  const std::string first_order = "; save first-order elements (gmsh -order 1)";
  const std::string triangles = "; make triangles only (no Recombine)";
  switch (type) {
    case 3:
      return "4-node quadrangles" + triangles;
    case 4:
      return "tetrahedra" + volumes;
    case 5:
      return "hexahedra" + volumes;
    case 6:
      return "prisms" + volumes;
    case 7:
      return "pyramids" + volumes;
    case 8:
      return "3-node lines" + first_order;
    case 9:
      return "6-node triangles" + first_order;
    case 10:
      return "9-node quadrangles" + triangles;
    case 16:
      return "8-node quadrangles" + triangles;
    default:
      return "elements of type " + std::to_string(type) +
             "; only 3-node triangles (type 2) and 2-node lines (type 1) are read, so save first "
             "order and two dimensions";
  }
}

class Reader {
 public:
  Reader(std::string_view bytes, std::size_t max_triangles)
      : _in(bytes), _max_triangles(max_triangles) {}

  MshFile read() {
    read_format();
    while (!_in.at_end()) read_section();
    _in.enter("");
    for (const char* wanted : {"$Nodes", "$Elements"}) {
      if (!_seen.contains(wanted)) {
        _in.fail(std::string("there is no ") + wanted +
                 " section; the file is truncated, save it again");
      }
    }
    return std::move(_file);
  }

 private:
  void read_format() {
    _in.enter("$MeshFormat");
    _in.expect("$MeshFormat");
    const std::string version(_in.word());
    if (version != "2.2" && version != "4.1") {
      _in.fail("format " + printable(version) +
               " is not read; save the mesh as MSH 4.1 or 2.2 (gmsh -format msh41)");
    }
    _version4 = version == "4.1";
    const int type = _in.text_number<int>();
    const int size = _in.text_number<int>();
    if (type != 0 && type != 1) {
      _in.fail("file type " + std::to_string(type) + "; it is 0 (ascii) or 1 (binary)");
    }
    if (size != 8) {
      _in.fail("numbers of " + std::to_string(size) + " bytes; only 8 are read");
    }
    if (type == 1) {
      _in.rest_of_line();
      if (_in.raw<std::int32_t>() != 1) {
        _in.fail("the binary numbers are not little-endian; save the mesh as ascii");
      }
    }
    _in.expect("$EndMeshFormat");
    _in.set_binary(type == 1);
  }

  void read_section() {
    const std::string name(_in.word());
    _in.enter(printable(name));
    if (name.size() < 2 || name.front() != '$') {
      _in.fail("expected a section, found \"" + printable(name) + "\"");
    }
    const std::string end = "$End" + name.substr(1);
    const bool known =
        name == "$PhysicalNames" || name == "$Entities" || name == "$Nodes" || name == "$Elements";
    if (!known) {
      if (!_in.skip_past(end)) {
        _in.fail("there is no " + printable(end) + "; the file is truncated, save it again");
      }
      return;
    }
    if (!_seen.insert(name).second) _in.fail("the section is there twice");
    // what is binary begins right behind the line's end
    if (_in.binary()) _in.rest_of_line();
    if (name == "$PhysicalNames") read_names();
    if (name == "$Entities") read_entities();
    if (name == "$Nodes") _version4 ? read_nodes_41() : read_nodes_22();
    if (name == "$Elements") read_elements();
    _in.expect(end);
  }

  void read_names() {
    const auto count = _in.text_number<std::size_t>();
    _in.require_room(count, text_bytes(3));
    for (std::size_t i = 0; i < count; ++i) {
      const int dimension = _in.text_number<int>();
      const int tag = _in.text_number<int>();
      const std::string_view line = _in.rest_of_line();
      const std::size_t open = line.find('"');
      const std::size_t close = line.rfind('"');
      if (open == std::string_view::npos || open == close) {
        _in.fail("expected a name in quotation marks, found \"" + printable(line) + "\"");
      }
      if (dimension != 1 && dimension != 2) continue;
      add_name(dimension, tag, std::string(line.substr(open + 1, close - open - 1)));
    }
  }

  void add_name(int dimension, int tag, const std::string& name) {
    auto& names = dimension == 1 ? _file.curve_names : _file.surface_names;
    const char* what = dimension == 1 ? "curves" : "surfaces";
    const auto [known, fresh] = _tag_of.emplace(std::pair(dimension, name), tag);
    if (!name.empty() && !fresh) {
      _in.fail("physical " + std::string(what) + " " + std::to_string(known->second) + " and " +
               std::to_string(tag) + " are both named \"" + printable(name) +
               "\"; give each its own name, or make them one group");
    }
    if (!names.emplace(tag, name).second) {
      _in.fail("physical " + std::string(what) + " " + std::to_string(tag) + " has two names");
    }
  }

  /// Format 4.1 tells the groups of curves and surfaces here.
  void read_entities() {
    if (!_version4) _in.fail("format 2.2 has no such section");
    std::array<std::size_t, 4> counts{};
    for (std::size_t& count : counts) count = _in.number<std::size_t>();
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      _in.require_room(counts[dimension], text_bytes(2));
      for (std::size_t i = 0; i < counts[dimension]; ++i) read_entity(dimension);
    }
  }

  void read_entity(std::size_t dimension) {
    const int tag = _in.number<int>();
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) _in.number<double>();
    const auto groups = _in.number<std::size_t>();
    if (groups > max_groups) {
      _in.fail("an entity in " + std::to_string(groups) + " physical groups; at most " +
               std::to_string(max_groups) + " are read");
    }
    std::vector<int> physical;
    for (std::size_t i = 0; i < groups; ++i) physical.push_back(read_group());
    if (dimension > 0) {
      const auto bounding = _in.number<std::size_t>();
      _in.require_room(bounding, text_bytes(1));
      for (std::size_t i = 0; i < bounding; ++i) _in.number<int>();
    }
    if (dimension == 1 || dimension == 2) _groups[{dimension, tag}] = std::move(physical);
  }

  int read_group() {
    const int group = _in.number<int>();
    // its opposite, the same group backwards, must be a number too
    if (group == std::numeric_limits<int>::min()) _in.fail("a physical group out of range");
    return group;
  }

  void read_nodes_22() {
    const auto count = _in.text_number<std::size_t>();
    if (_in.binary()) _in.rest_of_line();
    _in.require_room(count, _in.binary() ? 28 : text_bytes(4));
    for (std::size_t i = 0; i < count; ++i) {
      const int tag = _in.number<int>();
      if (tag < 0) _in.fail("node " + std::to_string(tag) + "; node numbers are positive");
      _file.node_tags.push_back(static_cast<std::uint64_t>(tag));
      read_coordinates();
    }
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
      for (std::size_t i = 0; i < nodes; ++i) {
        _file.node_tags.push_back(_in.number<std::uint64_t>());
      }
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
        _in.fail(std::string(axis) + " of node " +
                 std::to_string(_file.node_tags[_file.xyz.size() / 3]) + " is not a finite number");
      }
      _file.xyz.push_back(value);
    }
  }

  void read_elements() {
    if (_version4) {
      read_elements_41();
    } else if (_in.binary()) {
      read_elements_22_binary();
    } else {
      read_elements_22_ascii();
    }
  }

  void read_elements_22_ascii() {
    const auto count = _in.text_number<std::size_t>();
    _in.require_room(count, text_bytes(4));
    for (std::size_t i = 0; i < count; ++i) {
      const auto tag = _in.number<std::uint64_t>();
      const int type = _in.number<int>();
      const int tags = _in.number<int>();
      read_element_22(tag, type, tags);
    }
  }

  void read_elements_22_binary() {
    const auto count = _in.text_number<std::size_t>();
    _in.rest_of_line();
    _in.require_room(count, 8);
    for (std::size_t read = 0; read < count;) {
      const int type = _in.raw<std::int32_t>();
      const int follow = _in.raw<std::int32_t>();
      const int tags = _in.raw<std::int32_t>();
      if (follow < 1 || static_cast<std::size_t>(follow) > count - read) {
        _in.fail("a block of " + std::to_string(follow) + " elements where " +
                 std::to_string(count - read) + " are left; the file is damaged");
      }
      for (int i = 0; i < follow; ++i, ++read) {
        read_element_22(static_cast<std::uint64_t>(_in.raw<std::int32_t>()), type, tags);
      }
    }
  }

  /// The first tag is the physical group, the second the elementary entity.
  void read_element_22(std::uint64_t tag, int type, int tags) {
    if (tags < 0 || tags > 1000) _in.fail("an element with " + std::to_string(tags) + " tags");
    int group = 0;
    int entity = 0;
    for (int i = 0; i < tags; ++i) {
      if (i == 0) {
        group = read_group();
      } else if (i == 1) {
        entity = _in.number<int>();
      } else {
        _in.number<int>();
      }
    }
    const auto node = [this] {
      const int number = _in.number<int>();
      if (number < 0) _in.fail("node " + std::to_string(number) + "; node numbers are positive");
      return static_cast<std::uint64_t>(number);
    };
    take(tag, type, entity, {group}, node);
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
      const auto key = std::pair(static_cast<std::size_t>(std::max(dimension, 0)), entity);
      const auto known = _groups.find(key);
      const std::vector<int> none{0};
      const std::vector<int>& groups =
          known == _groups.end() || known->second.empty() ? none : known->second;
      for (std::size_t i = 0; i < elements; ++i, ++read) {
        const auto tag = _in.number<std::uint64_t>();
        take(tag, type, entity, groups, [this] { return _in.number<std::uint64_t>(); });
      }
    }
    check_count(count, read, "elements");
  }

  template <class ReadNode>
  void take(std::uint64_t tag, int type, int entity, const std::vector<int>& groups,
            ReadNode node) {
    if (type == point_type) {
      node();
    } else if (type == line_type) {
      const std::uint64_t a = node();
      const std::uint64_t b = node();
      for (const int group : groups) {
        // a negative group takes the curve backwards
        const bool backwards = group < 0;
        _file.lines.push_back(
            {tag, {backwards ? b : a, backwards ? a : b}, backwards ? -group : group, entity});
      }
    } else if (type == triangle_type) {
      const std::uint64_t a = node();
      const std::uint64_t b = node();
      const std::uint64_t c = node();
      if (groups.size() > 1) {
        _in.fail("surface " + std::to_string(entity) + " is in " + std::to_string(groups.size()) +
                 " physical groups; a surface belongs to one subdomain");
      }
      _file.triangles.push_back({tag, {a, b, c}, std::abs(groups[0]), entity});
      check_triangles();
    } else {
      _in.fail("element " + std::to_string(tag) + ": the mesh has " + refused_element(type));
    }
  }

  void check_triangles() const {
    if (_file.triangles.size() <= _max_triangles) return;
    throw errors::Error(errors::Reason::limit_exceeded,
                        "the mesh has more than " + std::to_string(_max_triangles) +
                            " triangles, the limit of this server; make a coarser one");
  }

  void check_count(std::size_t announced, std::size_t found, const char* what) const {
    if (announced == found) return;
    _in.fail("announces " + std::to_string(announced) + " " + what + ", has " +
             std::to_string(found) + "; the file is damaged, save it again");
  }

  MshScanner _in;
  std::size_t _max_triangles;
  bool _version4 = false;
  std::set<std::string> _seen;
  std::map<std::pair<std::size_t, int>, std::vector<int>> _groups;
  std::map<std::pair<int, std::string>, int> _tag_of;  ///< a name's physical tag, by dimension
  MshFile _file;
};

}  // namespace

MshFile read_msh(std::string_view bytes, std::size_t max_triangles) {
  return Reader(bytes, max_triangles).read();
}

}  // namespace anticrack::mesher
