// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <bit>
#include <cstring>
#include <map>
#include <utility>

namespace anticrack::results {
namespace {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian");

constexpr const char* cure =
    "the server and this client do not understand each other: compare their versions with "
    "`anticrack server`";

std::size_t size_of(ArrayView::Type type) {
  return type == ArrayView::Type::float64 ? 8 : 4;
}

const char* name_of(ArrayView::Type type) {
  return type == ArrayView::Type::float64 ? "float64" : "int32";
}

std::string text_of(const std::vector<std::uint64_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i == 0 ? "" : ",") + std::to_string(shape[i]);
  }
  return text + ")";
}

/// Bytes of an array of this shape; throws where the product leaves 64 bits.
std::uint64_t byte_count(const std::string& subject, const std::string& name, ArrayView::Type type,
                         const std::vector<std::uint64_t>& shape) {
  std::uint64_t bytes = size_of(type);
  for (const std::uint64_t extent : shape) {
    if (__builtin_mul_overflow(bytes, extent, &bytes)) {
      throw Error(subject, "array " + name + " has the impossible shape " + text_of(shape), cure);
    }
  }
  return bytes;
}

/// One block, arrays by name.
class Block {
 public:
  Block(std::string subject, std::span<const ArrayView> arrays) : _subject(std::move(subject)) {
    for (const ArrayView& array : arrays) {
      if (!_arrays.emplace(array.name, &array).second) fail("array " + array.name + " twice");
    }
  }

  bool has(const std::string& name) const { return _arrays.count(name) != 0; }

  /// Any array below a folder, e.g. "loads/0/traces/".
  bool has_below(const std::string& prefix) const {
    const auto found = _arrays.lower_bound(prefix);
    return found != _arrays.end() && found->first.compare(0, prefix.size(), prefix) == 0;
  }

  /// Array of shape (rows) for columns 0, else (rows, columns).
  template <typename T>
  std::vector<T> get(const std::string& name, std::uint64_t columns = 0) const {
    const auto found = _arrays.find(name);
    if (found == _arrays.end()) fail("array " + name + " is missing");
    const ArrayView& array = *found->second;
    constexpr auto wanted = sizeof(T) == 8 ? ArrayView::Type::float64 : ArrayView::Type::int32;
    if (array.type != wanted) {
      fail("array " + name + " is " + name_of(array.type) + ", not " + name_of(wanted));
    }
    const bool fits = columns == 0 ? array.shape.size() == 1
                                   : array.shape.size() == 2 && array.shape[1] == columns;
    if (!fits) {
      fail("array " + name + " has shape " + text_of(array.shape) + ", not " +
           (columns == 0 ? std::string("(n)") : "(n," + std::to_string(columns) + ")"));
    }
    if (byte_count(_subject, name, array.type, array.shape) != array.bytes.size()) {
      fail("array " + name + " of shape " + text_of(array.shape) + " comes with " +
           std::to_string(array.bytes.size()) + " bytes");
    }
    std::vector<T> values(array.bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), array.bytes.data(), array.bytes.size());
    return values;
  }

  [[noreturn]] void fail(const std::string& cause) const { throw Error(_subject, cause, cure); }

 private:
  std::string _subject;
  std::map<std::string, const ArrayView*> _arrays;
};

Trace trace_of(const Block& block, const std::string& at) {
  Trace trace;
  trace.u_minus = block.get<double>(at + "/u_minus");
  trace.u_plus = block.get<double>(at + "/u_plus");
  trace.jump = block.get<double>(at + "/jump");
  trace.pressure = block.get<double>(at + "/pressure");
  trace.contact = block.get<std::int32_t>(at + "/contact");
  return trace;
}

History history_of(const Block& block, const std::string& at) {
  History history;
  history.iteration = block.get<std::int32_t>(at + "/iteration");
  history.criterion = block.get<double>(at + "/criterion");
  history.energy = block.get<double>(at + "/energy");
  history.contact_count = block.get<std::int32_t>(at + "/contact_count");
  history.kkt_equilibrium = block.get<double>(at + "/kkt_equilibrium");
  history.kkt_gap = block.get<double>(at + "/kkt_gap");
  history.kkt_sign = block.get<double>(at + "/kkt_sign");
  history.kkt_complementarity = block.get<double>(at + "/kkt_complementarity");
  return history;
}

