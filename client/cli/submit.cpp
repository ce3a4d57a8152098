// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/submit.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <exception>
#include <map>
#include <optional>
#include <utility>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/report.hpp"
#include "cli/tables.hpp"
#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "results/file.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

// Uploads forces. The server names the upload that it refuses, but the user knows the load.
void upload_forces(Session& session, const Case& the_case, v1::JobSpec& spec) {
  // One upload for each content, as loads often share a file.
  std::map<std::pair<std::filesystem::path, std::string>, std::size_t> indices;
  std::vector<const ForceFile*> files;
  for (const ForceFile& file : the_case.force_files)
    if (indices.try_emplace({file.path, file.dataset}, files.size()).second) files.push_back(&file);
  const auto place_of = [&](std::size_t index) {
    return told(*the_case.locate(fmt::format("load_cases[{}].force", files[index]->load_case)));
  };
  const auto read = [&, read_array = results::array_reader()](std::size_t index) {
    try {
      return read_array(files[index]->path, files[index]->dataset);
    } catch (const results::Error& error) {
      throw CaseError(place_of(index), error.what());
    }
  };
  std::vector<std::string> uploads;
  try {
    uploads = client::upload_arrays(session.connection(), files.size(), read, session.stop());
  } catch (const client::Error& error) {
    const auto& metadata = error.details().metadata;
    if (const auto file = metadata.find("file"); file != metadata.end()) {
      throw client::Error(error.code(), place_of(std::stoul(file->second)) + ": " + error.what(),
                          error.details());
    }
    throw;
  }
  for (const ForceFile& file : the_case.force_files) {
    spec.mutable_load_cases(file.load_case)
        ->mutable_force()
        ->mutable_array()
        ->set_upload(uploads[indices.at({file.path, file.dataset})]);
  }
}

// The mesh with its arrays, and the server.
Fetched fetch_arrays(client::Connection& connection, v1::Mesh mesh, const std::stop_token& stop) {
  Fetched fetched;
  fetched.server = client::server_info(connection, stop);
  fetched.mesh_block = client::read_mesh(connection, mesh.name(), stop);
  fetched.mesh = std::move(mesh);
  return fetched;
}

// Waits for the triangles, which are there before the operators. Null if there are none at the end.
std::shared_ptr<Fetched> fetch_meshed(Session& session, const std::string& name,
                                      const std::stop_token& end) {
  const auto meshed = [](const v1::Mesh& mesh) { return mesh.triangle_count() > 0; };
  v1::Mesh mesh = client::wait_for_mesh(session.connection(), name, {}, end, meshed);
  if (!meshed(mesh)) return nullptr;
  return std::make_shared<Fetched>(
      fetch_arrays(session.connection(), std::move(mesh), session.stop()));
}

}  // namespace

void add_case_flags(CLI::App& command, std::vector<std::string>& overrides) {
  add_value(command, "--set", overrides, "KEY=VALUE",
            "Override a key of the case, for example solver.theta=1.7 or load.opening.f=1 (an "
            "entry of a list by its name, or by its index from 0); again for more");
  const auto add = [&](const std::string& flag, const std::string& key, const std::string& type,
                       const std::string& help) {
    command
        .add_option_function<std::string>(
            flag,
            // Quoted, so that TOML takes it for a text.
            [&overrides, key](const std::string& value) {
              overrides.push_back(key + "='" + value + "'");
            },
            help + "; the same as --set " + key)
        ->type_name(type);
  };
  add("--priority", "job.priority", "{interactive,normal,bulk}", "How soon it gets its turn");
  add("--queue-timeout", "job.queue_timeout", "TIME",
      "Fail if it has not started after, e.g. 10min");
  add("--run-timeout", "job.run_timeout", "TIME", "Stop if it has not ended after, e.g. 2h");
}

void add_load_flag(CLI::App& command, std::vector<std::string>& loads) {
  add_value(command, "--load", loads, "NAME",
            "Solve this load case only, with [accuracy] on meshes of its own; again for more "
            "(default: all)");
}

client::Error in_terms_of(const Case& the_case, const client::Error& error) {
  std::string message, told_of, description;
  for (const client::FieldViolation& violation : error.details().fields) {
    const v1::CasePlace* place = the_case.locate(violation.field);
    // If two keys cause it together, the one that the case leaves out is skipped.
    if (place && violation.description == description && told_of.starts_with(place->key() + "."))
      continue;
    told_of = place ? place->key() : "";
    description = violation.description;
    message += message.empty() ? "" : "\n";
    message += (place ? told(*place) : violation.field) + ": " + violation.description;
  }
  return client::Error(error.code(), message.empty() ? error.what() : message, error.details());
}

