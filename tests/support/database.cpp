// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/database.hpp"

#include <pwd.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

namespace anticrack::testing {

namespace {

const std::string programs = POSTGRESQL_PROGRAMS;

std::string run(const std::vector<std::string>& command) {
  Process process(command, {"LC_ALL=C"});
  if (process.wait() != 0) {
    throw std::runtime_error(command.back() + ": " + process.output() + process.error());
  }
  return process.output();
}

}  // namespace

void Database::give_folder() const {
  if (::geteuid() != 0) return;
  const passwd* const user = ::getpwnam("postgres");
  if (user == nullptr || ::chown(_folder.path().c_str(), user->pw_uid, user->pw_gid) != 0) {
    throw std::runtime_error("PostgreSQL does not run as root, and there is no user postgres");
  }
}

Database::Database() {
  give_folder();
  run(as_user({programs + "/initdb", "--auth=trust", "--username=test", "--encoding=UTF8",
               "--locale=C", "--no-sync", "--no-instructions", _folder.path() + "/cluster"}));
  std::ofstream(_folder.path() + "/cluster/pg_hba.conf")
      << "local all " << guarded
      << " scram-sha-256\nlocal all all trust\nlocal replication all trust\n";
  start();
  sql(std::string("CREATE ROLE ") + guarded + " LOGIN PASSWORD '" + guarded + "'");
}

Database::Database(Database* primary) {
  give_folder();
  run(as_user({programs + "/pg_basebackup", "--host=" + primary->_folder.path(), "--username=test",
               "--checkpoint=fast", "--no-sync", "--write-recovery-conf",
               "--pgdata=" + _folder.path() + "/cluster"}));
  start();
  primary->sql("ALTER SYSTEM SET synchronous_standby_names = '*'");
  primary->sql("SELECT pg_reload_conf()");
}

Database::~Database() {
  if (_server) stop();
}

std::vector<std::string> Database::as_user(std::vector<std::string> command) const {
  if (::geteuid() != 0) return command;
  std::vector<std::string> full{"/usr/bin/setpriv", "--reuid=postgres", "--regid=postgres",
                                "--clear-groups"};
  full.insert(full.end(), command.begin(), command.end());
  return full;
}

std::string Database::address(const std::string& name) const {
  return "postgresql://test@/" + name + "?host=" + _folder.path();
}

std::string Database::address_or(const Database& standby) const {
  return address() + "," + standby._folder.path();
}

std::string Database::fresh() {
  const std::string name = "made" + std::to_string(++_made);
  sql("CREATE DATABASE " + name);
  return address(name);
}

void Database::start() {
  _server = std::make_unique<Process>(
      as_user({programs + "/postgres", "-D", _folder.path() + "/cluster", "-k", _folder.path(),
               "-c", "listen_addresses=", "-c", "fsync=off", "-c", "full_page_writes=off", "-c",
               "shared_buffers=32MB", "-c", "max_connections=50", "-c", "autovacuum=off"}));
  if (!_server->wait_for_error("ready to accept"))
    throw std::runtime_error("PostgreSQL does not start: " + _server->error());
}

void Database::stop() {
  _server->signal(SIGQUIT);
  _server->wait();
  _server.reset();
}

std::string Database::sql(const std::string& text, const std::string& database) const {
  return run(
      {programs + "/psql", "-XqAt", "-v", "ON_ERROR_STOP=1", "-d", address(database), "-c", text});
}

Database& shared_database() {
  static Database one;
  return one;
}

}  // namespace anticrack::testing
