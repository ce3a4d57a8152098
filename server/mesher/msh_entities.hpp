// SPDX-License-Identifier: GPL-3.0-or-later
//
// The geometry of an MSH 4.1 file: the physical groups of its entities.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "mesher/msh_scanner.hpp"

namespace anticrack::mesher {

/// The groups to which the elements of an entity belong.
struct EntityGroups {
  int entity = 0;           ///< elementary tag; for a part, that of the whole
  std::vector<int> groups;  ///< physical tags, at least one; {0}: none
  /// Made by gmsh where two parts of a partitioned mesh meet: no line of the user's.
  bool between_parts = false;
};

class MshEntities {
 public:
  /// Reads the inside of $Entities.
  void read(MshScanner& in);
  /// Reads the inside of $PartitionedEntities. In a mesh that gmsh has partitioned, these parts
  /// replace the entities of $Entities, to which they belong.
  void read_partitioned(MshScanner& in);

  /// Groups of the elements of this dimension in this entity. A part is in the groups of the whole.
  EntityGroups of(int dimension, int tag) const;
  /// Whether a section had any entity.
  bool any() const noexcept { return _any; }
  /// Into how many parts the mesh was divided; 0 if it was not.
  std::size_t parts() const noexcept { return _parts; }
  /// How many of these parts have a surface in this file.
  std::size_t parts_here() const noexcept { return _parts_here.size(); }

  /// Reads a group; it is negative if it contains the entity backwards.
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
