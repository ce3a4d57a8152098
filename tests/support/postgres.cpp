// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/postgres.hpp"

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "support/eventually.hpp"

namespace anticrack::testing {
namespace {

namespace fs = std::filesystem;

/// The folder of the newest version's programs; empty: there is none.
fs::path programs() {
  fs::path newest;
  std::error_code none;
  for (const auto& version : fs::directory_iterator("/usr/lib/postgresql", none))
    if (const fs::path bin = version.path() / "bin"; fs::exists(bin / "postgres") && bin > newest)
      newest = bin;
  return newest;
}

/// PostgreSQL refuses to be root.
std::vector<std::string> as_user(std::vector<std::string> argv) {
  if (::geteuid() == 0) {
    const std::vector<std::string> other{"/usr/bin/setpriv", "--reuid=postgres", "--regid=postgres",
                                         "--clear-groups"};
    argv.insert(argv.begin(), other.begin(), other.end());
  }
  return argv;
}

std::string run(const std::vector<std::string>& argv) {
  Process process(argv);
  if (process.wait() != 0) throw std::runtime_error(argv[0] + ": " + process.error());
  std::string output = process.output();
  while (output.ends_with('\n')) output.pop_back();
  return output;
}

}  // namespace

bool Postgres::installed() { return !programs().empty(); }

Postgres::Postgres() {
  if (::geteuid() == 0) run({"/usr/bin/chown", "postgres", _folder.path()});
  run(as_user({programs() / "initdb", "-D", _folder / "data", "-A", "trust", "-U", "anticrack",
               "--no-sync", "--locale=C.UTF-8"}));
  start();
}

Postgres::~Postgres() {
  if (_server) _server->signal(SIGQUIT);
  _server.reset();
}

void Postgres::start() {
  _server = std::make_unique<Process>(
      as_user({programs() / "postgres", "-D", _folder / "data", "-k", _folder.path(), "-c",
               "listen_addresses=", "-c", "fsync=off"}));
  if (!eventually([&] {
        Process ready({programs() / "pg_isready", "-q", "-h", _folder.path()});
        return ready.wait() == 0;
      }))
    throw std::runtime_error("postgres does not start: " + _server->error());
}

std::string Postgres::new_database() {
  const std::string name = "test" + std::to_string(++_databases);
  const std::string to = "postgresql://anticrack@/";
  const std::string host = "?host=" + _folder.path();
  ask(to + "postgres" + host, "CREATE DATABASE " + name);
  return to + name + host;
}

std::string Postgres::ask(const std::string& url, const std::string& sql) const {
  return run({programs() / "psql", "-X", "-q", "-t", "-A", "-d", url, "-c", sql});
}

void Postgres::crash() {
  _server->signal(SIGQUIT);  // at once, without a checkpoint: the log is replayed at the start
  _server->wait();
  start();
}

}  // namespace anticrack::testing
