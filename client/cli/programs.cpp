// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/programs.hpp"

#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <system_error>
#include <vector>

namespace anticrack::cli {

namespace fs = std::filesystem;

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

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
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

}  // namespace anticrack::cli
