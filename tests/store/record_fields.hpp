// SPDX-License-Identifier: GPL-3.0-or-later
//
// Records filled with anything, and all their fields as text to compare them bit by bit.
#pragma once

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "fields/fields.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"

namespace anticrack::testing {

/// Fills fields with anything, what is seldom more often than it comes.
class AnyValue {
 public:
  explicit AnyValue(unsigned seed) : _random(seed) {}

  template <class T>
  T make() {
    T value{};
    fill(value);
    return value;
  }

 private:
  std::uint64_t below(std::uint64_t bound) { return _random() % bound; }

  void fill(bool& value) { value = below(2) == 1; }
  void fill(double& value) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::array rare{0.0,       -0.0,   infinity,
                          -infinity, 5e-324, std::numeric_limits<double>::quiet_NaN()};
    const std::uint64_t kind = below(3 * rare.size());
    value = kind < rare.size() ? rare[kind] : std::bit_cast<double>(_random());
  }
  void fill(std::string& value) {
    const std::array pieces{"a", "Z", " ", "/", "\"", "\n", "\x01", "\xc3\xa9", "\xf0\x9f\x99\x82"};
    value.clear();
    for (std::uint64_t i = below(12); i > 0; --i) {
      value += below(10) == 0 ? std::string(1, '\0') : pieces[below(pieces.size())];
    }
  }
  void fill(records::Clock::time_point& value) {
    value = records::Clock::time_point(std::chrono::nanoseconds(_random() >> 1U));
  }
  void fill(std::chrono::milliseconds& value) {
    value = std::chrono::milliseconds(below(1ULL << 42U));  // 139 years
  }
  void fill(std::chrono::nanoseconds& value) { value = std::chrono::nanoseconds(_random() >> 1U); }
  void fill(errors::Error& error) {
    const auto text = [this] {
      std::string some = make<std::string>();
      for (char& c : some) c = c == '\n' || c == '\x01' || c == '\0' ? '?' : c;
      return some;
    };
    error = errors::Error(
        static_cast<errors::Reason>(below(static_cast<int>(errors::Reason::internal) + 1)), text());
    for (std::uint64_t i = below(3); i > 0; --i) error.at(text());
    for (std::uint64_t i = below(3); i > 0; --i) error.with(text(), text());
    error.retry_after(std::chrono::milliseconds(below(10'000)));
  }
  template <class T>
  requires std::is_integral_v<T>
  void fill(T& value) { value = static_cast<T>(_random()); }
  template <class T, std::size_t N>
  void fill(std::array<T, N>& values) {
    for (T& value : values) fill(value);
  }
  template <class T>
  void fill(std::vector<T>& values) {
    values.resize(below(3));
    for (T& value : values) fill(value);
  }
  template <class Key, class Value>
  void fill(std::map<Key, Value>& values) {
    for (std::uint64_t i = below(3); i > 0; --i) values[make<Key>()] = make<Value>();
  }
  void fill(std::optional<errors::Error>& value) {
    if (below(2) == 1) fill(value.emplace(errors::Reason::internal, ""));
  }
  template <class T>
  void fill(std::optional<T>& value) {
    value.reset();
    if (below(2) == 1) fill(value.emplace());
  }
  template <class... Types>
  void fill(std::variant<Types...>& value) {
    const std::uint64_t index = below(sizeof...(Types));
    std::uint64_t i = 0;
    ((i++ == index ? fill(value.template emplace<Types>()) : void()), ...);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void fill(Enum& value) {
    constexpr bool from_0 =
        std::is_same_v<Enum, mesh::Preset> || std::is_same_v<Enum, mesh::Shape> ||
        std::is_same_v<Enum, mesh::LineSide> || std::is_same_v<Enum, records::SweepSpec::Cases>;
    value = static_cast<Enum>(below(count(value)) + (from_0 ? 0 : 1));
    if constexpr (std::is_same_v<Enum, records::JobState>)
      if (static_cast<int>(value) == 7) value = records::JobState::not_converged;  // there is no 7
  }
  template <class Struct>
  requires std::is_class_v<Struct>
  void fill(Struct& value) {
    fields::for_each(value, [this](const auto& field) { fill(field.value); });
    if constexpr (std::is_same_v<Struct, mesh::InterfaceSpec>) {
      if (value.shape == mesh::Shape::arc) value.points.resize(3);
    } else if constexpr (std::is_same_v<Struct, mesh::LineSpec>) {
      if (below(2) == 1) value.shape = mesh::Shape::segment;
      const bool segment = value.shape == mesh::Shape::segment;
      if (segment || value.shape == mesh::Shape::arc) value.points.resize(segment ? 1 : 3);
      if (!segment) value.angle = value.length = 0;
    } else if constexpr (std::is_same_v<Struct, mesh::OutlineSpec>) {
      const bool circle = value.shape == mesh::Shape::arc;  // which it cannot be
      if (circle) value.shape = mesh::Shape::circle;
      if (circle) value.points.resize(1);
      if (!circle) value.radius = 0;
    } else if constexpr (std::is_same_v<Struct, mesh::InclusionSpec> ||
                         std::is_same_v<Struct, mesh::CrackSpec>) {
      if (value.line) value.part = {};
    } else if constexpr (std::is_same_v<Struct, mesh::RegionSpec>) {
      if (value.outline) value.at = {};
    } else if constexpr (std::is_same_v<Struct, mesh::MeshOptions>) {
      positive(value.size);
      positive(value.tip_size);
      positive(value.chord_angle);
    } else if constexpr (std::is_same_v<Struct, records::MeshRecord>) {
      positive(value.bisection_bound);
    } else if constexpr (std::is_same_v<Struct, contact::AnswerSummary>) {
      positive(value.theta);
      positive(value.theta_star);
    } else if constexpr (std::is_same_v<Struct, records::JobRecord>) {
      if (value.spec.growth) value.spec.accuracy.reset();  // a job has one task
      if (value.spec.growth || value.spec.accuracy) value.spec.sweep.reset();
      if (!value.spec.sweep) value.sweep = {};
    }
  }
  void fill(std::shared_ptr<const std::vector<double>>&) {}  // a record keeps no values of an array

  /// Not -0: 0 is for a field that is unset.
  static void positive(double& value) { value = value == 0 ? 0 : value; }

  static std::uint64_t count(mesh::Kind) { return 4; }
  static std::uint64_t count(mesh::TipKind) { return 5; }
  static std::uint64_t count(mesh::Preset) { return 3; }
  static std::uint64_t count(mesh::Shape) { return 3; }
  static std::uint64_t count(mesh::LineSide) { return 3; }
  static std::uint64_t count(contact::Mass) { return 2; }
  static std::uint64_t count(contact::Status) { return 6; }
  static std::uint64_t count(records::MeshState) { return 6; }
  static std::uint64_t count(records::JobState) { return 7; }
  static std::uint64_t count(records::Priority) { return 3; }
  static std::uint64_t count(records::SweepSpec::Cases) { return 2; }

  std::mt19937_64 _random;
};

/// All fields as text, doubles by their bits.
class Listing {
 public:
  template <class T>
  static std::string of(const T& value) {
    Listing listing;
    listing.add(value);
    return listing._text.str();
  }

 private:
  void add(const std::string& value) { _text << '"' << value << "\" "; }
  void add(double value) { _text << std::hex << std::bit_cast<std::uint64_t>(value) << "h "; }
  void add(const records::Clock::time_point& time) { add(time.time_since_epoch().count()); }
  template <class Rep, class Period>
  void add(const std::chrono::duration<Rep, Period>& time) {
    add(time.count());
  }
  void add(const std::shared_ptr<const std::vector<double>>& values) { add(values == nullptr); }
  void add(const errors::Error& error) {
    add(error.reason());
    add(std::string(error.what()));
    for (const errors::FieldViolation& violation : error.fields()) {
      add(violation.field);
      add(violation.description);
    }
    add(error.metadata());
    add(error.retry_delay());
  }
  template <class T>
  requires std::is_integral_v<T>
  void add(const T& value) { _text << std::dec << +value << ' '; }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& values) {
    for (const T& value : values) add(value);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    _text << "[";
    for (const T& value : values) add(value);
    _text << "] ";
  }
  template <class Key, class Value>
  void add(const std::map<Key, Value>& values) {
    _text << "{";
    for (const auto& [key, value] : values) {
      add(key);
      add(value);
    }
    _text << "} ";
  }
  template <class T>
  void add(const std::optional<T>& value) {
    if (value) {
      add(*value);
    } else {
      _text << "none ";
    }
  }
  template <class... Types>
  void add(const std::variant<Types...>& value) {
    _text << '<' << value.index() << "> ";
    std::visit([&](const auto& held) { add(held); }, value);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void add(const Enum& value) { _text << '#' << static_cast<int>(value) << ' '; }
  template <class Struct>
  requires std::is_class_v<Struct>
  void add(const Struct& value) {
    _text << "(";
    fields::for_each(value, [this](const auto& field) { add(field.value); });
    _text << ") ";
  }

  std::ostringstream _text;
};

}  // namespace anticrack::testing