void add_mesh(const Block& block, Mesh& mesh) {
  mesh.xy = block.get<double>("nodes", 2);
  mesh.triangles = block.get<std::int32_t>("triangles", 3);
  mesh.subdomain = block.get<std::int32_t>("subdomain");
  mesh.boundary = block.get<std::int32_t>("boundary", 2);
}

void add_interface(const Block& block, std::size_t index, Interface& interface) {
  const std::string at = "interfaces/" + std::to_string(index);
  interface.s = block.get<double>(at + "/s");
  interface.x = block.get<double>(at + "/x");
  interface.y = block.get<double>(at + "/y");
  interface.kind.clear();
  for (const std::int32_t kind : block.get<std::int32_t>(at + "/kind")) {
    interface.kind.push_back(static_cast<Kind>(kind));
  }
}

/// A subdomain's nodes and triangles serve all loads.
Field field_of(const Block& block, const std::string& load, std::size_t subdomain,
               const Mesh& mesh) {
  const std::string at = "fields/" + std::to_string(subdomain);
  Field field;
  field.nodes = block.get<std::int32_t>(at + "/nodes");
  field.u = block.get<double>(load + "/" + at);
  if (!block.has(at + "/triangles")) {
    if (auto triangles = triangles_of(mesh, subdomain, field.nodes)) {
      field.triangles = *std::move(triangles);
      return field;
    }
  }
  field.triangles = block.get<std::int32_t>(at + "/triangles", 3);
  return field;
}

void add_load(const Block& block, std::size_t index, std::size_t interfaces, const Mesh& mesh,
              Load& load) {
  const std::string at = "loads/" + std::to_string(index);
  const bool solved = load.status == Status::converged || load.status == Status::not_converged;
  load.traces.clear();
  load.fields.clear();
  load.history = {};
  if (solved || block.has_below(at + "/traces/")) {
    for (std::size_t i = 0; i < interfaces; ++i) {
      load.traces.push_back(trace_of(block, at + "/traces/" + std::to_string(i)));
    }
  }
  if (solved || block.has_below(at + "/history/")) {
    load.history = history_of(block, at + "/history");
  }
  if (block.has_below(at + "/fields/")) {
    for (std::size_t i = 0; i < mesh.subdomains.size(); ++i) {
      load.fields.push_back(field_of(block, at, i, mesh));
    }
  }
}

}  // namespace

ArrayView view(std::string name, ArrayView::Type type, std::vector<std::uint64_t> shape,
               std::uint64_t offset, std::span<const std::byte> block) {
  const std::string subject = "a block of the server";
  const std::uint64_t bytes = byte_count(subject, name, type, shape);
  if (offset > block.size() || bytes > block.size() - offset) {
    throw Error(subject,
                "array " + name + " of shape " + text_of(shape) + " at byte " +
                    std::to_string(offset) + " lies outside the " + std::to_string(block.size()) +
                    " bytes",
                cure);
  }
  return {std::move(name), type, std::move(shape), block.subspan(offset, bytes)};
}

Result assemble(Result answers, std::span<const ArrayView> mesh_block,
                std::span<const ArrayView> result_block) {
  const Block mesh("the mesh read from the server", mesh_block);
  const Block result("the result read from the server", result_block);
  add_mesh(mesh, answers.mesh);
  std::string fault = first_mesh_fault(answers.mesh);
  if (!fault.empty()) mesh.fail(fault);
  for (std::size_t i = 0; i < answers.interfaces.size(); ++i) {
    add_interface(result, i, answers.interfaces[i]);
  }
  for (std::size_t i = 0; i < answers.loads.size(); ++i) {
    add_load(result, i, answers.interfaces.size(), answers.mesh, answers.loads[i]);
  }
  fault = first_fault(answers);
  if (!fault.empty()) result.fail(fault);
  return answers;
}

}  // namespace anticrack::results
