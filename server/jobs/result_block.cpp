// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/result_block.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "contact/answer.hpp"
#include "errors/errors.hpp"
#include "jobs/probes.hpp"
#include "jobs/trace_arrays.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::jobs {

namespace {

using records::BlockBuilder;

void add_history(BlockBuilder& builder, const std::string& folder,
                 const std::vector<contact::Sample>& history) {
  arrays::for_each(
      [&](const auto& row) {
        std::vector<arrays::MemberOf<const contact::Sample, decltype(row.member)>> column;
        column.reserve(history.size());
        for (const contact::Sample& sample : history)
          column.push_back(std::invoke(row.member, sample));
        builder.add(folder + std::string(row.name), column);
      },
      arrays::history<contact::Sample>);
}

/// The nodes, triangles and tensions of a subdomain, which all loads share.
struct Subdomain {
  std::span<const std::int32_t> nodes, triangles;
  std::vector<double> tension;
};

template <class... Rows>
constexpr std::uint64_t rows_of(const std::tuple<Rows...>&) {
  return sizeof...(Rows);
}

/// Of the answer to a load case, without its tips and the parts of the boundary.
std::uint64_t answer_bytes(const records::JobSpec& spec,
                           const std::vector<std::string>& inclusions) {
  constexpr std::uint64_t a_case = 800;        // numbers and texts
  constexpr std::uint64_t an_inclusion = 139;  // fourteen numbers and tags
  std::uint64_t bytes = a_case + probe_bytes(spec.probes);
  for (const std::string& name : inclusions) bytes += an_inclusion + name.size();
  return bytes;
}

}  // namespace

records::Block case_arrays(std::size_t index, const contact::Answer& answer,
                           const std::vector<contact::Sample>& history,
                           const std::vector<double>& indicator,
                           const std::vector<double>& balanced_flux) {
  BlockBuilder builder;
  add_traces(builder, arrays::load_traces(index), answer.traces);
  add_history(builder, arrays::load_history(index), history);
  for (std::size_t i = 0; i < answer.fields.size(); ++i)
    builder.add(fmt::format("{}{}", arrays::load_fields(index), i), answer.fields[i].u);
  if (!indicator.empty()) builder.add(arrays::load_folder(index) + "indicator", indicator);
  if (!balanced_flux.empty())
    builder.add(arrays::load_folder(index) + "balanced_flux", balanced_flux,
                {balanced_flux.size() / 3, 3});
  if (!answer.membrane_rows.empty()) {
    builder.add(arrays::load_folder(index) + "membrane_rows", answer.membrane_rows);
    builder.add(arrays::load_folder(index) + "membranes", answer.membranes);
  }
  return builder.take();
}

std::shared_ptr<const records::BlockSource> result_block(const LiveJob& job) {
  if (std::ranges::none_of(job.cases, [](const LiveCase& one) { return one.result.has_value(); }))
    return nullptr;
  BlockBuilder builder;
  add_geometry(builder, job.mesh_operator->trace_geometry());
  const std::size_t subdomains = job.spec->fields ? job.mesh_operator->mesh().subdomains.size() : 0;
  for (std::size_t i = 0; i < subdomains; ++i) {
    add_arrays(builder, arrays::field_folder(i), arrays::subdomain<Subdomain>,
               Subdomain{job.mesh_operator->field_nodes(i), job.mesh_operator->field_triangles(i),
                         job.mesh_operator->field_tension(i)});
  }
  store::SpooledBlock result(job.spool);
  const auto add = [&](const ResultPart& part) { result.add(part.arrays, part.run); };
  add(spooled(*job.spool, builder.take()));
  for (const LiveCase& one : job.cases)
    if (one.result) add(*one.result);
  return result.finish();
}

void require_result_arrays(const records::JobSpec& spec, std::uint64_t interfaces,
                           std::uint64_t subdomains, std::uint64_t max_arrays) {
  const std::uint64_t traces = rows_of(arrays::trace<contact::Trace>) * interfaces;
  std::uint64_t count = rows_of(arrays::interface_nodes<contact::TraceGeometry>) * interfaces;
  if (spec.sweep) {
    count += spec.sweep->traces.size() * traces;
  } else {
    const std::uint64_t fields = spec.fields ? subdomains : 0;
    count += rows_of(arrays::subdomain<Subdomain>) * fields +
             spec.loads.size() * (traces + rows_of(arrays::history<contact::Sample>) + fields +
                                  (spec.indicators ? 1 : 0) + (spec.balanced_flux ? 1 : 0) +
                                  (spec.growth && spec.fields ? 2 : 0));
  }
  if (count > max_arrays) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "the result would have {} arrays on this mesh and may have {}{}", count,
                        max_arrays, spec.sweep ? ": keep fewer traces" : ": split the job")
        .at(spec.sweep ? "sweep.traces" : "load_cases");
  }
}

bool has_room(const records::JobSpec& spec, const std::vector<std::string>& inclusions,
              std::size_t parts, std::size_t tips) {
  constexpr std::uint64_t a_part = 300;  // eight numbers, a name of at most 64 letters and a reason
  constexpr std::uint64_t a_tip = 210;   // ten numbers, names and a reason
  return spec.loads.size() * (answer_bytes(spec, inclusions) + a_part * parts + a_tip * tips) <=
         max_answer_bytes;
}

void require_answers(const records::JobSpec& spec, const std::vector<std::string>& inclusions) {
  const std::uint64_t answer = answer_bytes(spec, inclusions);
  if (!spec.sweep && spec.loads.size() * answer > max_answer_bytes) {
    throw errors::Error(errors::Reason::limit_exceeded,
                        "the answers to {} load cases with {} inclusions each do not fit in a "
                        "message: make jobs of at most {} load cases",
                        spec.loads.size(), inclusions.size(), max_answer_bytes / answer)
        .at("load_cases");
  }
}

}  // namespace anticrack::jobs
