// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_entities.hpp"

#include <array>
#include <limits>

namespace anticrack::mesher {
namespace {

/// Limits the copies of a line, as there is one for each group.
constexpr std::size_t max_groups = 64;

constexpr int dimensions = 4;

/// Calls read(dimension) for each entity.
template <class Read>
void each_entity(MshScanner& in, const Read& read) {
  std::array<std::size_t, dimensions> counts{};
  for (std::size_t& count : counts) count = in.number<std::size_t>();
  for (int dimension = 0; dimension < dimensions; ++dimension) {
    const std::size_t count = counts[static_cast<std::size_t>(dimension)];
    in.require_room(count, text_bytes(2));
    for (std::size_t i = 0; i < count; ++i) read(dimension);
  }
}

}  // namespace

int MshEntities::read_group(MshScanner& in) {
  const int group = in.number<int>();
  // its negative, which is the same group backwards, must be a number too
  if (group == std::numeric_limits<int>::min()) in.fail("a physical group out of range");
  return group;
}

std::vector<int> MshEntities::read_groups(MshScanner& in) {
  const auto count = in.number<std::size_t>();
  if (count > max_groups)
    in.fail("an entity in {} physical groups; at most {} are read", count, max_groups);
  std::vector<int> groups(count);
  for (int& group : groups) group = read_group(in);
  return groups;
}

void MshEntities::read_box_and_groups(MshScanner& in, int dimension, std::vector<int>& groups) {
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) in.number<double>();
  groups = read_groups(in);
  if (dimension == 0) return;
  const auto bounding = in.number<std::size_t>();
  in.require_room(bounding, text_bytes(1));
  for (std::size_t i = 0; i < bounding; ++i) in.number<int>();
}

void MshEntities::read(MshScanner& in) {
  each_entity(in, [&](int dimension) {
    const int tag = in.number<int>();
    read_box_and_groups(in, dimension, _groups[{dimension, tag}]);
    _any = true;
  });
}

void MshEntities::read_partitioned(MshScanner& in) {
  _parts = in.number<std::size_t>();
  const auto ghosts = in.number<std::size_t>();
  in.require_room(ghosts, text_bytes(2));
  for (std::size_t i = 0; i < 2 * ghosts; ++i) in.number<int>();
  each_entity(in, [&](int dimension) {
    const int tag = in.number<int>();
    Part& part = _part[{dimension, tag}];
    part.whole.first = in.number<int>();
    part.whole.second = in.number<int>();
    const auto count = in.number<std::size_t>();
    in.require_room(count, text_bytes(1));
    for (std::size_t i = 0; i < count; ++i) {
      const int number = in.number<int>();
      if (dimension == 2) _parts_here.insert(number);
    }
    read_box_and_groups(in, dimension, part.groups);
    _any = true;
  });
}

EntityGroups MshEntities::of(int dimension, int tag) const {
  const std::vector<int>* groups = nullptr;
  const auto whole = [&](const Key& key) {
    const auto found = _groups.find(key);
    if (found != _groups.end()) groups = &found->second;
  };
  EntityGroups result;
  result.entity = tag;
  if (const auto part = _part.find({dimension, tag}); part != _part.end()) {
    const Key& key = part->second.whole;
    // a parent of -1 means that there is none
    const bool has_whole = key.first >= 0 && key.second > 0;
    result.between_parts = has_whole && key.first != dimension;
    if (has_whole && !result.between_parts) {
      result.entity = key.second;
      whole(key);
    }
    if (groups == nullptr) groups = &part->second.groups;
  } else {
    whole({dimension, tag});
  }
  if (groups != nullptr) result.groups = *groups;
  if (result.groups.empty()) result.groups = {0};
  return result;
}

}  // namespace anticrack::mesher
