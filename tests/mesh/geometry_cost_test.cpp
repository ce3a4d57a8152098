// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a refusal costs, against the cost of as many lines that lie apart.
#include <gtest/gtest.h>
#include <time.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

#include "errors/errors.hpp"
#include "mesh/geometry.hpp"

namespace anticrack::mesh {
namespace {

constexpr int many = 1'000;

/// Of this process.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

OutlineSpec circle(double x, double y, double radius) { return {Shape::circle, {{x, y}}, radius}; }

OutlineSpec polygon(double x, double y, double radius, Shape shape) {
  OutlineSpec outline;
  outline.shape = shape;
  constexpr int corners = 20;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners;
    outline.points.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return outline;
}

/// A square with a region for each of `many` outlines.
Geometry square(const std::function<OutlineSpec(int)>& outline) {
  Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i < many; ++i) {
    RegionSpec region;
    region.name = "r" + std::to_string(i);
    region.outline = outline(i);
    geometry.regions.push_back(std::move(region));
  }
  return geometry;
}

double cost_of(const Geometry& geometry) {
  const double before = processor_seconds();
  try {
    plan(geometry, {}, 4'000'000);
  } catch (const errors::Error&) {  // of most
  }
  return processor_seconds() - before;
}

/// The centres of a grid.
double x_of(int i) { return -0.97 + i % 32 * 0.06; }
double y_of(int i) { return -0.97 + i / 32 * 0.06; }

TEST(CostOfARefusal, OfCirclesIsThatOfCirclesApart) {
  const double apart = cost_of(square([](int i) { return circle(x_of(i), y_of(i), 0.02); }));
  const std::function<OutlineSpec(int)> heaps[] = {
      [](int) { return circle(0, 0, 0.5); },
      [](int i) { return circle(3e-8 * i, 0, 0.5); },
      [](int i) { return circle(0, 0, 0.9 * (i + 1) / many); },
      [](int i) { return circle(0.4 * x_of(i), 0.4 * y_of(i), 0.5); },
      [](int i) { return circle(0, 0.1 + 0.3 * i / many, 0.1 + 0.3 * i / many); },
  };
  for (const auto& heap : heaps) EXPECT_LT(cost_of(square(heap)), 10 * apart);
}

TEST(CostOfARefusal, OfPolygonsIsThatOfPolygonsApart) {
  const auto straight = [](double x, double y, double r) {
    return polygon(x, y, r, Shape::polyline);
  };
  const double apart = cost_of(square([&](int i) { return straight(x_of(i), y_of(i), 0.02); }));
  const std::function<OutlineSpec(int)> heaps[] = {
      [&](int) { return straight(0, 0, 0.5); },
      [&](int i) { return straight(0, 0, 0.9 * (i + 1) / many); },
      [&](int i) { return straight(0.4 * x_of(i), 0.4 * y_of(i), 0.5); },
  };
  for (const auto& heap : heaps) EXPECT_LT(cost_of(square(heap)), 10 * apart);
}

/// A line of many long strokes side by side, at an angle.
Geometry strokes(double degrees, int count) {
  Geometry geometry;
  geometry.boundary = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const double angle = degrees * std::numbers::pi / 180;
  InterfaceSpec line;
  line.name = "line";
  for (int i = 0; i < count; ++i) {
    const double along = i % 2 == 0 ? -0.6 : 0.6;
    const double across = -0.3 + 0.6 * i / count;
    line.points.push_back({along * std::cos(angle) - across * std::sin(angle),
                           along * std::sin(angle) + across * std::cos(angle)});
  }
  geometry.interfaces.push_back(std::move(line));
  return geometry;
}

TEST(CostOfARefusal, OfStrokesSideBySideDoesNotDependOnTheirDirection) {
  constexpr int count = 10'000;
  const double upright = cost_of(strokes(90, count));
  for (const double degrees : {0.0, 20.0, 45.0, 67.5, 130.0})
    EXPECT_LT(cost_of(strokes(degrees, count)), 20 * upright) << degrees;
}

}  // namespace
}  // namespace anticrack::mesh
