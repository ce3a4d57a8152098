// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack mesh create | upload | list | show | warm | evict | delete
#include "client/meshes.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/job_run.hpp"
#include "cli/json.hpp"
#include "cli/programs.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/resource_names.hpp"
#include "cli/submit.hpp"
#include "cli/tables.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

struct MeshOptions {
  std::string file;
  std::string name;
  std::string title;
  std::vector<std::string> overrides;
  bool no_wait = false;
  bool pin = false;
  int limit = 50;
  std::string owner;
  std::vector<std::string> figures;  ///< words for the program that draws
};

CaseFacts facts_of(const Case& the_case) {
  const auto& loads = the_case.spec.load_cases();
  const bool free = !loads.empty() && std::ranges::all_of(loads, [](const v1::LoadCase& load) {
    return load.traction().empty();
  });
  return {the_case.spec.units(), free};
}

int show_mesh(const Globals& globals, const v1::Mesh& mesh, const CaseFacts& facts = {}) {
  print_document(globals.json ? to_json(mesh) : mesh_text(mesh, facts));
  return exit_ok;
}

// Tells the mesh after a command with another purpose; with --quiet only the name of a new mesh.
int tell_mesh(const Globals& globals, const v1::Mesh& mesh, bool made,
              const CaseFacts& facts = {}) {
  if (!globals.quiet || globals.json) return show_mesh(globals, mesh, facts);
  if (made) print_document(mesh.name());
  return exit_ok;
}

v1::Mesh checked(v1::Mesh mesh) {
  if (mesh.state() == v1::Mesh::STATE_FAILED) throw client::decode_error(mesh.error());
  return mesh;
}

/// Waits until the mesh is ready or evicted; throws the error of a mesh that failed.
v1::Mesh wait_for(Session& session, const std::string& name) {
  return checked(follow_mesh(session, name));
}

int create(Session& session, const Case& the_case, const MeshOptions& options) {
  const Globals& globals = session.globals();
  const v1::Mesh mesh = create_mesh(session, the_case);
  return translated(the_case, [&] {
    checked(mesh);
    return tell_mesh(globals, options.no_wait ? mesh : wait_for(session, mesh.name()), true,
                     facts_of(the_case));
  });
}

int create_of_case(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  return create(session, read_case(session, options.file, options.overrides), options);
}

int upload(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  return create(session, msh_case(session, options.file, options.title, options.overrides),
                options);
}

/// Whether it is a .toml or .msh file, and not the name of a mesh.
bool is_file(const std::string& name) {
  const std::string extension = std::filesystem::path(name).extension();
  return extension == ".msh" || extension == ".toml";
}

Case case_of(Session& session, const MeshOptions& options) {
  return std::filesystem::path(options.name).extension() == ".msh"
             ? msh_case(session, options.name, "", options.overrides)
             : read_case(session, options.name, options.overrides);
}

/// The mesh for the program that draws it: the message, the layout of the arrays and their bytes,
/// each after its length.
std::string drawn_mesh(const v1::Mesh& mesh, const client::Block& block) {
  std::string all;
  const auto add = [&all](std::string_view part) {
    for (std::size_t i = 0, rest = part.size(); i < 8; ++i, rest >>= 8)
      all += static_cast<char>(rest & 0xFFU);
    all += part;
  };
  add(mesh.SerializeAsString());
  add(block.layout.SerializeAsString());
  add({reinterpret_cast<const char*>(block.bytes.data()), block.bytes.size()});
  return all;
}

int show_mesh(const MeshOptions& options, const Globals& globals) {
  const bool file = is_file(options.name);
  if (!file && !options.overrides.empty())
    throw UsageError("--set does not apply to a mesh on the server; name a case");
  const std::string given = file ? "" : full_name(Collection::meshes, options.name);
  Session session(globals);
  const std::optional<Case> the_case =
      file ? std::optional(case_of(session, options)) : std::nullopt;
  const std::string name = the_case ? create_mesh(session, *the_case).name() : given;
  const bool drawn = std::ranges::any_of(
      options.figures, [](const std::string& word) { return word.starts_with("--output="); });
  if (!drawn && !the_case)
    return show_mesh(globals, call_about(session, Collection::meshes, name, client::get_mesh));
  const v1::Mesh mesh =
      about(session, Collection::meshes, name, [&] { return wait_for(session, name); });
  const CaseFacts facts = the_case ? facts_of(*the_case) : CaseFacts{};
  show_mesh(globals, mesh, facts);
  if (!drawn) return exit_ok;
  const client::Block block = client::read_mesh(session.connection(), name, session.stop());
  std::vector<std::string> words = options.figures;
  words.insert(words.begin(), "mesh");
  words.push_back("--unit=" + facts.units.length());
  if (facts.free) words.emplace_back("--free");
  return run_in_python(std::move(words), drawn_mesh(mesh, block), globals);
}

