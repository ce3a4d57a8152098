// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack completion bash | zsh | fish
//   anticrack manual DIR
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/report.hpp"
#include "cli/session.hpp"
#include "guide/guide.hpp"
#include "output/file.hpp"

namespace anticrack::cli {
namespace {

int write_manual(const CLI::App& app, const std::filesystem::path& folder, const Globals& globals) {
  output::make_folder(folder);
  const std::vector<guide::Page> pages = guide::manual(app, 1, "anticrack " ANTICRACK_VERSION);
  for (const guide::Page& page : pages) {
    output::write_file(folder / page.file, page.text);
  }
  if (globals.json) {
    Json files = Json::array();
    for (const guide::Page& page : pages) files.push_back((folder / page.file).string());
    print_document(to_text({{"files", std::move(files)}}));
  } else {
    say(globals, fmt::format("{} pages in {}", pages.size(), folder.string()));
  }
  return exit_ok;
}

}  // namespace

void add_guide(CLI::App& app, const Globals& globals, Command& chosen) {
  using guide::Shell;
  CLI::App* group = app.add_subcommand("completion", "Print the script that completes commands");
  group->require_subcommand(1);
  const auto add = [&globals, &chosen, group](const std::string& name, Shell shell,
                                              const std::string& use) {
    CLI::App* command = group->add_subcommand(name, "Completion for " + name);
    command->footer("Example:\n  " + use);
    command->callback([&globals, &chosen, name, shell] {
      chosen = [&globals, name, shell] {
        const std::string script(guide::completion_script(shell));
        print_document(globals.json ? to_text({{"shell", name}, {"script", script}}) : script);
        return exit_ok;
      };
    });
  };
  add("bash", Shell::bash, "source <(anticrack completion bash)");
  add("zsh", Shell::zsh, "source <(anticrack completion zsh)");
  add("fish", Shell::fish, "anticrack completion fish | source");

  const auto folder = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("manual", "Write the manual pages, one per command");
  add_value(*command, "DIR", *folder, "DIR", "Folder for the pages, created if missing")
      ->required();
  command->footer("Example:\n  anticrack manual man1 && man -l man1/anticrack-run.1");
  command->callback([folder, &app, &globals, &chosen] {
    chosen = [folder, &app, &globals] { return write_manual(app, *folder, globals); };
  });
}

}  // namespace anticrack::cli
