// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>

#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

constexpr int line_type = 1;
constexpr int triangle_type = 2;
constexpr int point_type = 15;

/// Limits the copies of a line, one per group.
constexpr std::size_t max_groups = 64;

/// Least bytes of an entry as text: a digit and a separator per number.
constexpr std::size_t text_bytes(std::size_t numbers) { return 2 * numbers; }

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
    for (const char* wanted : {"$Nodes", "$Elements"})
      if (!_seen.contains(wanted))
        _in.fail("there is no {} section; the file is truncated, save it again", wanted);
    return std::move(_file);
  }

 private:
  void read_format() {
    _in.enter("$MeshFormat");
    _in.expect("$MeshFormat");
    const std::string version(_in.word());
    if (version != "2.2" && version != "4.1") {
      _in.fail("format {} is not read; save the mesh as MSH 4.1 or 2.2 (gmsh -format msh41)",
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
    const std::string end = "$End" + name.substr(1);
    const bool known =
        name == "$PhysicalNames" || name == "$Entities" || name == "$Nodes" || name == "$Elements";
    if (!known) {
      if (!_in.skip_past(end))
        _in.fail("there is no {}; the file is truncated, save it again", printable(end));
      return;
    }
    if (!_seen.insert(name).second) _in.fail("the section occurs twice");
    // binary data begin right after the line's end
    if (_in.binary()) _in.rest_of_line();
    if (name == "$PhysicalNames") read_names();
    if (name == "$Entities") read_entities();
    if (name == "$Nodes") _version4 ? read_nodes_41() : read_nodes_22();
    if (name == "$Elements") _version4 ? read_elements_41() : read_elements_22();
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
      if (open == std::string_view::npos || open == close)
        _in.fail("expected a name in quotation marks, found \"{}\"", printable(line));
      if (dimension != 1 && dimension != 2) continue;
      add_name(dimension, tag, std::string(line.substr(open + 1, close - open - 1)));
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

  /// The groups of curves and surfaces in format 4.1.
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
    if (groups > max_groups)
      _in.fail("an entity in {} physical groups; at most {} are read", groups, max_groups);
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
    // its negative, the same group backwards, must be a number too
    if (group == std::numeric_limits<int>::min()) _in.fail("a physical group out of range");
    return group;
  }

  void read_nodes_22() {
    const auto count = _in.text_number<std::size_t>();
    if (_in.binary()) _in.rest_of_line();
    _in.require_room(count, _in.binary() ? 28 : text_bytes(4));
    for (std::size_t i = 0; i < count; ++i) {
      const int tag = _in.number<int>();
      if (tag < 0) _in.fail("node {}; node numbers are positive", tag);
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

  /// Binary elements come in blocks with a common header. Returns their number.
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
    const int group = tags > 0 ? read_group() : 0;
    const int entity = tags > 1 ? _in.number<int>() : 0;
    for (int i = 2; i < tags; ++i) _in.number<int>();
    const auto node = [this] {
      const int number = _in.number<int>();
      if (number < 0) _in.fail("node {}; node numbers are positive", number);
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
      std::vector<int> groups = _groups[{static_cast<std::size_t>(std::max(dimension, 0)), entity}];
      if (groups.empty()) groups = {0};
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
        _in.fail("surface {} is in {} physical groups; a surface belongs to one subdomain", entity,
                 groups.size());
      }
      _file.triangles.push_back({tag, {a, b, c}, std::abs(groups[0]), entity});
      check_triangles();
    } else {
      _in.fail("element {}: the mesh has {}", tag, refused_element(type));
    }
  }

  void check_triangles() const {
    if (_file.triangles.size() <= _max_triangles) return;
    throw errors::Error(
        errors::Reason::limit_exceeded,
        fmt::format("the mesh has more than {} triangles, the limit of this server; "
                    "make a coarser one",
                    _max_triangles));
  }

  void check_count(std::size_t announced, std::size_t found, const char* what) const {
    if (announced == found) return;
    _in.fail("announces {} {}, has {}; the file is damaged, save it again", announced, what, found);
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
