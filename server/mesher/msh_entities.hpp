// SPDX-License-Identifier: GPL-3.0-or-later
//
// The geometry of an MSH 4.1 file: in which physical groups its entities are.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {

/// What the elements of an entity belong to.
struct EntityGroups {
  int entity = 0;           ///< elementary tag; of a part, that of the whole
  std::vector<int> groups;  ///< physical tags, at least one; {0}: none
  /// Made by gmsh where two parts of a partitioned mesh meet: no line of the user's.
  bool between_parts = false;
};

class MshEntities {
 public:
  /// Reads the inside of $Entities.
  void read(MshScanner& in);
  /// Reads the inside of $PartitionedEntities, which replace those of $Entities in a mesh that gmsh
  /// has partitioned, and belong to them.
  void read_partitioned(MshScanner& in);

  /// Of the elements of this dimension in this entity. A part is in the groups of the whole.
  EntityGroups of(int dimension, int tag) const;
  /// Whether a section had any entity.
  bool any() const noexcept { return _any; }
  /// How many parts the mesh was divided into; 0: it was not.
  std::size_t parts() const noexcept { return _parts; }
  /// Of these, those with a surface in this file.
  std::size_t parts_here() const noexcept { return _parts_here.size(); }

  /// A group as in files: negative where it takes the entity backwards.
  static int read_group(MshScanner& in);

 private:
  using Key = std::pair<int, int>;  ///< dimension, tag
  struct Part {
    Key whole;
    std::vector<int> groups;
  };

  static std::vector<int> read_groups(MshScanner& in);
  static void read_box_and_groups(MshScanner& in, int dimension, std::vector<int>& groups);

  std::map<Key, std::vector<int>> _groups;
  std::map<Key, Part> _part;
  std::set<int> _parts_here;
  std::size_t _parts = 0;
  bool _any = false;
};

}  // namespace anticrack::mesher