int list_meshes(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  v1::ListMeshesRequest request;
  request.set_page_size(options.limit);
  request.set_owner(options.owner);
  const auto response = client::list_meshes(session.connection(), request, session.stop());
  if (globals.json) {
    print_document(to_json(response));
    return exit_ok;
  }
  std::vector<std::vector<std::string>> rows{
      {"mesh", "created", "state", "triangles", "nodes", "owner", "title"}};
  for (const v1::Mesh& mesh : response.meshes()) {
    rows.push_back({mesh.name(), clock_text(mesh.create_time().seconds()), state_text(mesh),
                    std::to_string(mesh.triangle_count()), std::to_string(mesh.node_count()),
                    mesh.owner(), mesh.title()});
  }
  drop_if_empty(rows, 5);  // without users there are no owners
  print_document(table(rows, {1, 2, 5, 6}));
  if (!response.next_page_token().empty()) say(globals, "There are more; see --limit");
  return exit_ok;
}

int warm(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  const v1::Mesh mesh =
      call_about(session, Collection::meshes, options.name, client::warm_mesh, options.pin);
  return tell_mesh(globals, options.no_wait ? mesh : wait_for(session, mesh.name()), false);
}

int evict(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  const v1::Mesh mesh = call_about(session, Collection::meshes, options.name, client::evict_mesh);
  return tell_mesh(globals, mesh, false);
}

int delete_mesh(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  call_about(session, Collection::meshes, options.name, client::delete_mesh);
  tell_deleted(globals, full_name(Collection::meshes, options.name));
  return exit_ok;
}

}  // namespace

void add_mesh(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* group = app.add_subcommand("mesh", "Meshes on the server");
  group->require_subcommand(1);
  const auto options = std::make_shared<MeshOptions>();
  const auto add = [&](const std::string& name, const std::string& help,
                       const std::string& examples,
                       int (*action)(const MeshOptions&, const Globals&)) {
    CLI::App* command = group->add_subcommand(name, help);
    command->footer("Example:\n  anticrack mesh " + name + " " + examples);
    on(*command, options, globals, chosen, action);
    return command;
  };
  const auto add_named = [&](const std::string& name, const std::string& help,
                             const std::string& flags,
                             int (*action)(const MeshOptions&, const Globals&)) {
    CLI::App* command = add(name, help, "meshes/0123456789abcdef" + flags, action);
    command->add_option("MESH", options->name, "meshes/ID")->required();
    return command;
  };
  const auto add_no_wait = [&](CLI::App* command) {
    command->add_flag("--no-wait", options->no_wait, "Do not wait until it is factorised");
  };
  const auto add_overrides = [&](CLI::App* command) {
    add_value(*command, "--set", options->overrides, "KEY=VALUE",
              "Override a key of the case, or of a .msh one of [mesh], for example "
              "mesh.groups.curve.7=crack");
  };

  CLI::App* create_command =
      add("create", "Create the mesh of a case", "paper.toml", create_of_case);
  add_case(*create_command, options->file);
  add_overrides(create_command);
  add_no_wait(create_command);

  CLI::App* upload_command = add("upload", "Create a mesh from a .msh file",
                                 "plate.msh --set mesh.preset=uniform", upload);
  add_value(*upload_command, "MESH", options->file, "FILE",
            "MSH 2.0 to 2.2 or 4.1, ascii or binary, or a mesh of FreeFEM")
      ->required();
  upload_command->add_option("--title", options->title, "A title for people");
  add_no_wait(upload_command);
  add_overrides(upload_command);

  add_list_flags(*add("list", "List the newest meshes", "--limit 10", list_meshes), "meshes",
                 options->limit, options->owner);

  CLI::App* show_command =
      add("show", "Show a mesh as the server understood it, and draw it",
          "plate.msh -o figures\n  anticrack mesh show meshes/0123456789abcdef", show_mesh);
  add_value(*show_command, "MESH", options->name, "FILE",
            "meshes/ID, or a case (.toml) or .msh file to mesh")
      ->required();
  add_figure_options(*show_command, options->figures);
  add_overrides(show_command);

  CLI::App* warm_command =
      add_named("warm", "Factorise a mesh now, so that the next job need not wait", " --pin", warm);
  warm_command->add_flag("--pin", options->pin,
                         "Keep it in memory until it is evicted (administrators)");
  add_no_wait(warm_command);
  add_named("evict", "Free the memory of a mesh; the next job factorises it again", "", evict);
  add_named("delete", "Delete a mesh that no unfinished job uses; stops its preparation", "",
            delete_mesh);
}

}  // namespace anticrack::cli
