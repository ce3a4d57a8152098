// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/elimination_order.hpp"

#include "base/at.hpp"
#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr const char* listing = "listing the neighbours of unknowns";

/// The rows j+1..interior-1 of column j, as a range of positions in the arrays of the matrix.
struct Rows {
  std::int32_t begin, end;
};

Rows rows_below(const Sparse& matrix, std::int32_t interior, std::int32_t j) {
  const std::int32_t *row = matrix.innerIndexPtr(), *column = matrix.outerIndexPtr();
  std::int32_t begin = column[j], end = column[j + 1];
  while (begin < end && row[begin] <= j) ++begin;
  while (begin < end && row[end - 1] >= interior) --end;
  return {begin, end};
}

Graph graph_of(const Sparse& matrix, std::int32_t interior) {
  const std::int32_t* row = matrix.innerIndexPtr();
  Graph graph;
  graph.begin.assign(at(interior) + 1, 0);
  for (std::int32_t j = 0; j < interior; ++j) {
    stop::look_at_turn<stop::quick>(at(j), listing);
    const Rows rows = rows_below(matrix, interior, j);
    graph.begin[at(j)] += rows.end - rows.begin;
    for (std::int32_t i = rows.begin; i < rows.end; ++i) ++graph.begin[at(row[i])];
  }
  std::int32_t end = 0;
  for (std::int32_t& begin : graph.begin) {
    end += begin;
    begin = end;
  }
  graph.neighbour.resize(at(end));
  for (std::int32_t j = interior; j-- > 0;) {
    stop::look_at_turn<stop::quick>(at(j), listing);
    const Rows rows = rows_below(matrix, interior, j);
    for (std::int32_t i = rows.end; i-- > rows.begin;) {
      graph.neighbour[at(--graph.begin[at(j)])] = row[i];
      graph.neighbour[at(--graph.begin[at(row[i])])] = j;
    }
  }
  return graph;
}

}  // namespace

std::vector<std::int32_t> elimination_order(const Sparse& stiffness, Eigen::Index interior,
                                            std::span<const double> xy, int threads) {
  return nested_dissection(graph_of(stiffness, static_cast<std::int32_t>(interior)), xy, threads);
}

}  // namespace anticrack::ddm
