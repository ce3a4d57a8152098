// SPDX-License-Identifier: GPL-3.0-or-later
#include "vtk/unstructured_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/vtk/read_vtu.hpp"

namespace anticrack::vtk {
namespace {

using Reals = std::vector<double>;
using Integers = std::vector<std::int32_t>;
using Longs = std::vector<std::int64_t>;
using ::testing::HasSubstr;
using ::testing::Not;

UnstructuredGrid two_triangles() {
  UnstructuredGrid grid;
  grid.xy = {0, 0, 1, 0, 1, 1, 0, 1.5};
  grid.corners = {0, 1, 2, 0, 2, 3};
  grid.points = {{"u", Reals{0.5, -1, 2, 1e-300}}, {"node", Integers{7, 8, 9, 10}}};
  grid.cells = {{"tension", Reals{1, 2}}, {"subdomain", Integers{0, 1}}};
  return grid;
}

TEST(Vtu, holds_the_grid) {
  const ReadVtu seen = read_vtu(to_vtu(two_triangles()));
  EXPECT_EQ(seen.points, 4u);
  EXPECT_EQ(seen.cells, 2u);
  EXPECT_EQ(seen.arrays.at("Points").components, 3u);
  EXPECT_EQ(seen.arrays.at("Points").as<double>(), (Reals{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1.5, 0}));
  EXPECT_EQ(seen.arrays.at("connectivity").as<std::int64_t>(), (Longs{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(seen.arrays.at("offsets").as<std::int64_t>(), (Longs{3, 6}));
  EXPECT_EQ(seen.arrays.at("types").as<std::uint8_t>(), (std::vector<std::uint8_t>{5, 5}));
  EXPECT_EQ(seen.arrays.at("u").as<double>(), (Reals{0.5, -1, 2, 1e-300}));
  EXPECT_EQ(seen.arrays.at("u").section, "PointData");
  EXPECT_EQ(seen.arrays.at("node").as<std::int32_t>(), (Integers{7, 8, 9, 10}));
  EXPECT_EQ(seen.arrays.at("tension").section, "CellData");
  EXPECT_EQ(seen.arrays.at("subdomain").as<std::int32_t>(), (Integers{0, 1}));
  EXPECT_EQ(seen.arrays.at("subdomain").type, "Int32");
}

TEST(Vtu, of_lines_and_of_nothing) {
  UnstructuredGrid grid;
  grid.shape = Cell::line;
  grid.xy = {0, 0, 1, 0};
  grid.corners = {0, 1};
  const ReadVtu lines = read_vtu(to_vtu(grid));
  EXPECT_EQ(lines.cells, 1u);
  EXPECT_EQ(lines.arrays.at("types").as<std::uint8_t>(), std::vector<std::uint8_t>{3});
  EXPECT_EQ(read_vtu(to_vtu({})).points, 0u);
}

TEST(Vtu, refuses_data_of_another_length) {
  UnstructuredGrid grid = two_triangles();
  std::get<Reals>(grid.points[0].values).pop_back();
  EXPECT_THROW(to_vtu(grid), std::invalid_argument);
  grid = two_triangles();
  grid.corners.pop_back();
  EXPECT_THROW(to_vtu(grid), std::invalid_argument);
}

TEST(Pvd, lists_its_files_whatever_they_are_called) {
  const std::string text =
      to_pvd({{"a \"quoted\" <name> & more", "a.vtu", 0, 0}, {"b", "b.vtu", 3, 1}});
  EXPECT_THAT(text, HasSubstr("timestep=\"0\" part=\"0\" name=\"a &#34;quoted&#34; &#60;name> "
                              "&#38; more\" file=\"a.vtu\"/>"));
  EXPECT_THAT(text, HasSubstr("timestep=\"3\" part=\"1\" name=\"b\" file=\"b.vtu\"/>"));
  EXPECT_THAT(text, HasSubstr("type=\"Collection\""));
  EXPECT_THAT(text, Not(HasSubstr("<name>")));
}

}  // namespace
}  // namespace anticrack::vtk
