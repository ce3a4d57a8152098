// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every field of a record, so that tests can fill it with anything and compare it bit by bit. The
// lists are structured bindings: a field that is added does not compile until it is listed.
#pragma once

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

#include "store/records.hpp"

namespace anticrack::testing {

// clang-format off
#define ANTICRACK_FIELDS(Type, ...)                                        \
  template <class Struct>                                                  \
    requires std::is_same_v<std::remove_const_t<Struct>, Type>             \
  auto fields(Struct& value) { auto& [__VA_ARGS__] = value; return std::tie(__VA_ARGS__); }

ANTICRACK_FIELDS(mesh::MeshOptions, a, b, c, d, e, f, g, h)
ANTICRACK_FIELDS(mesh::Part, a, b)
ANTICRACK_FIELDS(mesh::InterfaceSpec, a, b, c, d)
ANTICRACK_FIELDS(mesh::InclusionSpec, a, b, c)
ANTICRACK_FIELDS(mesh::CrackSpec, a, b)
ANTICRACK_FIELDS(mesh::RegionSpec, a, b, c)
ANTICRACK_FIELDS(mesh::Geometry, a, b, c, d, e, f)
ANTICRACK_FIELDS(store::UploadRef, a, b)
ANTICRACK_FIELDS(store::GeometrySource, a, b)
ANTICRACK_FIELDS(store::SubdomainSummary, a, b, c, d, e, f, g, h, i)
ANTICRACK_FIELDS(store::TipSummary, a, b, c)
ANTICRACK_FIELDS(store::SegmentSummary, a, b, c, d, e)
ANTICRACK_FIELDS(store::InterfaceSummary, a, b, c, d)
ANTICRACK_FIELDS(store::MeshRecord, a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u,
                 v, w)
ANTICRACK_FIELDS(fem::Expression, a)
ANTICRACK_FIELDS(fem::PerRegion, a)
ANTICRACK_FIELDS(fem::PointForce, a, b, c)
ANTICRACK_FIELDS(fem::Load, a, b, c, d, e, f)
ANTICRACK_FIELDS(contact::UzawaOptions, a, b, c, d, e, f)
ANTICRACK_FIELDS(contact::ActiveSetOptions, a, b)
ANTICRACK_FIELDS(contact::KktResiduals, a, b, c, d)
ANTICRACK_FIELDS(contact::InclusionAnswer, a, b, c, d)
ANTICRACK_FIELDS(contact::ContactInterval, a, b, c)
ANTICRACK_FIELDS(store::SweepSpec, a, b, c, d)
ANTICRACK_FIELDS(store::SweepRecord, a, b, c, d, e, f, g)
ANTICRACK_FIELDS(store::JobSpec, a, b, c, d, e, f, g, h, i)
ANTICRACK_FIELDS(store::Step, a, b, c)
ANTICRACK_FIELDS(store::CaseRecord, a, b, c, d)
ANTICRACK_FIELDS(store::JobRecord, a, b, c, d, e, f, g, h, i, j, k, l, m, n)
#undef ANTICRACK_FIELDS
// clang-format on

/// A record keeps no values of an array.
template <class Struct>
requires std::is_same_v<std::remove_const_t<Struct>, fem::Array>
auto fields(Struct& value) {
  auto& [upload, per_triangle, values] = value;
  static_cast<void>(values);
  return std::tie(upload, per_triangle);
}

/// And no traces, side traces, fields and closed contacts of an answer.
template <class Struct>
requires std::is_same_v<std::remove_const_t<Struct>, contact::Answer>
auto fields(Struct& value) {
  auto& [a, b, c, d, e, f, g, h, i, j, closed, k, l, m, n, traces, sides, arrays] = value;
  static_cast<void>(closed);
  static_cast<void>(traces);
  static_cast<void>(sides);
  static_cast<void>(arrays);
  return std::tie(a, b, c, d, e, f, g, h, i, j, k, l, m, n);
}

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
    value.resize(below(12));
    for (char& c : value) c = static_cast<char>(below(256));  // not only UTF-8
  }
  void fill(store::Clock::time_point& value) {
    value = store::Clock::time_point(std::chrono::nanoseconds(_random() >> 1U));
  }
  void fill(std::chrono::milliseconds& value) {
    value = std::chrono::milliseconds(_random() >> 2U);
  }
  void fill(errors::Error& error) {
    error = errors::Error(
        static_cast<errors::Reason>(below(static_cast<int>(errors::Reason::internal) + 1)),
        make<std::string>());
    for (std::uint64_t i = below(3); i > 0; --i) error.at(make<std::string>());
    for (std::uint64_t i = below(3); i > 0; --i) {
      error.with(make<std::string>(), make<std::string>());
    }
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
    value = static_cast<Enum>(below(count(value)) + (std::is_same_v<Enum, mesh::Kind> ? 1 : 0));
  }
  template <class Struct>
  requires std::is_class_v<Struct>
  void fill(Struct& value) {
    std::apply([&](auto&... each) { (fill(each), ...); }, fields(value));
  }

  static std::uint64_t count(mesh::Kind) { return 4; }
  static std::uint64_t count(mesh::Preset) { return 3; }
  static std::uint64_t count(mesh::Shape) { return 3; }
  static std::uint64_t count(contact::Mass) { return 2; }
  static std::uint64_t count(contact::Status) { return 3; }
  static std::uint64_t count(store::MeshState) { return 6; }
  static std::uint64_t count(store::JobState) { return 7; }
  static std::uint64_t count(store::CaseStatus) { return 6; }
  static std::uint64_t count(store::Priority) { return 3; }
  static std::uint64_t count(store::SweepSpec::Cases) { return 2; }

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
  void add(const store::Clock::time_point& time) { add(time.time_since_epoch().count()); }
  void add(const std::chrono::milliseconds& time) { add(time.count()); }
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
    std::apply([&](const auto&... each) { (add(each), ...); }, fields(value));
    _text << ") ";
  }

  std::ostringstream _text;
};

}  // namespace anticrack::testing
