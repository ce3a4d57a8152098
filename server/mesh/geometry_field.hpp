// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/core.h>

#include <ostream>
#include <string>
#include <utility>

namespace anticrack::mesh {

/// A field of a geometry, and the text that messages show for it: "inclusions[0].line.arc.from" is
/// shown as inclusion "stiffener": from, with the name and the key of the case.
struct Field {
  std::string path;
  std::string shown;
  bool of_part = false;  ///< whether `shown` ends with the part, without a key

  /// A field that is shown by its path.
  Field(const char* plain) : Field(std::string(plain)) {}
  Field(std::string plain) : path(std::move(plain)), shown(path) {}
  /// Entry i of the list of parts of a kind; an "inclusion" is in the list inclusions.
  Field(const std::string& kind, std::size_t i, const std::string& name)
      : path(fmt::format("{}s[{}]", kind, i)),
        shown(kind + (name.empty() ? fmt::format(" {}", i + 1) : " \"" + name + "\"")),
        of_part(true) {}

  /// A field below this one. `below`: ".arc.from"; `key`: that of the case, empty if it has none.
  Field at(const std::string& below, const std::string& key) const {
    Field field = *this;
    field.path += below;
    if (key.empty()) return field;
    field.shown += (of_part ? ": " : key.front() == '[' ? "" : ".") + key;
    field.of_part = false;
    return field;
  }
  /// The same for a field whose key in the case is its name in the API.
  Field operator+(const std::string& below) const {
    return at(below, below.starts_with('.') ? below.substr(1) : below);
  }
  Field operator[](std::size_t i) const { return *this + fmt::format("[{}]", i); }
};

inline std::ostream& operator<<(std::ostream& out, const Field& field) {
  return out << field.shown;
}

}  // namespace anticrack::mesh
