// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/programs.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "output/standard.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

/// The words as exec takes them; the pointers are valid as long as `words` live.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Code for Python; the first word is the folder of the package of a build, or empty.
constexpr const char* bootstrap = R"(import sys
if sys.argv[1]:
    sys.path.insert(0, sys.argv[1])
try:
    from anticrack.commands import main
except ModuleNotFoundError:
    told = ("figures and files for ParaView are made by the Python package anticrack, which " + sys.executable +
            " lacks, or a package that it takes; install python3-anticrack and python3-matplotlib, or name another "
            "Python in ANTICRACK_PYTHON")
    print("anticrack: " + told, file=sys.stderr)
    if "--json" in sys.argv:
        import json
        error = {"code": "FIGURES", "reason": "", "message": told, "fields": []}
        print(json.dumps({"error": error}, indent=2))
    sys.exit(2)
sys.exit(main(sys.argv[2:]))
)";

std::string interpreter() {
  if (const char* given = std::getenv("ANTICRACK_PYTHON"); given != nullptr && *given != '\0')
    return given;
  constexpr const char* of_debian = "/usr/bin/python3";  // the one of Debian's packages
  return access(of_debian, X_OK) == 0 ? of_debian : find_program("python3").string();
}

/// The command line of a command of the Python package.
std::vector<std::string> in_python(std::vector<std::string> words, const Globals& globals) {
  const std::string python = interpreter();
  if (python.empty())
    throw FiguresError(
        "figures and files for ParaView are made in Python, and there is no python3; install "
        "python3-anticrack");
  const fs::path built = this_program().parent_path().parent_path() / "python";
  std::error_code error;
  const bool has_package = fs::exists(built / "anticrack" / "commands.py", error);
  words.insert(words.begin(), {python, "-P", "-c", bootstrap, has_package ? built.string() : ""});
  // One failure of standard output is told once.
  if (globals.quiet || output::print_failure() != 0) words.emplace(words.begin() + 6, "--quiet");
  return words;
}

/// The exit code of a process; 128 and more if it died by a signal.
int code_of(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR)
      throw FiguresError("cannot wait for Python: " + std::generic_category().message(errno));
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

fs::path this_program() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

fs::path find_program(const std::string& name, const fs::path& executable,
                      const std::string& search_path) {
  std::vector<fs::path> folders{executable.parent_path()};
  std::istringstream path(search_path);
  for (std::string folder; std::getline(path, folder, ':');)
    folders.emplace_back(folder.empty() ? "." : folder);
  for (const fs::path& folder : folders) {
    fs::path candidate = folder / name;
    std::error_code error;
    if (fs::is_regular_file(candidate, error) && access(candidate.c_str(), X_OK) == 0)
      return candidate;
  }
  return {};
}

fs::path find_program(const std::string& name) {
  const char* search_path = std::getenv("PATH");
  return find_program(name, this_program(), search_path == nullptr ? "" : search_path);
}

pid_t spawn(std::vector<std::string> words, std::span<const int> descriptors,
            char* const* environment, short flags, int& error) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (std::size_t i = 0; i < descriptors.size(); ++i)
    posix_spawn_file_actions_adddup2(&actions, descriptors[i], static_cast<int>(i));
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(
      &attributes, static_cast<short>(POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | flags));
  pid_t process = -1;
  error = posix_spawn(&process, words[0].c_str(), &actions, &attributes, pointers_to(words).data(),
                      environment);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return process;
}

fs::path external_command(const std::string& name) {
  const bool is_name = !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  return is_name && name[0] != '-' ? find_program("anticrack-" + name) : fs::path{};
}

void become(std::vector<std::string> words) {
  execv(words[0].c_str(), pointers_to(words).data());
  throw FiguresError("cannot start " + words[0] + ": " + std::generic_category().message(errno));
}

void become_python(std::vector<std::string> words, const Globals& globals) {
  if (globals.json) words.insert(words.begin() + 1, "--json");
  become(in_python(std::move(words), globals));
}

int run_in_python(std::vector<std::string> words, std::string_view input, const Globals& globals) {
  words = in_python(std::move(words), globals);
  const int in = memfd_create("mesh", MFD_CLOEXEC);
  int error = in < 0 ? errno : output::write_all(in, std::as_bytes(std::span(input)));
  pid_t process = -1;
  if (error == 0) {
    lseek(in, 0, SEEK_SET);
    const int descriptors[] = {in, fileno(people(globals))};
    process = spawn(words, descriptors, environ, 0, error);
  }
  close(in);
  if (error != 0)
    throw FiguresError("cannot start " + words[0] + ": " + std::generic_category().message(error));
  return code_of(process);
}

}  // namespace anticrack::cli
