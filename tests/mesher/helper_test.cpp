// SPDX-License-Identifier: GPL-3.0-or-later
//
// The life and death of the helper process.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "mesher/msh_writer.hpp"
#include "mesher/real_helper.hpp"
#include "mesher/restrict.hpp"
#include "support/errors.hpp"
#include "support/paper_geometry.hpp"
#include "support/temporary_folder.hpp"

namespace anticrack {
namespace {

using errors::Reason;
using testing::error_of;
using ::testing::HasSubstr;

constexpr std::size_t helper_triangles = 20'000'000;

/// Takes far longer than any test waits.
mesh::MesherRequest big_request() {
  return mesh::GenerateRequest{
      mesh::plan(testing::paper_geometry(), {mesh::Preset::uniform, 0.001}, helper_triangles),
      helper_triangles};
}

mesh::MesherRequest paper_request() {
  return mesh::GenerateRequest{
      mesh::plan(testing::paper_geometry(), testing::paper_options(), helper_triangles),
      helper_triangles};
}

/// Options that leave the mesh of a file alone.
mesh::MeshOptions as_it_is() {
  mesh::MeshOptions options;
  options.preset = mesh::Preset::uniform;
  return options;
}

void expect_no_children() {
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

/// A program in the helper's place.
class Impostor {
 public:
  explicit Impostor(const std::string& script) {
    testing::save(path(), "#!/bin/sh\n" + script);
    chmod(path().c_str(), 0700);
  }
  std::string path() const { return _folder / "impostor"; }
  mesher::HelperOptions options() const {
    mesher::HelperOptions options;
    options.executable = path();
    return options;
  }

 private:
  testing::TemporaryFolder _folder;
};

std::string failure(const mesher::HelperOptions& options, const mesh::MesherRequest& request) {
  const auto error = error_of([&] { mesher::run(options, request, {}); });
  return error && error->reason() == Reason::mesher_failed ? error->what() : "";
}

TEST(Helper, IsKilledAtItsTimeLimit) {
  mesher::HelperOptions options = testing::real_helper();
  options.time_limit = std::chrono::seconds(1);
  EXPECT_THAT(failure(options, big_request()), HasSubstr("after 1 s, its time limit"));
  expect_no_children();
}

TEST(Helper, IsKilledWhenStopped) {
  std::stop_source stop;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    stop.request_stop();
  });
  const auto error =
      error_of([&] { mesher::run(testing::real_helper(), big_request(), stop.get_token()); });
  ASSERT_TRUE(error);
  EXPECT_EQ(error->reason(), Reason::cancelled);
  expect_no_children();
}

TEST(Helper, IsNotStartedWhenStoppedBefore) {
  std::stop_source stop;
  stop.request_stop();
  mesher::HelperOptions missing;
  missing.executable = "/nonexistent/anticrack-mesher";
  EXPECT_TRUE(testing::throws([&] { mesher::run(missing, paper_request(), stop.get_token()); },
                              Reason::cancelled));
}

TEST(Helper, MissingExecutableIsNamed) {
  mesher::HelperOptions missing;
  missing.executable = "/nonexistent/anticrack-mesher";
  const std::string message = failure(missing, paper_request());
  EXPECT_THAT(message, HasSubstr("\"/nonexistent/anticrack-mesher\""));
  EXPECT_THAT(message, HasSubstr("No such file"));
}

TEST(Helper, MemoryLimitIsNamed) {
  if (mesher::sanitized) GTEST_SKIP() << "the limit is left out";
  mesher::HelperOptions options = testing::real_helper();
  options.memory_limit = 64ULL << 20;
  EXPECT_THAT(failure(options, paper_request()), HasSubstr("64 MiB of memory"));
  expect_no_children();
}

TEST(Helper, CrashIsNamedBySignal) {
  EXPECT_THAT(failure(Impostor("kill -SEGV $$\n").options(), paper_request()),
              HasSubstr("crashed (SIGSEGV)"));
  EXPECT_THAT(failure(Impostor("kill -XCPU $$\n").options(), paper_request()),
              HasSubstr("SIGXCPU"));
  EXPECT_THAT(failure(Impostor("kill -SYS $$\n").options(), paper_request()),
              HasSubstr("SIGSYS: it tried a system call it may not use"));
  EXPECT_THAT(failure(Impostor("kill -KILL $$\n").options(), paper_request()),
              HasSubstr("SIGKILL"));
  EXPECT_THAT(failure(Impostor("exit 3\n").options(), paper_request()), HasSubstr("status 3"));
  expect_no_children();
}

TEST(Helper, AnswerThatMakesNoSenseIsRefused) {
  EXPECT_THAT(failure(Impostor("cat >/dev/null; echo hello\n").options(), paper_request()),
              HasSubstr("makes no sense"));
  EXPECT_THAT(failure(Impostor("cat >/dev/null\n").options(), paper_request()),
              HasSubstr("status 0 and no answer"));
}

TEST(Helper, EndlessAnswerIsCutOff) {
  const mesh::MesherRequest request =
      mesh::GenerateRequest{std::get<mesh::GenerateRequest>(paper_request()).plan, 10};
  EXPECT_THAT(failure(Impostor("exec yes\n").options(), request), HasSubstr("is longer than"));
  expect_no_children();
}

TEST(Helper, OneThatClosesItsOutputAndStaysIsKilled) {
  Impostor impostor("exec <&- >&-; sleep 1000\n");
  mesher::HelperOptions options = impostor.options();
  options.time_limit = std::chrono::seconds(1);
  EXPECT_THAT(failure(options, paper_request()), HasSubstr("time limit"));
  expect_no_children();
}

TEST(Helper, InheritsNothingButItsStandardStreams) {
  // a descriptor without close-on-exec, as a library may open one
  const int stray = dup(STDERR_FILENO);
  ASSERT_GE(stray, 3);
  Impostor impostor(
      "for fd in 3 4 5 6 7 8 9; do (eval \": >&$fd\") 2>/dev/null && exit 44; done\n"
      "test -n \"$ANTICRACK_SECRET\" && exit 45\nexit 46\n");
  setenv("ANTICRACK_SECRET", "token", 1);
  EXPECT_THAT(failure(impostor.options(), paper_request()), HasSubstr("status 46"));
  unsetenv("ANTICRACK_SECRET");
  close(stray);
}

TEST(Helper, ImportsAFile) {
  const testing::TemporaryFolder folder;
  for (const auto format : testing::all_formats) {
    const std::string path = folder / "case.msh";
    testing::save(path, testing::write_msh(testing::square_sample(), format));
    const mesh::Mesh mesh =
        mesher::run(testing::real_helper(), mesh::ImportRequest{path, as_it_is(), 100}, {});
    EXPECT_EQ(mesh.triangle_count(), 32U);
    EXPECT_TRUE(testing::throws(
        [&] {
          mesher::run(testing::real_helper(), mesh::ImportRequest{path, as_it_is(), 10}, {});
        },
        Reason::limit_exceeded));
  }
}

TEST(Helper, ReadsTheFileItWasHandedAndNeedsNoPath) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "case.msh";
  const std::string content =
      testing::write_msh(testing::square_sample(), testing::MshFormat::ascii22);
  testing::save(path, content);
  const std::string seen = folder / "seen";
  const Impostor impostor("test \"$3\" = import || exit 40\nrm " + path + "\ncat <&3 >" + seen +
                          "\nexit 41\n");
  EXPECT_THAT(failure(impostor.options(), mesh::ImportRequest{path, as_it_is(), 100}),
              HasSubstr("status 41"));
  std::ifstream copy(seen, std::ios::binary);
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>(copy), {}}), content);
}

