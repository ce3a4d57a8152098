// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack mesh create | upload | list | show
#include "client/meshes.hpp"

#include <CLI/CLI.hpp>

#include <memory>

#include "cli/commands.hpp"
#include "cli/exit_codes.hpp"
#include "cli/json.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/submit.hpp"
#include "cli/text.hpp"

namespace anticrack::cli {
namespace {

struct MeshOptions {
  std::string file;
  std::string name;
  std::string title;
  std::vector<std::string> overrides;
  bool no_wait = false;
  int limit = 50;
};

std::string kind_of(v1::InterfaceKind kind) {
  switch (kind) {
    case v1::INTERFACE_KIND_GLUE:
      return "glue";
    case v1::INTERFACE_KIND_CRACK:
      return "crack";
    case v1::INTERFACE_KIND_INCLUSION:
      return "inclusion, bonded";
    case v1::INTERFACE_KIND_DELAMINATED:
      return "inclusion, delaminated";
    default:
      return "unknown";
  }
}

std::string segment_line(const v1::Mesh& mesh, const v1::InterfaceInfo::Segment& segment) {
  const bool named = segment.inclusion() >= 0 && segment.inclusion() < mesh.inclusions_size();
  return "  " + number(segment.begin()) + " to " + number(segment.end()) + ": " +
         kind_of(segment.kind()) +
         (named ? " " + sanitise(mesh.inclusions(segment.inclusion())) : "") + ", " +
         std::to_string(segment.edge_count()) + " edges\n";
}

std::string text_of(const v1::Mesh& mesh) {
  std::string text = sanitise(mesh.name()) + ": " + std::string(word(mesh.state())) + "\n";
  if (!mesh.title().empty()) {
    text += sanitise(mesh.title()) + "\n";
  }
  if (mesh.has_error()) {
    text += sanitise(mesh.error().message()) + "\n";
  }
  if (mesh.triangle_count() == 0) {
    return text;
  }
  text += std::to_string(mesh.triangle_count()) + " triangles, " +
          std::to_string(mesh.node_count()) + " nodes, smallest angle " +
          number(mesh.minimum_angle(), 3) + " degrees, meshed in " +
          number(mesh.mesh_seconds(), 3) + " s\n";
  for (const v1::SubdomainInfo& subdomain : mesh.subdomains()) {
    text += "subdomain " + sanitise(subdomain.name()) + ": " +
            std::to_string(subdomain.triangle_count()) + " triangles, " +
            std::to_string(subdomain.node_count()) + " nodes, area " + number(subdomain.area()) +
            "\n";
  }
  for (const v1::InterfaceInfo& interface : mesh.interfaces()) {
    text += "interface " + sanitise(interface.name()) + ": length " + number(interface.length()) +
            ", " + std::to_string(interface.node_count()) + " nodes\n";
    for (const auto& segment : interface.segments()) {
      text += segment_line(mesh, segment);
    }
  }
  if (mesh.theta_star() > 0) {
    text += "theta* " + number(mesh.theta_star()) + ", factors of " + bytes(mesh.operator_bytes()) +
            " made in " + number(mesh.factorize_seconds(), 3) + " s\n";
  }
  for (const std::string& warning : mesh.warnings()) {
    text += "warning: " + sanitise(warning) + "\n";
  }
  return text;
}

int show(const Globals& globals, const v1::Mesh& mesh) {
  print_document(globals.json ? to_json(mesh) : text_of(mesh));
  return exit_ok;
}

int create(const casefile::Case& the_case, bool wait, const Globals& globals) {
  Session session(globals);
  v1::Mesh mesh = create_mesh(session, the_case);
  if (wait) {
    mesh = client::wait_for_mesh(
        session.connection(), mesh.name(),
        [&](const v1::Mesh& now) {
          if (!client::settled(now.state())) {
            say(globals, now.name() + ": " + std::string(word(now.state())));
          }
        },
        session.stop());
  }
  if (mesh.state() == v1::Mesh::STATE_FAILED) {
    throw client::decode_error(mesh.error());
  }
  return show(globals, mesh);
}

int upload(const MeshOptions& options, const Globals& globals) {
  casefile::Case the_case;
  the_case.path = options.file;
  the_case.mesh_file = options.file;
  the_case.mesh.set_title(options.title);
  for (const char* field : {"upload", "header", "chunk"}) {
    the_case.spots[field] = {"", options.file, 0};
  }
  return create(the_case, !options.no_wait, globals);
}

int list(const MeshOptions& options, const Globals& globals) {
  Session session(globals);
  v1::ListMeshesRequest request;
  request.set_page_size(options.limit);
  const auto response = client::list_meshes(session.connection(), request, session.stop());
  if (globals.json) {
    print_document(to_json(response));
    return exit_ok;
  }
  std::vector<std::vector<std::string>> rows{{"mesh", "state", "triangles", "nodes", "title"}};
  for (const v1::Mesh& mesh : response.meshes()) {
    rows.push_back({sanitise(mesh.name()), std::string(word(mesh.state())),
                    std::to_string(mesh.triangle_count()), std::to_string(mesh.node_count()),
                    sanitise(mesh.title())});
  }
  print_document(table(rows, {1, 4}));
  if (!response.next_page_token().empty()) {
    say(globals, "There are more; see --limit");
  }
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

  CLI::App* create_command = group->add_subcommand("create", "Create the mesh of a case");
  create_command->add_option("CASE", options->file, "The case, a TOML file")->required();
  create_command->add_option("--set", options->overrides, "Override a key of the case")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  create_command->add_flag("--no-wait", options->no_wait, "Do not wait until it is factorised");
  create_command->footer("Example:\n  anticrack mesh create client/examples/paper.toml");
  on(create_command, [&globals](const MeshOptions& o) {
    return create(casefile::read_case(o.file, o.overrides), !o.no_wait, globals);
  });

  CLI::App* upload_command = group->add_subcommand("upload", "Create a mesh from a .msh file");
  upload_command->add_option("FILE", options->file, "MSH 2.2 or 4.1, ascii or binary")->required();
  upload_command->add_option("--title", options->title, "A title for people");
  upload_command->add_flag("--no-wait", options->no_wait, "Do not wait until it is factorised");
  upload_command->footer("Example:\n  anticrack mesh upload plate.msh");
  on(upload_command, [&globals](const MeshOptions& o) { return upload(o, globals); });

  CLI::App* list_command = group->add_subcommand("list", "List the newest meshes");
  list_command->add_option("--limit", options->limit, "At most so many")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  list_command->footer("Example:\n  anticrack mesh list --limit 10");
  on(list_command, [&globals](const MeshOptions& o) { return list(o, globals); });

  CLI::App* show_command = group->add_subcommand("show", "Show a mesh");
  show_command->add_option("MESH", options->name, "meshes/ID")->required();
  show_command->footer("Example:\n  anticrack mesh show meshes/0123456789abcdef");
  on(show_command, [&globals](const MeshOptions& o) {
    Session session(globals);
    return show(globals, client::get_mesh(session.connection(), full_name("meshes/", o.name),
                                          session.stop()));
  });
}

}  // namespace anticrack::cli
