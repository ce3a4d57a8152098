// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/freefem_file.hpp"

#include <cmath>
#include <set>
#include <string>
#include <utility>

#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {
namespace {

/// The parts that both formats have in common.
class PlaneReader {
 public:
  PlaneReader(std::string_view bytes, std::size_t max_triangles)
      : _in(bytes, "mesh file"), _max_triangles(max_triangles) {
    _in.skip_mark();
  }

 protected:
  void read_vertices(std::size_t count, std::size_t dimension) {
    _in.require_room(count, text_bytes(dimension + 1));
    for (std::size_t i = 1; i <= count; ++i) {
      _file.node_tags.push_back(i);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double value = axis < dimension ? _in.text_number<double>() : 0;
        if (!std::isfinite(value)) _in.fail("a coordinate of vertex {} is not a finite number", i);
        _file.xyz.push_back(value);
      }
      _in.text_number<int>();
    }
  }

  void read_triangles(std::size_t count) {
    _in.require_room(count, text_bytes(4));
    for (std::size_t i = 1; i <= count; ++i) {
      MshElement<3> triangle{i};
      for (auto& node : triangle.nodes) node = _in.text_number<std::uint64_t>();
      triangle.entity = read_label();
      _file.triangles.push_back(triangle);
      check_triangle_limit(_file, _max_triangles);
    }
  }

  void read_edges(std::size_t count) {
    _in.require_room(count, text_bytes(3));
    for (std::size_t i = 1; i <= count; ++i) {
      MshElement<2> line{i};
      for (auto& node : line.nodes) node = _in.text_number<std::uint64_t>();
      line.group = line.entity = read_label();
      _file.lines.push_back(line);
    }
  }

  MshScanner _in;
  MshFile _file;

 private:
  int read_label() {
    const int label = _in.text_number<int>();
    if (label < 0) _in.fail("label {}; give labels of 0 and more", label);
    return label;
  }

  std::size_t _max_triangles;
};

class FreefemReader : PlaneReader {
 public:
  using PlaneReader::PlaneReader;

  MshFile read() {
    const auto vertices = _in.text_number<std::size_t>();
    const auto triangles = _in.text_number<std::size_t>();
    const auto edges = _in.text_number<std::size_t>();
    read_vertices(vertices, 2);
    read_triangles(triangles);
    read_edges(edges);
    if (!_in.at_end()) {
      _in.fail("more follows than {} vertices, {} triangles and {} edges; save the mesh again",
               vertices, triangles, edges);
    }
    return std::move(_file);
  }
};

class MeditReader : PlaneReader {
 public:
  using PlaneReader::PlaneReader;

  MshFile read() {
    _in.expect("MeshVersionFormatted");
    _in.text_number<int>();
    skip_section();
    for (std::string key; !_in.at_end() && (key = _in.word()) != "End"; skip_section())
      read_section(key);
    return std::move(_file);
  }

 private:
  void read_section(const std::string& key) {
    _in.enter(printable(key));
    if (key == "Dimension") {
      _dimension = _in.text_number<std::size_t>();
      if (_dimension != 2 && _dimension != 3) _in.fail("{} dimensions; give 2", _dimension);
    } else if (key == "Vertices") {
      read_vertices(_in.text_number<std::size_t>(), _dimension);
    } else if (key == "Edges") {
      read_edges(_in.text_number<std::size_t>());
    } else if (key == "Triangles") {
      read_triangles(_in.text_number<std::size_t>());
    } else if (other_elements.contains(key)) {
      if (_in.text_number<std::size_t>() > 0)
        _in.fail("{} are not read; save a plane mesh of triangles", key);
    } else {
      skip_section();
    }
  }

  /// Skips what is no part of the mesh itself: numbers, a text in quotation marks, a comment.
  void skip_section() {
    const auto is_key = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    while (!_in.at_end() && !is_key(_in.next())) {
      const char first = _in.next();
      if (first == '"' || first == '#') {
        _in.rest_of_line();
      } else {
        _in.word();
      }
    }
  }

  inline static const std::set<std::string> other_elements{"Quadrilaterals", "Tetrahedra",
                                                           "Hexahedra", "Prisms", "Pyramids"};
  std::size_t _dimension = 2;
};

}  // namespace

MshFile read_freefem(std::string_view bytes, std::size_t max_triangles) {
  return FreefemReader(bytes, max_triangles).read();
}

MshFile read_medit(std::string_view bytes, std::size_t max_triangles) {
  return MeditReader(bytes, max_triangles).read();
}

}  // namespace anticrack::mesher