TEST(Helper, WarningsOfAnImportArrive) {
  const testing::TemporaryFolder folder;
  auto sample = testing::square_sample();
  std::swap(sample.triangles[0].nodes[0], sample.triangles[0].nodes[1]);
  const std::string path = folder / "case.msh";
  testing::save(path, testing::write_msh(sample, testing::MshFormat::ascii22));
  EXPECT_EQ(mesher::run(testing::real_helper(), mesh::ImportRequest{path, as_it_is(), 100}, {})
                .warnings.size(),
            1U);
}

TEST(Helper, ScriptUnderAMshNameRunsNothing) {
  const testing::TemporaryFolder folder;
  const std::string trace = folder / "trace";
  const std::string evil =
      "SystemCall \"touch " + trace + "\";\nPrintf(\"x\") > \"" + trace + "\";\n";
  const std::string path = folder / "case.msh";
  for (const std::string& content :
       {evil, "\n$MeshFormat\n" + evil, "$MeshFormat2\n" + evil, "$MeshFormat\n" + evil,
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + evil}) {
    testing::save(path, content);
    EXPECT_TRUE(testing::throws(
        [&] {
          mesher::run(testing::real_helper(), mesh::ImportRequest{path, as_it_is(), 100}, {});
        },
        Reason::mesh_invalid));
    EXPECT_FALSE(std::filesystem::exists(trace));
  }
}

TEST(RequireMsh, TakesOnlyTheToken) {
  const testing::TemporaryFolder folder;
  const std::string path = folder / "case.msh";
  const auto refusal = [&](const std::string& content) {
    testing::save(path, content);
    const auto error = error_of([&] { mesher::require_msh(path); });
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_EQ(refusal("$MeshFormat\n2.2 0 8\n"), "");
  for (const char* content :
       {"$MeshFormat\r\n2.2 0 8\r\n", "\n$MeshFormat\n", "\xef\xbb\xbf$MeshFormat\n",
        "$Comments\nby hand\n$EndComments\n$MeshFormat\n", "4 2 4\n0 0 1\n", " 4  2 4 \r\n",
        "MeshVersionFormatted 2\n"}) {
    EXPECT_EQ(refusal(content), "") << content;
  }
  EXPECT_THAT(refusal(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal("$NOD\n4\n"), HasSubstr("MSH 1, which is not read; convert it: gmsh"));
  for (const char* content :
       {"$MeshFormat", "$MeshForma", "$MeshFormatX\n", "$meshformat\n", "Point(1) = {0, 0, 0};\n",
        "1 2 3 4\n", "1 2\n", "1 2 x\n", "1 -2 3\n", "1 2 3", "*Heading\n"}) {
    EXPECT_THAT(refusal(content), HasSubstr("does not begin with $MeshFormat")) << content;
  }
  EXPECT_TRUE(
      testing::throws([&] { mesher::require_msh(folder / "missing"); }, Reason::mesh_invalid));
  EXPECT_TRUE(testing::throws([&] { mesher::require_msh(folder.path()); }, Reason::mesh_invalid));
}

}  // namespace
}  // namespace anticrack
