// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/core.h>

#include <ostream>
#include <string>
#include <utility>

namespace anticrack::mesh {

/// A field of a geometry, and what messages call it: "inclusions[0].line.arc.from" is shown as
/// inclusion "stiffener": from, by the name and the key of the case.
struct Field {
  std::string path;
  std::string shown;
  bool of_part = false;  ///< `shown` ends with the part, no key below it

  /// One that has no name but its path.
  Field(const char* plain) : Field(std::string(plain)) {}
  Field(std::string plain) : path(std::move(plain)), shown(path) {}
  /// Entry i of the list of a kind of parts: "inclusion" is in inclusions.
  Field(const std::string& kind, std::size_t i, const std::string& name)
      : path(fmt::format("{}s[{}]", kind, i)),
        shown(kind + (name.empty() ? fmt::format(" {}", i + 1) : " \"" + name + "\"")),
        of_part(true) {}

  /// `below`: ".arc.from"; `key`: of the case, empty where the case has none.
  Field at(const std::string& below, const std::string& key) const {
    Field field = *this;
    field.path += below;
    if (key.empty()) return field;
    field.shown += (of_part ? ": " : key.front() == '[' ? "" : ".") + key;
    field.of_part = false;
    return field;
  }
  /// The same of one that the case calls as the API does.
  Field operator+(const std::string& below) const {
    return at(below, below.starts_with('.') ? below.substr(1) : below);
  }
  Field operator[](std::size_t i) const { return *this + fmt::format("[{}]", i); }
};

inline std::ostream& operator<<(std::ostream& out, const Field& field) {
  return out << field.shown;
}

}  // namespace anticrack::mesh
