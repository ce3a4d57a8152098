// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/codec.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

namespace anticrack::mesh {
namespace {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied as they lie in memory");

// The first eight bytes say what follows and in which version of the format.
constexpr std::string_view mesh_tag = "ACMESH1\n";
constexpr std::string_view request_tag = "ACMREQ1\n";
constexpr std::string_view reply_tag = "ACMREP1\n";

class Writer {
 public:
  explicit Writer(std::string_view tag) { raw(tag.data(), tag.size()); }

  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    // -0.0 equals 0.0, so it must not give other bytes
    if constexpr (std::is_floating_point_v<T>) value += T{0};
    raw(&value, sizeof value);
  }
  void count(std::size_t n) { number(static_cast<std::uint64_t>(n)); }
  void text(const std::string& value) {
    count(value.size());
    raw(value.data(), value.size());
  }
  template <class Range, class Write>
  void list(const Range& range, Write write) {
    count(range.size());
    for (const auto& item : range) write(item);
  }
  template <class T>
  void numbers(const std::vector<T>& values) {
    _bytes.reserve(_bytes.size() + 8 + values.size() * sizeof(T));
    list(values, [this](T value) { number(value); });
  }
  void texts(const std::vector<std::string>& values) {
    list(values, [this](const std::string& value) { text(value); });
  }

  Bytes take() { return std::move(_bytes); }

 private:
  void raw(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(data);
    _bytes.insert(_bytes.end(), first, first + size);
  }

  Bytes _bytes;
};

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, std::string_view tag) : _bytes(bytes) {
    if (left() < tag.size() || std::memcmp(_bytes.data(), tag.data(), tag.size()) != 0) {
      fail("they do not begin with the tag " + std::string(tag.substr(0, tag.size() - 1)));
    }
    _at = tag.size();
  }

  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    need(sizeof(T));
    T value;
    std::memcpy(&value, _bytes.data() + _at, sizeof value);
    _at += sizeof value;
    return value;
  }
  /// The length of a list whose items take at least `item_bytes` each; what is left bounds it.
  std::size_t count(std::size_t item_bytes) {
    const auto n = number<std::uint64_t>();
    if (n > left() / item_bytes) {
      fail("a list of " + std::to_string(n) + " items begins at byte " + std::to_string(_at) +
           " of " + std::to_string(_bytes.size()));
    }
    return static_cast<std::size_t>(n);
  }
  std::string text() {
    const std::size_t n = count(1);
    std::string value(n, '\0');
    if (n > 0) std::memcpy(value.data(), _bytes.data() + _at, n);
    _at += n;
    return value;
  }
  template <class T>
  std::vector<T> numbers() {
    const std::size_t n = count(sizeof(T));
    std::vector<T> values(n);
    if (n > 0) std::memcpy(values.data(), _bytes.data() + _at, n * sizeof(T));
    _at += n * sizeof(T);
    return values;
  }
  template <class Read>
  auto list(std::size_t item_bytes, Read read) {
    std::vector<decltype(read())> items;
    const std::size_t n = count(item_bytes);
    for (std::size_t i = 0; i < n; ++i) items.push_back(read());
    return items;
  }
  std::vector<std::string> texts() {
    return list(8, [this] { return text(); });
  }
  /// A number from `first` to `last`.
  std::int32_t choice(std::int32_t first, std::int32_t last, const char* what) {
    const auto value = number<std::int32_t>();
    if (value < first || value > last) {
      fail(std::string(what) + " is " + std::to_string(value) + "; it is " + std::to_string(first) +
           " to " + std::to_string(last));
    }
    return value;
  }
  void end() const {
    if (left() > 0) fail(std::to_string(left()) + " bytes are left over");
  }

 private:
  std::size_t left() const noexcept { return _bytes.size() - _at; }
  void need(std::size_t n) const {
    if (left() < n) fail("they end at byte " + std::to_string(_bytes.size()) + ", too early");
  }
  [[noreturn]] static void fail(const std::string& why) {
    throw errors::Error(errors::Reason::mesh_invalid, "these bytes cannot be decoded: " + why);
  }

  std::span<const std::byte> _bytes;
  std::size_t _at = 0;
};

constexpr auto last_kind = static_cast<std::int32_t>(Kind::delaminated);
constexpr auto last_reason = static_cast<std::int32_t>(errors::Reason::internal);

void put(Writer& out, const Mesh& mesh) {
  out.numbers(mesh.xy);
  out.numbers(mesh.triangles);
  out.numbers(mesh.subdomain);
  out.texts(mesh.subdomains);
  out.texts(mesh.inclusions);
  out.list(mesh.interfaces, [&](const Interface& interface) {
    out.text(interface.name);
    out.numbers(interface.nodes);
    out.list(interface.kind, [&](Kind kind) { out.number(static_cast<std::int32_t>(kind)); });
    out.numbers(interface.inclusion);
  });
  out.list(mesh.dirichlet, [&](const std::array<std::int32_t, 2>& edge) {
    out.number(edge[0]);
    out.number(edge[1]);
  });
}

Kind get_kind(Reader& in) {
  return static_cast<Kind>(in.choice(1, last_kind, "an edge's kind"));
}

