// SPDX-License-Identifier: GPL-3.0-or-later
#include "results/assemble.hpp"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <utility>

#include "results/entries.hpp"
#include "results/tables.hpp"

namespace anticrack::results {
namespace {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian");

[[noreturn]] void fail(const std::string& cause) {
  throw Error("the result read from the server", cause,
              "the server and this client do not understand each other: compare their versions "
              "with `anticrack server`");
}

/// The path in a file of an array of ReadResult, which has loads by their numbers and the rows of a
/// sweep apart from loads.
std::string path_of(const std::string& name, const std::vector<Load>& loads) {
  const std::size_t begin = name.find('/') + 1, end = name.find('/', begin);
  const bool row = name.starts_with("traces/");
  if ((!row && !name.starts_with("loads/")) || end == std::string::npos) return name;
  std::size_t index = 0;
  std::from_chars(name.data() + begin, name.data() + end, index);
  const std::string rest = name.substr(end);
  if (row) return load_path(row_name(static_cast<std::int64_t>(index))) + "traces" + rest;
  if (index >= loads.size()) return name;
  // The numbers of a subdomain are all there is of it below a load.
  return load_path(loads[index].name()) + rest.substr(1) +
         (rest.starts_with("/fields/") ? "/u" : "");
}

/// Adds the arrays of a block; `path` gives the path of a name.
template <class Path>
void add_block(const BlockView& block, const Path& path, Arrays& arrays) {
  const std::vector<std::byte>& bytes = *block.bytes;
  for (const v1::ArrayLayout& layout : block.layout.arrays()) {
    if (layout.type() < v1::ArrayLayout::TYPE_FLOAT64 ||
        layout.type() > v1::ArrayLayout::TYPE_UINT8)
      continue;  // of a newer server
    Array array{
        static_cast<ValueType>(layout.type()), {layout.shape().begin(), layout.shape().end()}, {}};
    std::uint64_t size = bytes_of(array.type);
    bool inside = layout.offset() <= bytes.size() && layout.offset() % size == 0;
    for (const std::uint64_t extent : array.shape)
      inside = inside && !__builtin_mul_overflow(size, extent, &size);
    if (!inside || size > bytes.size() - layout.offset()) {
      fail(fmt::format("array {} of shape ({}) at byte {} lies outside the {} bytes", layout.name(),
                       fmt::join(array.shape, ","), layout.offset(), bytes.size()));
    }
    array.data = {block.bytes, bytes.data() + layout.offset()};
    if (!arrays.emplace(path(layout.name()), std::move(array)).second)
      fail("array " + layout.name() + " twice");
  }
}

bool has_below(const Arrays& arrays, const std::string& folder) {
  const auto found = arrays.lower_bound(folder);
  return found != arrays.end() && found->first.starts_with(folder);
}

/// Refuses arrays of a folder, which ends with a slash, that are not as the table says.
void check(const Arrays& arrays, const std::string& folder, std::span<const tables::Row> table,
           Extents known = {}) {
  for (const tables::Row& row : table) {
    const std::string path = folder + std::string(row.name);
    const auto found = arrays.find(path);
    if (found == arrays.end() && row.optional) continue;
    if (found == arrays.end()) fail("array " + path + " is missing");
    const Array& array = found->second;
    if (array.type != row.type)
      fail(fmt::format("array {} is {}, not {}", path, name_of(array.type), name_of(row.type)));
    if (!fits(array.shape, row.shape, known))
      fail(fmt::format("array {} has shape ({}), not ({})", path, fmt::join(array.shape, ","),
                       row.shape));
  }
}

void check_traces(const Result& result, const std::string& load) {
  for (int i = 0; i < result.mesh.interfaces_size(); ++i)
    check(result.arrays, fmt::format("{}traces/{}/", load, i), tables::trace);
}

void check_load(const Result& result, const Load& load) {
  const std::string at = load_path(load.name());
  if (load.has_answer() || has_below(result.arrays, at + "traces/")) check_traces(result, at);
  if (load.has_answer() || has_below(result.arrays, at + "history/"))
    check(result.arrays, at + "history/", tables::history);
  check(result.arrays, at, tables::load);
  for (int i = 0; has_below(result.arrays, at + "fields/") && i < result.mesh.subdomains_size();
       ++i) {
    check(result.arrays, arrays::field_folder(static_cast<std::size_t>(i)), tables::subdomain);
    check(result.arrays, fmt::format("{}fields/{}/", at, i), tables::field);
  }
}

/// Adds an interval for each run of consecutive nodes in contact.
void add_contact_intervals(const Result& result, v1::LoadCaseAnswer& answer) {
  for (int i = 0; i < result.mesh.interfaces_size(); ++i) {
    const auto s = entries_at<double>(result.arrays, fmt::format("interfaces/{}/s", i));
    const auto contact = entries_at<std::int32_t>(
        result.arrays, fmt::format("{}traces/{}/contact", load_path(answer.name()), i));
    for (std::size_t k = 0; k < s.size() && k < contact.size(); ++k) {
      if (contact[k] == 0) continue;
      if (k == 0 || contact[k - 1] == 0) {
        v1::ContactInterval& interval = *answer.add_contact_intervals();
        interval.set_interface(result.mesh.interfaces(i).name());
        interval.set_begin(s[k]);
      }
      answer.mutable_contact_intervals()->rbegin()->set_end(s[k]);
    }
  }
}

/// Sets a message's numbers to the entries at `place` of the columns of this shape with their
/// names. A bound that is NaN is not set.
void set_numbers(const Sweep& sweep, std::size_t place, std::string_view shape,
                 google::protobuf::Message& message) {
  for (const tables::Row& row : tables::columns) {
    const auto* const field = message.GetDescriptor()->FindFieldByName(std::string(row.name));
    if (row.shape != shape || field == nullptr || field->cpp_type() != field->CPPTYPE_DOUBLE)
      continue;
    const auto column = sweep.numbers(row.name);
    if (!column.empty() && (!field->has_presence() || std::isfinite(column[place])))
      message.GetReflection()->SetDouble(&message, field, column[place]);
  }
}

/// The answer to a row, made of the sweep's columns.
v1::LoadCaseAnswer answer_of(const Sweep& sweep, std::size_t row) {
  v1::LoadCaseAnswer answer;
  forget_numbers(answer);
  answer.set_name(row_name(static_cast<std::int64_t>(row)));
  answer.set_status(static_cast<v1::LoadCaseAnswer::Status>(sweep.status()[row]));
  answer.set_iterations(sweep.integers("steps")[row]);
  answer.set_energy_mesh(sweep.numbers("energy")[row]);  // unless the sweep has bounds
  set_numbers(sweep, row, "rows", answer);
  const std::span<const double> slope = sweep.numbers("slope");
  for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
    v1::InclusionAnswer& inclusion = *answer.add_inclusions();
    forget_numbers(inclusion);
    inclusion.set_name(sweep.inclusions[i]);
    const std::size_t place = row * sweep.inclusions.size() + i;
    inclusion.set_displacement_mesh(sweep.numbers("displacement")[place]);  // unless it has bounds
    set_numbers(sweep, place, "rows,inclusions", inclusion);
    const double x = slope.empty() ? 0 : slope[2 * place],
                 y = slope.empty() ? 0 : slope[2 * place + 1];
    inclusion.set_slope_x(x);
    inclusion.set_slope_x_mesh(x);
    inclusion.set_slope_y(y);
    inclusion.set_slope_y_mesh(y);
  }
  return answer;
}

/// Fills in the columns of result.sweep and makes loads of the rows in `kept` that have traces.
void add_sweep(Result& result, const std::vector<std::int32_t>& kept) {
  Sweep& sweep = *result.sweep;
  const std::string folder = arrays::sweep_folder();
  for (const tables::Row& row : tables::columns)
    if (auto array = result.arrays.extract(folder + std::string(row.name)))
      sweep.columns.emplace(row.name, std::move(array.mapped()));
  sweep.columns["kept"] = array_of(kept);
  check(sweep.columns, "", tables::columns,
        {{"inclusions", sweep.inclusions.size()}, {"loads", sweep.loads.size()}});
  if (const std::string fault = first_fault(sweep); !fault.empty()) fail(fault);
  std::vector<std::int32_t> with_traces;
  for (const std::int32_t row : kept) {
    const std::string at = load_path(row_name(row));
    if (!has_below(result.arrays, at)) continue;  // the row did not end
    check_traces(result, at);
    with_traces.push_back(row);
    Load& load = result.loads.emplace_back();
    load.answer = answer_of(sweep, static_cast<std::size_t>(row));
    add_contact_intervals(result, load.answer);
  }
  sweep.columns["kept"] = array_of(std::move(with_traces));
}

}  // namespace

Result assemble(Result answers, const BlockView& mesh_block, const BlockView& result_block,
                const std::vector<std::int32_t>& kept) {
  const auto of_mesh = [](const std::string& name) {
    return name.starts_with("interfaces/") ? name : "mesh/" + name;
  };
  answers.arrays.clear();
  add_block(mesh_block, of_mesh, answers.arrays);
  const auto of_result = [&](const std::string& name) { return path_of(name, answers.loads); };
  add_block(result_block, of_result, answers.arrays);
  check(answers.arrays, "mesh/", tables::mesh);
  for (int i = 0; i < answers.mesh.interfaces_size(); ++i)
    check(answers.arrays, arrays::interface_folder(static_cast<std::size_t>(i)), tables::interface);
  if (answers.sweep) add_sweep(answers, kept);
  for (const Load& load : answers.loads)
    if (!answers.sweep) check_load(answers, load);
  if (const std::string fault = first_fault(answers); !fault.empty()) fail(fault);
  return answers;
}

}  // namespace anticrack::results
