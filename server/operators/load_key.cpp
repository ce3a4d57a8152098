// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/load_key.hpp"

#include <bit>
#include <cstdint>
#include <map>
#include <variant>

namespace anticrack::operators {
namespace {

/// Each entry with its length or of fixed length, so that no two lists run into the same bytes.
class Key {
 public:
  void add(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) {
      _bytes.push_back(static_cast<char>(value >> shift & 0xff));
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(const std::string& text) {
    add(std::uint64_t{text.size()});
    _bytes += text;
  }
  void add(const std::map<std::string, double>& values) {
    add(std::uint64_t{values.size()});
    for (const auto& [name, value] : values) {
      add(name);
      add(value);
    }
  }
  void add(const fem::Expression& expression) { add(expression.text); }
  void add(const fem::PerRegion& regions) { add(regions.values); }
  void add(const fem::Array& array) {
    add(array.upload);
    add(std::uint64_t{array.per_triangle ? 1U : 0U});
  }

  std::string take() { return std::move(_bytes); }

 private:
  std::string _bytes;
};

}  // namespace

std::optional<std::string> key_of(std::span<const fem::Load* const> loads) {
  Key key;
  for (const fem::Load* load : loads) {
    const auto* array = std::get_if<fem::Array>(&load->force);
    if (array != nullptr && array->upload.empty()) {
      return std::nullopt;
    }
    key.add(std::uint64_t{load->force.index()});
    std::visit([&key](const auto& force) { key.add(force); }, load->force);
    key.add(load->boundary_value);
    key.add(load->traction);
    key.add(std::uint64_t{load->point_forces.size()});
    for (const fem::PointForce& force : load->point_forces) {
      key.add(force.x);
      key.add(force.y);
      key.add(force.value);
    }
    key.add(load->inclusion_forces);
  }
  return key.take();
}

}  // namespace anticrack::operators
