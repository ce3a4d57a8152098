// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/to_result.hpp"

#include <functional>
#include <map>
#include <span>
#include <type_traits>
#include <vector>

#include "cli/mesh_text.hpp"
#include "results/assemble.hpp"
#include "results/tables.hpp"

namespace anticrack::cli {
namespace {

static_assert(static_cast<int>(results::Status::pending) == v1::LoadCaseAnswer::STATUS_PENDING &&
              static_cast<int>(results::Status::cancelled) == v1::LoadCaseAnswer::STATUS_CANCELLED);

double seconds_of(const google::protobuf::Duration& duration) {
  return static_cast<double>(duration.seconds()) + 1e-9 * duration.nanos();
}

results::Kkt absolute(const v1::KktResiduals& kkt) {
  return {kkt.equilibrium(), kkt.gap(), kkt.sign(), kkt.complementarity()};
}

results::Kkt relative(const v1::KktResiduals& kkt) {
  return {kkt.equilibrium_relative(), kkt.gap_relative(), kkt.sign_relative(),
          kkt.complementarity_relative()};
}

// In the API 0 means none.
double positive_or_unknown(double value) { return value > 0 ? value : results::unknown; }

void set_solver(const v1::Solver& solver, results::Load& load) {
  // Defaults as the API documents them.
  if (!solver.has_uzawa()) {
    const v1::ActiveSet& active_set = solver.active_set();
    load.method = "active-set";
    load.tolerance = active_set.has_tolerance() ? active_set.tolerance() : 1e-12;
    return;
  }
  const v1::Uzawa& uzawa = solver.uzawa();
  load.method = "uzawa";
  load.mass = uzawa.mass() == v1::MASS_CONSISTENT ? "consistent" : "lumped";
  load.p = uzawa.has_p() ? uzawa.p() : 1e5;
  if (uzawa.has_kkt_tolerance())
    load.kkt_tolerance = uzawa.kkt_tolerance();
  else
    load.epsilon = uzawa.has_epsilon() ? uzawa.epsilon() : 1e-12;
}

/// Copies the fields of the answer that the file has under the same name.
void copy_scalars(const v1::LoadCaseAnswer& answer, results::Load& load) {
  using Type = google::protobuf::FieldDescriptor;
  arrays::for_each(
      [&](const auto& row) {
        const Type* field = answer.GetDescriptor()->FindFieldByName(std::string(row.name));
        if (field == nullptr) return;
        const google::protobuf::Reflection& fields = *answer.GetReflection();
        auto& member = std::invoke(row.member, load);
        using Value = std::remove_cvref_t<decltype(member)>;
        const Type::CppType type = field->cpp_type();
        if constexpr (std::is_same_v<Value, double>) {
          const bool is_set = !field->has_presence() || fields.HasField(answer, field);
          if (type == Type::CPPTYPE_DOUBLE && is_set) member = fields.GetDouble(answer, field);
        } else if constexpr (std::is_same_v<Value, std::string>) {
          if (type == Type::CPPTYPE_STRING) member = fields.GetString(answer, field);
        } else if constexpr (std::is_same_v<Value, std::int32_t>) {
          if (type == Type::CPPTYPE_INT32) member = fields.GetInt32(answer, field);
        }
      },
      results::tables::load);
}

results::Load to_load(const v1::LoadCase& load_case, const v1::LoadCaseAnswer& answer,
                      const v1::Solver& solver) {
  results::Load load;
  load.name = load_case.name();
  load.status = static_cast<results::Status>(answer.status());
  load.reason = answer.reason();
  load.error = answer.error().message();
  set_solver(solver, load);
  load.iterations = answer.iterations();
  load.solve_seconds = seconds_of(answer.solve_time());
  if (load.status != results::Status::converged && load.status != results::Status::not_converged) {
    load.kkt = load.kkt_relative = results::unknown_kkt;
    load.contact_length = results::unknown;
    return load;
  }
  copy_scalars(answer, load);
  load.theta = positive_or_unknown(load.theta);
  load.theta_star = positive_or_unknown(load.theta_star);
  load.kkt = absolute(answer.kkt());
  load.kkt_relative = relative(answer.kkt());
  load.warnings.assign(answer.warnings().begin(), answer.warnings().end());
  for (const v1::InclusionAnswer& inclusion : answer.inclusions()) {
    results::Inclusion& to = load.inclusions.emplace_back(
        results::Inclusion{inclusion.name(), inclusion.displacement(), inclusion.resultant(),
                           inclusion.contact_length(), inclusion.slope_x(), inclusion.slope_y(),
                           inclusion.moment_x(), inclusion.moment_y()});
    const auto copy = [](bool is_set, double value, double& to_value) {
      if (is_set) to_value = value;
    };
    copy(inclusion.has_displacement_lower(), inclusion.displacement_lower(), to.displacement_lower);
    copy(inclusion.has_displacement_upper(), inclusion.displacement_upper(), to.displacement_upper);
    copy(inclusion.has_displacement_estimated_error(), inclusion.displacement_estimated_error(),
         to.displacement_estimated_error);
    copy(inclusion.has_slope_x_lower(), inclusion.slope_x_lower(), to.slope_x_lower);
    copy(inclusion.has_slope_x_upper(), inclusion.slope_x_upper(), to.slope_x_upper);
    copy(inclusion.has_slope_y_lower(), inclusion.slope_y_lower(), to.slope_y_lower);
    copy(inclusion.has_slope_y_upper(), inclusion.slope_y_upper(), to.slope_y_upper);
  }
  return load;
}

void add_contact(const v1::LoadCaseAnswer& answer,
                 const std::map<std::string, std::size_t>& interfaces, results::Load& load) {
  for (const v1::ContactInterval& interval : answer.contact_intervals()) {
    const auto found = interfaces.find(interval.interface());
    if (found == interfaces.end()) {
      throw results::Error("load case " + load.name,
                           "it has contact on '" + interval.interface() + "', no such interface",
                           "");
    }
    load.contact_intervals.push_back({found->second, interval.begin(), interval.end()});
  }
}

std::vector<results::ArrayView> views_of(const client::Block& block) {
  std::vector<results::ArrayView> views;
  for (const v1::ArrayLayout& array : block.layout.arrays()) {
    if (array.type() < v1::ArrayLayout::TYPE_FLOAT64 || array.type() > v1::ArrayLayout::TYPE_UINT8)
      continue;  // of a later version
    views.push_back(results::view(array.name(), static_cast<results::ValueType>(array.type()),
                                  {array.shape().begin(), array.shape().end()}, array.offset(),
                                  std::span(block.bytes)));
  }
  return views;
}

void add_names(const v1::Mesh& from, results::Mesh& to) {
  to.subdomains.reserve(static_cast<std::size_t>(from.subdomains_size()));
  to.tension.reserve(static_cast<std::size_t>(from.subdomains_size()));
  for (const v1::SubdomainInfo& subdomain : from.subdomains()) {
    to.subdomains.push_back(subdomain.name());
    to.tension.push_back(subdomain.tension() > 0 ? subdomain.tension() : 1);
    if (!subdomain.has_tension_law()) continue;
    to.tension_law.resize(static_cast<std::size_t>(from.subdomains_size()));
    to.tension_law[to.tension.size() - 1] = law_text(subdomain.tension_law());
  }
  to.inclusions.assign(from.inclusions().begin(), from.inclusions().end());
}

// All but its columns.
results::Sweep to_sweep(const Fetched& fetched) {
  results::Sweep sweep;
  for (const v1::LoadCase& load : fetched.job.load_cases()) sweep.loads.push_back(load.name());
  sweep.inclusions.assign(fetched.mesh.inclusions().begin(), fetched.mesh.inclusions().end());
  // A row beyond int32 becomes negative, which is refused.
  sweep.kept.assign(fetched.job.sweep().traces().begin(), fetched.job.sweep().traces().end());
  sweep.error = fetched.job.error().message();
  sweep.solve_seconds = seconds_of(fetched.job.sweep_answer().solve_time());
  return sweep;
}

void add_stage(const v1::Stage& stage, int load, results::Stages& stages) {
  const auto or_unknown = [](bool is_set, double value) {
    return is_set ? value : results::unknown;
  };
  const v1::StageAnswer& answer = stage.answers(load);
  stages.triangles.push_back(static_cast<std::int64_t>(stage.triangles()));
  stages.energy.push_back(answer.energy());
  stages.energy_lower.push_back(or_unknown(answer.has_energy_lower(), answer.energy_lower()));
  stages.energy_upper.push_back(or_unknown(answer.has_energy_upper(), answer.energy_upper()));
  stages.error_bound_relative.push_back(
      or_unknown(answer.has_error_bound_relative(), answer.error_bound_relative()));
  stages.displacement_error.push_back(
      or_unknown(answer.has_displacement_error(), answer.displacement_error()));
  stages.seconds.push_back(stage.seconds());
}

}  // namespace

std::string mesh_of(const v1::Job& job) {
  std::string mesh = job.mesh();
  for (const v1::Stage& stage : job.stages())
    if (stage.answers_size() > 0) mesh = stage.mesh();
  return mesh;
}

results::Units to_units(const v1::Units& units) { return {units.length(), units.force()}; }

std::vector<results::Load> to_loads(const v1::Job& job) {
  std::vector<results::Load> loads;
  loads.reserve(static_cast<std::size_t>(job.load_cases_size()));
  for (int i = 0; i < job.load_cases_size(); ++i) {
    const auto& answer =
        i < job.answers_size() ? job.answers(i) : v1::LoadCaseAnswer::default_instance();
    loads.push_back(to_load(job.load_cases(i), answer, job.solver()));
    for (const v1::Stage& stage : job.stages())
      if (i < stage.answers_size()) add_stage(stage, i, loads.back().stages);
  }
  return loads;
}

results::Mesh to_mesh(const v1::Mesh& mesh, const client::Block& block) {
  results::Mesh named;
  add_names(mesh, named);
  return results::assemble_mesh(std::move(named), views_of(block));
}

results::Result to_result(const Fetched& fetched) {
  results::Result result;
  result.title = fetched.job.title();
  result.client_version = ANTICRACK_VERSION;
  result.server_version = fetched.server.version();
  result.mesh_name = fetched.mesh.name();
  result.job_name = fetched.job.name();
  result.mesh_sha256 = fetched.mesh.sha256();
  result.not_reached = fetched.job.not_reached();
  result.units = to_units(fetched.job.units());
  result.timings.mesh_seconds = fetched.mesh.mesh_seconds();
  result.timings.factorize_seconds = fetched.mesh.factorize_seconds();
  add_names(fetched.mesh, result.mesh);
  std::map<std::string, std::size_t> interfaces;
  for (const v1::InterfaceInfo& interface : fetched.mesh.interfaces()) {
    interfaces.emplace(interface.name(), result.interfaces.size());
    result.interfaces.emplace_back().name = interface.name();
  }
  if (fetched.job.has_sweep()) {
    result.sweep = to_sweep(fetched);
    result.timings.solve_seconds = result.sweep->solve_seconds;
  } else {
    result.loads = to_loads(fetched.job);
    for (std::size_t i = 0; i < result.loads.size(); ++i) {
      result.timings.solve_seconds += result.loads[i].solve_seconds;
      if (static_cast<int>(i) < fetched.job.answers_size())
        add_contact(fetched.job.answers(static_cast<int>(i)), interfaces, result.loads[i]);
    }
  }
  return results::assemble(std::move(result), views_of(fetched.mesh_block),
                           views_of(fetched.result_block));
}

}  // namespace anticrack::cli
