// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack mesh create | upload | list | show | warm | evict | delete
#include "client/meshes.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/exit_codes.hpp"
#include "cli/figure_options.hpp"
#include "cli/follow_mesh.hpp"
#include "cli/json.hpp"
#include "cli/mesh_text.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/resource_names.hpp"
#include "cli/submit.hpp"
#include "cli/text.hpp"
#include "cli/to_result.hpp"
#include "figures/mesh_figure.hpp"

namespace anticrack::cli {
namespace {

struct MeshOptions {
  std::string file;
  std::string name;
  std::string title;
  std::string folder;
  std::vector<std::string> overrides;
  bool no_wait = false;
  bool pin = false;
  int limit = 50;
  figures::Options figures;
};

int show_mesh(const Globals& globals, const v1::Mesh& mesh) {
  print_document(globals.json ? to_json(mesh) : mesh_text(mesh));
  return exit_ok;
}

v1::Mesh get_mesh(Session& session, const std::string& name) {
  return about(session, Collection::meshes, name,
               [&] { return client::get_mesh(session.connection(), name, session.stop()); });
}

/// Waits until the server is done with it; throws what it failed of.
v1::Mesh wait_for(Session& session, const std::string& name) {
  v1::Mesh mesh = follow_mesh(session, name);
  if (mesh.state() == v1::Mesh::STATE_FAILED) throw client::decode_error(mesh.error());
  return mesh;
}

int create(const casefile::Case& the_case, bool wait, const Globals& globals) {
  Session session(globals);
  const v1::Mesh mesh = create_mesh(session, the_case);
  return translated(the_case, [&] {
    if (mesh.state() == v1::Mesh::STATE_FAILED) throw client::decode_error(mesh.error());
    return show_mesh(globals, wait ? wait_for(session, mesh.name()) : mesh);
  });
}

int upload(const MeshOptions& options, const Globals& globals) {
  return create(casefile::mesh_file_case(options.file, options.title, options.overrides),
                !options.no_wait, globals);
}

/// The case of a .toml or .msh file; empty for the name of a mesh.
std::optional<casefile::Case> case_of(const MeshOptions& options) {
  const std::string extension = std::filesystem::path(options.name).extension();
  if (extension == ".msh") return casefile::mesh_file_case(options.name, "", options.overrides);
  if (extension == ".toml") return casefile::read_case(options.name, options.overrides);
  if (!options.overrides.empty()) {
    throw UsageError("--set means nothing for a mesh on the server; name a case");
  }
  return std::nullopt;
}

int show_mesh(const MeshOptions& options, const Globals& globals) {
  const auto the_case = case_of(options);
  const std::string given = the_case ? "" : full_name(Collection::meshes, options.name);
  Session session(globals);
  const std::string name = the_case ? create_mesh(session, *the_case).name() : given;
  if (options.folder.empty() && !the_case) return show_mesh(globals, get_mesh(session, name));
  const v1::Mesh mesh =
      about(session, Collection::meshes, name, [&] { return wait_for(session, name); });
  show_mesh(globals, mesh);
  if (options.folder.empty()) return exit_ok;
  const client::Block block = client::read_mesh(session.connection(), name, session.stop());
  const std::string stem = name.substr(std::string("meshes/").size());
  const figures::Drawn drawn = figures::draw_mesh(to_mesh_plan(mesh, block), "mesh-" + stem,
                                                  options.folder, options.figures);
  for (const auto& file : drawn.files) say(globals, file.string());
  for (const std::string& note : drawn.notes) say(globals, note);
  return exit_ok;
}

int list_meshes(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  v1::ListMeshesRequest request;
  request.set_page_size(options.limit);
  const auto response = client::list_meshes(session.connection(), request, session.stop());
  if (globals.json) {
    print_document(to_json(response));
    return exit_ok;
  }
  std::vector<std::vector<std::string>> rows{
      {"mesh", "created", "state", "triangles", "nodes", "title"}};
  for (const v1::Mesh& mesh : response.meshes()) {
    rows.push_back({sanitise(mesh.name()), clock_text(mesh.create_time().seconds()),
                    std::string(word(mesh.state())), std::to_string(mesh.triangle_count()),
                    std::to_string(mesh.node_count()), sanitise(mesh.title())});
  }
  print_document(table(rows, {1, 2, 5}));
  if (!response.next_page_token().empty()) say(globals, "There are more; see --limit");
  return exit_ok;
}

int warm(const MeshOptions& options, const Globals& globals) {
  const std::string name = full_name(Collection::meshes, options.name);
  Session session(globals);
  const v1::Mesh mesh = about(session, Collection::meshes, name, [&] {
    return client::warm_mesh(session.connection(), name, options.pin, session.stop());
  });
  return show_mesh(globals, options.no_wait ? mesh : wait_for(session, mesh.name()));
}

int evict(const MeshOptions& options, const Globals& globals) {
  const std::string name = full_name(Collection::meshes, options.name);
  Session session(globals);
  return show_mesh(globals, about(session, Collection::meshes, name, [&] {
                     return client::evict_mesh(session.connection(), name, session.stop());
                   }));
}

int delete_mesh(const MeshOptions& options, const Globals& globals) {
  const std::string name = full_name(Collection::meshes, options.name);
  Session session(globals);
  about(session, Collection::meshes, name,
        [&] { client::delete_mesh(session.connection(), name, session.stop()); });
  tell_deleted(globals, name);
  return exit_ok;
}

}  // namespace

void add_mesh(CLI::App& app, const Globals& globals, Command& chosen) {
  CLI::App* group = app.add_subcommand("mesh", "Meshes on the server");
  group->require_subcommand(1);
  const auto options = std::make_shared<MeshOptions>();
  const auto on = [&](CLI::App* command, const std::function<int(const MeshOptions&)>& action) {
    command->callback(
        [options, action, &chosen] { chosen = [options, action] { return action(*options); }; });
  };

  const auto add_overrides = [&](CLI::App* command) {
    command
        ->add_option("--set", options->overrides,
                     "Override a key of the case; of a .msh one of [mesh], for example "
                     "mesh.groups.curve.7=crack")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
  };

  CLI::App* create_command = group->add_subcommand("create", "Create the mesh of a case");
  create_command->add_option("CASE", options->file, "The case, a TOML file")
      ->required()
      ->type_name("FILE");
  add_overrides(create_command);
  create_command->add_flag("--no-wait", options->no_wait, "Do not wait until it is factorised");
  create_command->footer("Example:\n  anticrack mesh create paper.toml");
  on(create_command, [&globals](const MeshOptions& o) {
    return create(casefile::read_case(o.file, o.overrides), !o.no_wait, globals);
  });

  CLI::App* upload_command = group->add_subcommand("upload", "Create a mesh from a .msh file");
  upload_command->add_option("MESH", options->file, "MSH 2.2 or 4.1, ascii or binary")
      ->required()
      ->type_name("FILE");
  upload_command->add_option("--title", options->title, "A title for people");
  upload_command->add_flag("--no-wait", options->no_wait, "Do not wait until it is factorised");
  add_overrides(upload_command);
  upload_command->footer("Example:\n  anticrack mesh upload plate.msh --set mesh.preset=uniform");
  on(upload_command, [&globals](const MeshOptions& o) { return upload(o, globals); });

  CLI::App* list_command = group->add_subcommand("list", "List the newest meshes");
  list_command->add_option("--limit", options->limit, "At most so many, from 1 to 1000")
      ->check(CLI::Range(1, 1000).description(""))
      ->type_name("COUNT")
      ->capture_default_str();
  list_command->footer("Example:\n  anticrack mesh list --limit 10");
  on(list_command, [&globals](const MeshOptions& o) { return list_meshes(o, globals); });

  CLI::App* show_command =
      group->add_subcommand("show", "Show a mesh as the server understood it, and draw it");
  show_command
      ->add_option("MESH", options->name,
                   "meshes/ID, or a case (.toml) or .msh file to make the mesh of")
      ->required()
      ->type_name("FILE");
  show_command->add_option("-o,--output", options->folder, "Folder to draw it into")
      ->type_name("DIR");
  add_figure_options(*show_command, options->figures);
  add_overrides(show_command);
  show_command->footer(
      "Example:\n  anticrack mesh show plate.msh -o figures\n"
      "  anticrack mesh show meshes/0123456789abcdef");
  on(show_command, [&globals](const MeshOptions& o) { return show_mesh(o, globals); });

  const auto add_named = [&](const std::string& name, const std::string& help,
                             const std::string& example, const auto& action) {
    CLI::App* command = group->add_subcommand(name, help);
    command->add_option("MESH", options->name, "meshes/ID")->required();
    command->footer("Example:\n  anticrack mesh " + name + " meshes/0123456789abcdef" + example);
    on(command, [&globals, action](const MeshOptions& o) { return action(o, globals); });
    return command;
  };
  CLI::App* warm_command =
      add_named("warm", "Factorise a mesh now, so that the next job need not wait", " --pin", warm);
  warm_command->add_flag("--pin", options->pin,
                         "Keep it in memory until it is evicted (administrators)");
  warm_command->add_flag("--no-wait", options->no_wait, "Do not wait until it is factorised");
  add_named("evict", "Free the memory of a mesh; the next job factorises again", "", evict);
  add_named("delete", "Delete a mesh that no unfinished job uses", "", delete_mesh);
}

}  // namespace anticrack::cli
