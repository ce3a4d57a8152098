// SPDX-License-Identifier: GPL-3.0-or-later
//
// Geometries that are refused: the paper's, spoiled.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "mesh/geometry.hpp"
#include "support/errors.hpp"
#include "support/paper_geometry.hpp"

namespace anticrack::testing {

inline constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinite = std::numeric_limits<double>::infinity();

struct Fault {
  const char* name;
  std::function<void(mesh::Geometry&)> make;
  std::string field;
  std::vector<std::string> message;
  errors::Reason reason = errors::Reason::geometry_invalid;
};

inline void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

inline void expect_refused(const Fault& fault) {
  mesh::Geometry geometry = paper_geometry();
  fault.make(geometry);
  const auto error = error_of([&] { mesh::plan(geometry, {}, 1'000'000); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), fault.reason) << error->what();
  ASSERT_EQ(error->fields().size(), 1U);
  EXPECT_EQ(error->fields()[0].field, fault.field) << error->what();
  for (const std::string& part : fault.message) {
    EXPECT_THAT(error->what(), ::testing::HasSubstr(part));
  }
}

inline mesh::CrackSpec crack(const char* name, double from, double to) {
  return {name, {{from, 0}, {to, 0}}};
}

inline void add(mesh::Geometry& g, const char* name, std::vector<mesh::Point> points,
                bool closed = false) {
  g.interfaces.push_back({name, mesh::Shape::polyline, std::move(points), closed});
}

inline void curve(mesh::Geometry& g, mesh::Shape shape, std::vector<mesh::Point> points) {
  g.interfaces.push_back({"curve", shape, std::move(points), false});
}

}  // namespace anticrack::testing
