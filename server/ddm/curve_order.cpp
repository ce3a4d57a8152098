// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/cut_steps.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "stop/stop.hpp"

namespace anticrack::ddm {
namespace {

struct Keyed {
  std::uint32_t key;
  std::int32_t node;
};

constexpr unsigned cell_bits = 16;

/// Moves bit i of a cell's coordinate to place 2i.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 8) & 0x00ff00ffU;
  bits = (bits | bits << 4) & 0x0f0f0f0fU;
  bits = (bits | bits << 2) & 0x33333333U;
  return (bits | bits << 1) & 0x55555555U;
}

struct Axis {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  std::uint32_t cell(double value) const {
    constexpr double cells = (1U << cell_bits) - 1;
    return high > low ? static_cast<std::uint32_t>((value - low) / (high - low) * cells) : 0;
  }
};

/// One pass of a radix sort: sorts by `digit_bits` bits of the key and keeps the order of equals.
constexpr unsigned digit_bits = 11;

void sort_by_digit(const std::vector<Keyed>& from, unsigned shift, std::vector<Keyed>& to) {
  constexpr std::size_t digits = std::size_t{1} << digit_bits;
  std::array<std::size_t, digits> end{};
  const auto digit = [shift](const Keyed& k) { return (k.key >> shift) & (digits - 1); };
  for (const Keyed& k : from) ++end[digit(k)];
  std::size_t begin = 0;
  for (std::size_t& e : end) {
    const std::size_t count = e;
    e = begin;
    begin += count;
  }
  for (const Keyed& k : from) to[end[digit(k)]++] = k;
}

}  // namespace

void sort_along_curve(std::vector<std::int32_t>& nodes, std::span<const double> xy) {
  std::array<Axis, 2> box;
  for (const std::int32_t node : nodes) {
    box[0].include(xy[2 * static_cast<std::size_t>(node)]);
    box[1].include(xy[2 * static_cast<std::size_t>(node) + 1]);
  }
  std::vector<Keyed> keyed, sorted(nodes.size());
  keyed.reserve(nodes.size());
  for (const std::int32_t node : nodes) {
    const std::size_t i = 2 * static_cast<std::size_t>(node);
    keyed.push_back({spread(box[0].cell(xy[i])) | spread(box[1].cell(xy[i + 1])) << 1, node});
  }
  for (unsigned shift = 0; shift < 2 * cell_bits; shift += digit_bits) {
    stop::look("sorting the nodes of a mesh");
    sort_by_digit(keyed, shift, sorted);
    keyed.swap(sorted);
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = keyed[i].node;
}

}  // namespace anticrack::ddm
