// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.hpp"

#include <CLI/CLI.hpp>

namespace anticrack::app {

void describe(CLI::App& parser, CommandLine& result, const std::string& version) {
  const Config defaults;
  parser.name("anticrackd");
  parser.description("Solves membranes with cracks and thin rigid inclusions, over gRPC.");
  parser.footer(
      "Every flag is also a key of the file, e.g. memory-budget = \"2GiB\"; flags take "
      "precedence.\n\n"
      "Example:\n  anticrackd --listen 127.0.0.1:0 --data-dir data --memory-budget 2GiB");
  parser.set_version_flag("--version", "anticrackd " + version);
  parser.add_option("--config", result.config_file, "TOML file with any of the keys below")
      ->type_name("FILE");
  CLI::Option* own =
      parser.add_flag("--private", result.is_private,
                      "For one client, which starts it: lives in a temporary folder (TMPDIR) "
                      "unless told otherwise, "
                      "and ends, and removes the folder, when its standard input ends");
  parser.add_flag("--check-config", result.check_config,
                  "Print the configuration in effect, check the files it names and stop; "
                  "exit code 2 if something is wrong");
  CLI::Option* check = parser.add_flag("--check-store", result.check_store,
                                       "Check every record and file of the data folder, or of "
                                       "the database of --store, and stop; on a folder no server "
                                       "may be running; exit code 3 if something is wrong");
  check->excludes(own);
  parser
      .add_flag("--repair", result.repair,
                "Move what --check-store finds wrong to a folder set-aside-N in the data folder")
      ->needs(check);
  parser
      .add_option("--backup", result.backup,
                  "Copy the data folder, of which a server may be running, to this new folder and "
                  "stop; files are hard links where the file system allows it")
      ->type_name("DIR")
      ->excludes(check)
      ->excludes(own);
  CLI::Option* copy = parser.add_flag(
      "--copy-store", result.copy_store,
      "Copy all of the data folder, on which no server may be running, to the empty database of "
      "--store, read it there again and stop; all or nothing");
  copy->excludes(check)->excludes(own);
  parser.add_flag("--dry-run", result.dry_run, "Only say what --copy-store would copy")
      ->needs(copy);
  for (const Key& key : keys()) {
    const std::string flag = "--" + key.name;
    const auto set = [&result, name = key.name, flag](const std::string& value) {
      result.settings.push_back({name, value, flag});
    };
    if (key.type == KeyType::flag) {
      parser.add_flag_callback(
          flag, [set] { set("true"); }, key.help);
      continue;
    }
    CLI::Option* option = parser.add_option_function<std::string>(flag, set, key.help);
    option->type_name(key.placeholder);
    const std::string fallback = key.get(defaults);
    if (!fallback.empty() && fallback != "0") option->default_str(fallback);
  }
}

CommandLine parse_command_line(int argc, const char* const* argv, const std::string& version) {
  CommandLine result;
  CLI::App parser;
  describe(parser, result, version);
  try {
    parser.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    result.text = parser.help();
  } catch (const CLI::CallForVersion& call) {
    result.text = std::string(call.what()) + "\n";
  } catch (const CLI::ParseError& error) {
    throw ConfigError(std::string(error.what()) + " (see anticrackd --help)");
  }
  return result;
}

}  // namespace anticrack::app
