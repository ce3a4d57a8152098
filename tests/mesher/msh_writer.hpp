// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small meshes as .msh files in the four formats that are read.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace anticrack::testing {

struct MshLine {
  std::array<int, 2> nodes{};
  int group = 0;
  int entity = 0;
};

struct MshTriangle {
  std::array<int, 3> nodes{};
  int group = 0;
  int entity = 0;
};

struct MshName {
  int dimension = 0;
  int tag = 0;
  std::string name;
};

/// Elements of one entity have the same group and stand next to one another.
struct MshSample {
  std::vector<int> tags;
  std::vector<std::array<double, 3>> points;
  std::vector<MshLine> lines;
  std::vector<MshTriangle> triangles;
  std::vector<MshName> names;

  int& node(double x, double y);  ///< the tag of the node at a point
};

enum class MshFormat { ascii22, binary22, ascii41, binary41 };

inline constexpr MshFormat all_formats[] = {MshFormat::ascii22, MshFormat::binary22,
                                            MshFormat::ascii41, MshFormat::binary41};

std::string write_msh(const MshSample& sample, MshFormat format);

/// (-1,1)^2 in squares of side 0.5 halved, cut by y = 0: surfaces 1 "minus" below and 2 "plus"
/// above, curve 3 "dirichlet" all around, curve 4 on (-0.5,0.5) with the name given (none if
/// empty: then it has no line). 25 nodes numbered 10, 20, ...; 32 triangles.
MshSample square_sample(const std::string& middle = "delaminated:stiffener");

void save(const std::string& path, const std::string& bytes);

}  // namespace anticrack::testing
