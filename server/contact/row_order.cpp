// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/row_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

#include "base/at.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;

constexpr std::uint32_t half = std::uint32_t{1} << 15U, side = 2 * half;

/// Turns the coordinates of a cell into its number on the curve, whose bits are dealt to the
/// coordinates in turn, the highest first.
void to_curve(std::span<std::uint32_t> x) {
  if (x.empty()) return;
  for (std::uint32_t bit = half; bit > 1; bit >>= 1U) {
    for (std::uint32_t& one : x) {
      const std::uint32_t swapped = (x[0] ^ one) & (bit - 1);
      x[0] ^= (one & bit) != 0 ? bit - 1 : swapped;
      one ^= (one & bit) != 0 ? 0 : swapped;
    }
  }
  for (std::size_t i = 1; i < x.size(); ++i) x[i] ^= x[i - 1];
  std::uint32_t flipped = 0;
  for (std::uint32_t bit = half; bit > 1; bit >>= 1U)
    if ((x.back() & bit) != 0) flipped ^= bit - 1;
  for (std::uint32_t& one : x) one ^= flipped;
}

/// Writes the face of a direction, then the place on it.
void place(const Eigen::Ref<const Eigen::VectorXd>& point, std::span<std::uint32_t> key) {
  Index largest = 0;
  const double size = point.cwiseAbs().maxCoeff(&largest);
  key[0] = static_cast<std::uint32_t>(2 * point.size());
  if (!(size > 0) || !point.allFinite()) return;
  key[0] = static_cast<std::uint32_t>(2 * largest + (point[largest] < 0 ? 1 : 0));
  std::size_t next = 1;
  for (Index i = 0; i < point.size(); ++i) {
    if (i == largest) continue;
    const double along = (point[i] / size + 1) * half;  // 0 ... side
    key[next++] = std::min(static_cast<std::uint32_t>(along), side - 1);
  }
  to_curve(key.subspan(1));
}

/// Whether a is before b: on an earlier face, or where the highest bit that differs is 0.
bool before(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  if (a[0] != b[0]) return a[0] < b[0];
  std::size_t at_bit = 0;
  int highest = 0;
  for (std::size_t i = 1; i < a.size(); ++i) {
    if (const int width = std::bit_width(a[i] ^ b[i]); width > highest) {
      highest = width;
      at_bit = i;
    }
  }
  return highest > 0 && a[at_bit] < b[at_bit];
}

}  // namespace

std::vector<std::size_t> row_order(const Eigen::MatrixXd& points) {
  const std::size_t loads = at(points.rows()), rows = at(points.cols());
  std::vector<std::size_t> order(rows);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (loads == 0) return order;
  std::vector<std::uint32_t> keys(loads * rows);
  const auto key = [&](std::size_t row) { return std::span(keys).subspan(row * loads, loads); };
  for (std::size_t row = 0; row < rows; ++row) place(points.col(static_cast<Index>(row)), key(row));
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return before(key(a), key(b)); });
  return order;
}

}  // namespace anticrack::contact
