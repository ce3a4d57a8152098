// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/session.hpp"

#include <utility>

#include "cli/json.hpp"
#include "cli/report.hpp"
#include "cli/terminal.hpp"
#include "cli/text.hpp"
#include "output/file.hpp"
#include "output/standard.hpp"
#include "words/shown.hpp"

namespace anticrack::cli {
namespace {

std::string with_newline(std::string_view text) {
  return std::string(text) + (text.empty() || text.back() != '\n' ? "\n" : "");
}

void print_to(std::FILE* stream, std::string_view text) {
  if (stream == stdout) return output::print(text);
  std::fwrite(text.data(), 1, text.size(), stream);
  std::fflush(stream);
}

}  // namespace

Globals with_outputs(const Globals& globals, std::initializer_list<std::string> paths) {
  Globals own = globals;
  for (const std::string& path : paths) {
    if (path.empty() || !output::target_of(path).is_standard_output()) continue;
    if (own.output_taken || own.json) {
      throw UsageError(path + ": standard output is already that of " +
                       (own.json ? "--json" : "another file") + "; name a file");
    }
    own.output_taken = true;
  }
  return own;
}

std::FILE* people(const Globals& globals) {
  return globals.json || globals.output_taken ? stderr : stdout;
}

bool shows_frames(const Globals& globals) {
  return !globals.quiet && takes_frames(people(globals));
}

void say(const Globals& globals, std::string_view line) {
  if (globals.quiet) return;
  print_to(people(globals), sanitise(line) + "\n");
}

void say_always(const Globals& globals, std::string_view line) {
  if (globals.quiet)
    complain(line);
  else
    say(globals, line);
}

void complain(std::string_view line) {
  std::fprintf(stderr, "anticrack: %s\n", sanitise(line).c_str());
}

// Sanitises whatever was not sanitised before, as a last defence; line breaks stay.
void print_document(std::string_view text) {
  output::print(with_newline(words::shown(text, "\n\t")));
}

void print_answer(const Globals& globals, std::string_view text) {
  if (!globals.output_taken || !globals.quiet)
    print_to(people(globals), with_newline(words::shown(text, "\n\t")));
}

void tell_deleted(const Globals& globals, const std::string& name) {
  if (globals.json)
    print_document(to_text({{"deleted", name}}));
  else
    say(globals, name + ": deleted");
}

Session::Session(const Globals& globals) : _globals(globals) {
  const auto tell = [this](const std::string& message) { notice(message); };
  if (globals.local) {
    _local.emplace(_signals.first());
    client::ConnectionOptions options;
    options.address = _local->address();
    options.lost = [this] { _local->require_alive(); };
    options.notice = tell;
    _connection.emplace(std::move(options));
  } else {
    _connection.emplace(connection_options(globals.connection, tell));
  }
}

std::string Session::server_option() const { return as_flags(_globals.connection); }

void Session::notice(const std::string& message) {
  const std::lock_guard lock(_mutex);
  if (_listener) {
    _listener(message);
    return;
  }
  if (message != _last_notice && !_globals.quiet) complain(message);
  _last_notice = message;
}

}  // namespace anticrack::cli
