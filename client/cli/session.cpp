// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/session.hpp"

#include <stdexcept>
#include <utility>

#include "cli/json.hpp"
#include "cli/terminal.hpp"
#include "cli/text.hpp"
#include "words/shown.hpp"

namespace anticrack::cli {

std::FILE* people(const Globals& globals) { return globals.json ? stderr : stdout; }

bool shows_frames(const Globals& globals) {
  return !globals.quiet && takes_frames(people(globals));
}

void say(const Globals& globals, std::string_view line) {
  if (globals.quiet) return;
  const std::string text = sanitise(line) + "\n";
  std::fwrite(text.data(), 1, text.size(), people(globals));
  std::fflush(people(globals));
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

void print_document(std::string_view document) {
  // Whatever part of it was not sanitised: a last line of defence, which leaves lines alone.
  const std::string text = words::shown(document, "\n\t");
  std::fwrite(text.data(), 1, text.size(), stdout);
  if (text.empty() || text.back() != '\n') std::fputc('\n', stdout);
  if (std::fflush(stdout) != 0) throw std::runtime_error("standard output cannot be written");
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
