// SPDX-License-Identifier: GPL-3.0-or-later
//
//   anticrack explain [KEY]
#include <CLI/CLI.hpp>

#include <chrono>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/json.hpp"
#include "cli/report.hpp"
#include "cli/text.hpp"
#include "client/jobs.hpp"

namespace anticrack::cli {
namespace {

std::string block(const v1::CaseKey& key) {
  std::string text;
  for (const std::string& name : key.names()) text += (text.empty() ? "" : ", ") + sanitise(name);
  text += "\n  " + sanitise(key.meaning()) + "\n";
  const std::vector<std::pair<const char*, std::string>> lines{{"write", key.form()},
                                                               {"unit", key.unit()},
                                                               {"default", key.if_absent()},
                                                               {"API", key.field()}};
  for (const auto& [what, value] : lines)
    if (!value.empty()) text += "  " + pad_right(what, 9) + sanitise(value) + "\n";
  return text;
}

std::string overview(const v1::ListCaseKeysResponse& found) {
  std::vector<std::vector<std::string>> rows;
  for (const v1::CaseKey& key : found.keys())
    if (key.names(0).find('.') == std::string::npos) rows.push_back({key.names(0), key.meaning()});
  return table(rows, {1}) + "\nanticrack explain KEY tells more of each, and the keys below it.\n";
}

std::string blocks(const v1::ListCaseKeysResponse& found) {
  std::string text;
  for (const v1::CaseKey& key : found.keys()) text += (text.empty() ? "" : "\n") + block(key);
  return text;
}

int explain(const std::string& name, const Globals& globals) {
  Session session(globals);
  v1::ListCaseKeysRequest request;
  request.set_name(sanitise(name));
  const v1::ListCaseKeysResponse found =
      client::list_case_keys(session.connection(), request, session.stop());
  print_document(globals.json ? to_json(found) : name.empty() ? overview(found) : blocks(found));
  return exit_ok;
}

}  // namespace

void add_explain(CLI::App& app, const Globals& globals, Command& chosen) {
  const auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("explain", "Say what a key of a case means");
  add_value(*command, "KEY", *name, "KEY",
            "As in messages and --set, such as mesh.tip_size; its end is enough, and of a "
            "table all its keys are told. Without it: what a case consists of");
  command->footer("Example:\n  anticrack --local explain tip_size");
  on(*command, name, globals, chosen, explain);
}

std::vector<std::string> case_keys(const ConnectionFlags& flags) {
  std::vector<std::string> names;
  try {
    client::ConnectionOptions options = connection_options(flags, [](const std::string&) {});
    options.first_contact = std::chrono::milliseconds(0);
    options.deadline = std::chrono::seconds(1);
    client::Connection connection(options);
    const v1::ListCaseKeysResponse found = client::list_case_keys(connection, {});
    for (const v1::CaseKey& key : found.keys())
      for (const std::string& name : key.names()) names.push_back(sanitise(name));
  } catch (const std::exception&) {
    return {};  // completion has no way to report the error
  }
  return names;
}

}  // namespace anticrack::cli