Mesh get_mesh(Reader& in) {
  Mesh mesh;
  mesh.xy = in.numbers<double>();
  mesh.triangles = in.numbers<std::int32_t>();
  mesh.subdomain = in.numbers<std::int32_t>();
  mesh.subdomains = in.texts();
  mesh.inclusions = in.texts();
  mesh.interfaces = in.list(32, [&] {
    Interface interface;
    interface.name = in.text();
    interface.nodes = in.numbers<std::int32_t>();
    interface.kind = in.list(4, [&] { return get_kind(in); });
    interface.inclusion = in.numbers<std::int32_t>();
    return interface;
  });
  mesh.dirichlet = in.list(8, [&] {
    const auto a = in.number<std::int32_t>();
    const auto b = in.number<std::int32_t>();
    return std::array<std::int32_t, 2>{a, b};
  });
  return mesh;
}

void put(Writer& out, const PlannedCurve& curve) {
  out.number(static_cast<std::int32_t>(curve.a));
  out.number(static_cast<std::int32_t>(curve.b));
  out.number(static_cast<std::int32_t>(curve.intervals));
}

template <class Curve>
Curve get_curve(Reader& in) {
  Curve curve;
  curve.a = in.number<std::int32_t>();
  curve.b = in.number<std::int32_t>();
  curve.intervals = in.number<std::int32_t>();
  return curve;
}

void put(Writer& out, const Plan& plan) {
  out.list(plan.points, [&](const Point& point) {
    out.number(point[0]);
    out.number(point[1]);
  });
  for (const auto& curves : plan.outer) {
    out.list(curves, [&](const PlannedCurve& curve) { put(out, curve); });
  }
  out.list(plan.interface, [&](const PlannedInterfaceCurve& curve) {
    put(out, static_cast<const PlannedCurve&>(curve));
    out.number(static_cast<std::int32_t>(curve.kind));
    out.number(static_cast<std::int32_t>(curve.inclusion));
  });
  out.texts(plan.inclusions);
  out.number(plan.growth);
}

Plan get_plan(Reader& in) {
  Plan plan;
  plan.points = in.list(16, [&] {
    const auto x = in.number<double>();
    const auto y = in.number<double>();
    return Point{x, y};
  });
  for (auto& curves : plan.outer) {
    curves = in.list(12, [&] { return get_curve<PlannedCurve>(in); });
  }
  plan.interface = in.list(20, [&] {
    auto curve = get_curve<PlannedInterfaceCurve>(in);
    curve.kind = get_kind(in);
    curve.inclusion = in.number<std::int32_t>();
    return curve;
  });
  plan.inclusions = in.texts();
  plan.growth = in.number<double>();
  return plan;
}

/// The description of every field violation is the message itself (errors::Error::at), so the
/// paths are enough.
void put(Writer& out, const errors::Error& error) {
  out.number(static_cast<std::int32_t>(error.reason()));
  out.text(error.what());
  out.list(error.fields(), [&](const errors::FieldViolation& field) { out.text(field.field); });
  out.list(error.metadata(), [&](const auto& entry) {
    out.text(entry.first);
    out.text(entry.second);
  });
  out.number(static_cast<std::int64_t>(error.retry_delay().count()));
}

errors::Error get_error(Reader& in) {
  const auto reason = static_cast<errors::Reason>(in.choice(0, last_reason, "an error's reason"));
  errors::Error error(reason, in.text());
  for (std::string& field : in.texts()) error.at(std::move(field));
  const std::size_t entries = in.count(16);
  for (std::size_t i = 0; i < entries; ++i) {
    std::string key = in.text();
    error.with(std::move(key), in.text());
  }
  error.retry_after(std::chrono::milliseconds(in.number<std::int64_t>()));
  return error;
}

}  // namespace

Bytes encode(const Mesh& mesh) {
  Writer out(mesh_tag);
  put(out, mesh);
  return out.take();
}

Mesh decode_mesh(std::span<const std::byte> bytes) {
  Reader in(bytes, mesh_tag);
  Mesh mesh = get_mesh(in);
  in.end();
  return mesh;
}

Bytes encode(const MesherRequest& request) {
  Writer out(request_tag);
  out.number(static_cast<std::int32_t>(request.index()));
  if (const auto* generate = std::get_if<GenerateRequest>(&request)) {
    put(out, generate->plan);
    out.count(generate->max_triangles);
  } else {
    const auto& import = std::get<ImportRequest>(request);
    out.text(import.path);
    out.count(import.max_triangles);
  }
  return out.take();
}

MesherRequest decode_request(std::span<const std::byte> bytes) {
  Reader in(bytes, request_tag);
  MesherRequest request;
  if (in.choice(0, 1, "the request") == 0) {
    GenerateRequest generate;
    generate.plan = get_plan(in);
    generate.max_triangles = in.number<std::uint64_t>();
    request = std::move(generate);
  } else {
    ImportRequest import;
    import.path = in.text();
    import.max_triangles = in.number<std::uint64_t>();
    request = std::move(import);
  }
  in.end();
  return request;
}

Bytes encode(const MesherReply& reply) {
  Writer out(reply_tag);
  out.number(static_cast<std::int32_t>(reply.index()));
  if (const auto* mesh = std::get_if<Mesh>(&reply)) {
    put(out, *mesh);
    out.texts(mesh->warnings);
  } else {
    put(out, std::get<errors::Error>(reply));
  }
  return out.take();
}

MesherReply decode_reply(std::span<const std::byte> bytes) {
  Reader in(bytes, reply_tag);
  if (in.choice(0, 1, "the reply") == 1) {
    errors::Error error = get_error(in);
    in.end();
    return error;
  }
  Mesh mesh = get_mesh(in);
  mesh.warnings = in.texts();
  in.end();
  return mesh;
}

}  // namespace anticrack::mesh
