// SPDX-License-Identifier: GPL-3.0-or-later
//
// Meshes that nobody wants any more, by real processes: the mesher ends with the last who wants it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "client/jobs.hpp"
#include "client/meshes.hpp"
#include "service/daemon.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

using anticrack::testing::eventually;
using ::testing::HasSubstr;

/// Helper processes of a server.
int meshers_of(int server) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string pid, program, state, parent;
    if (!(file >> pid >> program >> state >> parent)) continue;
    count += parent == std::to_string(server) && program.starts_with("(anticrack-mesh") ? 1 : 0;
  }
  return count;
}

class UnwantedMesh : public ::testing::Test {
 protected:
  /// Half a minute in gmsh: triangles as small as a thin strip beside the interface are not made by
  /// halving.
  static Work long_work() {
    return work("paper-3.toml", {"mesh.preset=\"uniform\"",
                                 "geometry.boundary=[[-1,-1e-4],[1,-1e-4],[1,1],[-1,1]]"});
  }
  bool meshes(int count) {
    return eventually([&] { return meshers_of(daemon.process().id()) == count; });
  }
  v1::Mesh::State state_of(const std::string& mesh) {
    return client::get_mesh(connection, mesh).state();
  }

  Daemon daemon;
  client::Connection connection{daemon.connection()};
};

TEST_F(UnwantedMesh, StopsWithTheLastOfItsJobs) {
  Work one = long_work();
  one.mesh.set_for_job(true);
  const v1::Job first = submit(connection, one, client::make_uuid());
  const v1::Job second = submit(connection, one, client::make_uuid());
  ASSERT_TRUE(meshes(1));
  EXPECT_TRUE(eventually([&] {
    const v1::Mesh mesh = client::get_mesh(connection, first.spec().mesh());
    return mesh.state() == v1::Mesh::STATE_MESHING && !mesh.progress().doing().empty();
  }));
  EXPECT_THAT(daemon.client({"mesh", "list"}).output, HasSubstr("triangles"));
  EXPECT_THAT(daemon.client({"mesh", "show", first.spec().mesh()}).output, HasSubstr("meshing: "));
  client::cancel_job(connection, first.name());
  EXPECT_EQ(wait_for_end(connection, first.name()).status().state(),
            v1::JobStatus::STATE_CANCELLED);
  EXPECT_EQ(meshers_of(daemon.process().id()), 1) << "the other job wants it";
  client::cancel_job(connection, second.name());
  EXPECT_EQ(wait_for_end(connection, second.name()).status().state(),
            v1::JobStatus::STATE_CANCELLED);
  EXPECT_TRUE(meshes(0));
  EXPECT_EQ(state_of(first.spec().mesh()), v1::Mesh::STATE_PENDING);
  client::delete_mesh(connection, first.spec().mesh());
  EXPECT_EQ(daemon.stop(), 0);
}

TEST_F(UnwantedMesh, GoesOnForItsOwnerUntilItIsDeleted) {
  const Work one = long_work();
  const v1::Mesh mesh = client::create_mesh(connection, one.mesh);
  const v1::Job job = submit(connection, one, client::make_uuid());
  EXPECT_EQ(job.spec().mesh(), mesh.name());
  ASSERT_TRUE(meshes(1));
  client::cancel_job(connection, job.name());
  EXPECT_EQ(wait_for_end(connection, job.name()).status().state(), v1::JobStatus::STATE_CANCELLED);
  EXPECT_EQ(state_of(mesh.name()), v1::Mesh::STATE_MESHING);
  EXPECT_EQ(daemon.client({"mesh", "delete", mesh.name()}).code, 0);
  EXPECT_TRUE(meshes(0));
  EXPECT_THROW(client::get_mesh(connection, mesh.name()), client::Error);
}

TEST_F(UnwantedMesh, StopsWhenItsJobRunsOutOfTime) {
  Work one = long_work();
  one.mesh.set_for_job(true);

  one.spec.mutable_queue_timeout()->set_seconds(1);
  const v1::Job job = submit(connection, one, client::make_uuid());
  EXPECT_EQ(wait_for_end(connection, job.name()).status().state(), v1::JobStatus::STATE_FAILED);
  EXPECT_TRUE(meshes(0));
}

}  // namespace
}  // namespace anticrack::service_test
