// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtk/unstructured_grid.hpp"

#include <fmt/core.h>

#include <bit>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>

namespace anticrack::vtk {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written little-endian");

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '&' || c == '<' || c == '"' || code < 0x20)
      out += fmt::format("&#{};", code < 0x20 ? int{' '} : int{code});
    else
      out += c;
  }
  return out;
}

/// The arrays after the XML, each preceded by its length in bytes.
class Appended {
 public:
  template <class T>
  std::string element(const std::string& name, const char* type, std::span<const T> values,
                      std::size_t components = 1, const std::string& unit = {}) {
    const std::string offset = std::to_string(_bytes.size());
    const std::uint64_t length = values.size_bytes();
    append(&length, sizeof(length));
    append(values.data(), values.size_bytes());
    const std::string tag = "        <DataArray" + attribute("type", type) +
                            attribute("Name", name) +
                            attribute("NumberOfComponents", std::to_string(components)) +
                            attribute("format", "appended") + attribute("offset", offset);
    if (unit.empty()) return tag + "/>\n";
    return tag + ">\n          <InformationKey" + attribute("name", "UNITS_LABEL") +
           attribute("location", "vtkDataArray") + ">" + escaped(unit) +
           "</InformationKey>\n        </DataArray>\n";
  }

  const std::string& bytes() const noexcept { return _bytes; }

 private:
  void append(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t begin = _bytes.size();
    _bytes.resize(begin + size);
    std::memcpy(_bytes.data() + begin, data, size);
  }

  std::string _bytes;
};

void require(bool fits, const std::string& name) {
  if (!fits) throw std::invalid_argument("\"" + name + "\" does not have one value per entry");
}

std::string elements(const std::vector<Data>& arrays, std::size_t count, Appended& appended) {
  std::string text;
  for (const Data& data : arrays) {
    std::visit(
        [&]<class T>(const std::vector<T>& values) {
          require(values.size() == count, data.name);
          const char* type = std::is_same_v<T, double> ? "Float64" : "Int32";
          text += appended.element<T>(data.name, type, values, 1, data.unit);
        },
        data.values);
  }
  return text;
}

std::string points_of(const UnstructuredGrid& grid, Appended& appended) {
  std::vector<double> xyz;
  xyz.reserve(grid.xy.size() / 2 * 3);
  for (std::size_t i = 0; i + 1 < grid.xy.size(); i += 2)
    xyz.insert(xyz.end(), {grid.xy[i], grid.xy[i + 1], 0.0});
  return appended.element<double>("Points", "Float64", xyz, 3);
}

std::string cells_of(const UnstructuredGrid& grid, std::size_t corners, Appended& appended) {
  const std::size_t count = grid.corners.size() / corners;
  std::vector<std::int64_t> connectivity(grid.corners.begin(), grid.corners.end());
  std::vector<std::int64_t> offsets;
  offsets.reserve(count);
  for (std::size_t c = 1; c <= count; ++c)
    offsets.push_back(static_cast<std::int64_t>(c * corners));
  const std::vector<std::uint8_t> types(count, static_cast<std::uint8_t>(grid.shape));
  return appended.element<std::int64_t>("connectivity", "Int64", connectivity) +
         appended.element<std::int64_t>("offsets", "Int64", offsets) +
         appended.element<std::uint8_t>("types", "UInt8", types);
}

std::string section(const char* name, const std::string& content) {
  return std::string("      <") + name + ">\n" + content + "      </" + name + ">\n";
}

const char* const file_head = "<?xml version=\"1.0\"?>\n";

std::string file_tag(const char* type) {
  return std::string("<VTKFile") + attribute("type", type) + attribute("version", "1.0") +
         attribute("byte_order", "LittleEndian") + attribute("header_type", "UInt64") + ">\n";
}

}  // namespace

std::string to_vtu(const UnstructuredGrid& grid) {
  const std::size_t corners = grid.shape == Cell::line ? 2 : 3;
  require(grid.xy.size() % 2 == 0, "Points");
  require(grid.corners.size() % corners == 0, "connectivity");
  const std::size_t points = grid.xy.size() / 2;
  const std::size_t cells = grid.corners.size() / corners;
  Appended appended;
  std::string pieces;
  pieces += section("PointData", elements(grid.points, points, appended));
  pieces += section("CellData", elements(grid.cells, cells, appended));
  pieces += section("Points", points_of(grid, appended));
  pieces += section("Cells", cells_of(grid, corners, appended));
  return file_head + file_tag("UnstructuredGrid") + "  <UnstructuredGrid>\n    <Piece" +
         attribute("NumberOfPoints", std::to_string(points)) +
         attribute("NumberOfCells", std::to_string(cells)) + ">\n" + pieces +
         "    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_" +
         appended.bytes() + "\n  </AppendedData>\n</VTKFile>\n";
}

std::string to_pvd(const std::vector<Member>& members) {
  std::string text = file_head + file_tag("Collection") + "  <Collection>\n";
  for (const Member& member : members) {
    text += "    <DataSet" + attribute("timestep", std::to_string(member.step)) +
            attribute("part", std::to_string(member.part)) +
            attribute("name", escaped(member.name)) + attribute("file", escaped(member.file)) +
            "/>\n";
  }
  return text + "  </Collection>\n</VTKFile>\n";
}

}  // namespace anticrack::vtk