namespace {

// Called when nothing was refused: if a case has an error, only the error is told.
void tell_notes(const Session& session, const Case& the_case) {
  // standard output may be for the name alone
  for (const std::string& note : the_case.notes)
    if (!session.globals().quiet) complain("note: " + note);
}

v1::Mesh send_mesh(Session& session, const Case& the_case, bool for_job) {
  if (the_case.mesh_file && !std::filesystem::is_regular_file(*the_case.mesh_file)) {
    const bool folder = std::filesystem::is_directory(*the_case.mesh_file);
    const v1::CasePlace& place = *the_case.locate("upload");
    throw CaseError(told(place), (place.key().empty() ? "" : the_case.mesh_file->string() + ": ") +
                                     (folder ? "is a folder" : "there is no such file") +
                                     "; name a .msh file");
  }
  return translated(the_case, [&] {
    v1::CreateMeshRequest request = the_case.mesh;
    request.set_for_job(for_job);
    if (the_case.mesh_file)
      request.set_upload(
          client::upload_mesh(session.connection(), *the_case.mesh_file, session.stop()));
    return client::create_mesh(session.connection(), request, session.stop());
  });
}

}  // namespace

v1::Mesh create_mesh(Session& session, const Case& the_case) {
  v1::Mesh mesh = send_mesh(session, the_case, false);
  tell_notes(session, the_case);
  return mesh;
}

v1::Job submit(Session& session, const Case& the_case, const std::string& request_id,
               const Prepare& prepare) {
  v1::JobSpec spec = the_case.spec;
  upload_forces(session, the_case, spec);  // first: a file that cannot be read starts nothing
  if (prepare) translated(the_case, [&] { prepare(spec); });
  spec.set_mesh(send_mesh(session, the_case, true).name());
  const v1::Job submitted = translated(the_case, [&] {
    return client::create_job(session.connection(), spec, request_id, session.stop());
  });
  tell_notes(session, the_case);
  return submitted;
}

void tell_submitted(const Session& session, const v1::Job& job) {
  if (session.globals().json) {
    print_document(to_json(job));
    return;
  }
  print_document(job.name());
  if (isatty(STDOUT_FILENO) == 1) {  // a script wants only the name
    say(session.globals(),
        "To watch it: anticrack job watch " + job.name() + session.server_option());
  }
}

results::Result fetch(Session& session, const v1::Job& job, const std::stop_token& stop,
                      Fetched* ahead) {
  client::Connection& connection = session.connection();
  Fetched fetched =
      ahead != nullptr
          ? std::move(*ahead)
          : fetch_arrays(connection, client::get_mesh(connection, mesh_of(job), stop), stop);
  if (fetched.mesh.state() != v1::Mesh::STATE_READY)
    fetched.mesh = client::get_mesh(connection, fetched.mesh.name(), stop);
  fetched.job = job;
  fetched.result_block = client::read_result(connection, job.name(), stop);
  return to_result(std::move(fetched));
}

int exit_code_of(const v1::Job& job) {
  if (job.status().state() == v1::JobStatus::STATE_SUCCEEDED) return exit_ok;
  const bool none_failed =
      job.status().state() == v1::JobStatus::STATE_NOT_CONVERGED && !job.status().has_error();
  return none_failed ? exit_not_converged : exit_job_failed;
}

void complain_of(const v1::Job& job) {
  for (const std::string& line : shortfalls(job)) complain(line);
}

void complain_of_failure(const v1::Job& job) {
  if (job.status().state() == v1::JobStatus::STATE_FAILED) complain(shortfalls(job).front());
}

AheadFuture fetch_ahead(Session& session, const v1::Job& job, const std::stop_token& end) {
  const auto fetch = [&session, end, mesh = job.spec().mesh(),
                      in_stages = job.spec().has_accuracy()]() -> std::shared_ptr<Fetched> {
    try {
      return in_stages ? nullptr : fetch_meshed(session, mesh, end);
    } catch (const std::exception&) {
      return nullptr;
    }
  };
  return std::async(std::launch::async, fetch).share();
}

}  // namespace anticrack::cli
