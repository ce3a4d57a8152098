// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/programs.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

fs::path make_program(const fs::path& folder, bool executable = true) {
  fs::create_directories(folder);
  fs::path program = folder / "anticrackd";
  std::ofstream(program) << "#!/bin/sh\n";
  fs::permissions(program, executable ? fs::perms::owner_all : fs::perms::owner_read);
  return program;
}

TEST(FindProgram, PrefersTheOneBesideTheClient) {
  const anticrack::testing::TemporaryFolder folder;
  const fs::path beside = make_program(folder / "bin");
  make_program(folder / "other");
  EXPECT_EQ(find_program("anticrackd", folder / "bin" / "anticrack", (folder / "other").string()),
            beside);
}

TEST(FindProgram, TakesTheFirstOnThePath) {
  const anticrack::testing::TemporaryFolder folder;
  const fs::path first = make_program(folder / "first");
  make_program(folder / "second");
  const std::string path =
      folder.path() + ":" + (folder / "first").string() + ":" + (folder / "second").string();
  EXPECT_EQ(find_program("anticrackd", folder / "anticrack", path), first);
}

TEST(FindProgram, PassesOverFoldersAndFilesThatAreNoPrograms) {
  const anticrack::testing::TemporaryFolder folder;
  make_program(folder / "plain", false);
  fs::create_directories(folder / "folder" / "anticrackd");
  const std::string path = (folder / "plain").string() + ":" + (folder / "folder").string();
  EXPECT_EQ(find_program("anticrackd", folder / "anticrack", path), fs::path());
  EXPECT_EQ(find_program("anticrackd", folder / "anticrack", ""), fs::path());
}

}  // namespace
}  // namespace anticrack::cli
