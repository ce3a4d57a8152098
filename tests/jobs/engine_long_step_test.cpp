// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a solver thread cannot put down holds up its own owner only.
#include <gtest/gtest.h>

#include <thread>

#include "jobs/engine_support.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::eventually;
using records::JobState;
using namespace std::chrono_literals;

/// One thread. Loads that are arrays stay in the step that reads them while the door is shut, as
/// expressions stay in the one that integrates them.
class EngineLongStep : public ::testing::Test {
 protected:
  EngineLongStep() {
    backend.store->reading_upload = [this, test = std::this_thread::get_id()] {
      if (std::this_thread::get_id() != test) _door.pass({});
    };
    _door.shut();
    EngineOptions options;
    options.threads = 1;
    options.long_step = 5ms;
    engine = std::make_unique<JobEngine>(options, *backend.store, backend.catalogue);
  }
  ~EngineLongStep() override { _door.open(); }

  std::string mesh(double size, const std::string& owner) {
    const std::string id = backend.catalogue.create(Backend::definition(size), "", owner).id;
    EXPECT_TRUE(eventually([&] { return backend.catalogue.ready(id); }));
    return id;
  }
  std::string submit(const std::string& on_mesh, const std::string& owner, fem::Force force) {
    records::JobSpec spec;
    spec.mesh = on_mesh;
    spec.loads = {{"load", std::move(force), ""}};
    return engine->submit({spec, owner, ""}).id;
  }
  std::string submit_long(const std::string& on_mesh, const std::string& owner) {
    fem::Array array;
    array.upload = backend.upload(std::string(8, '\0'), owner).sha256;
    return submit(on_mesh, owner, array);
  }
  JobState solve(const std::string& on_mesh, const std::string& owner) {
    return jobs::ended(*engine, submit(on_mesh, owner, fem::Expression{"y > 0 ? 1 : -1"})).state;
  }
  bool waiting(int count) {
    return eventually([&] { return _door.waiting() == count; });
  }

  Backend backend;

 private:
  anticrack::testing::Door _door;

 protected:
  std::unique_ptr<JobEngine> engine;  // the last: it uses the others
};

TEST_F(EngineLongStep, OfOneOwnerHoldsUpNoOther) {
  const std::string modest = mesh(0.3, "modest");
  submit_long(mesh(0.2, "greedy"), "greedy");
  ASSERT_TRUE(waiting(1));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(solve(modest, "modest"), JobState::succeeded);
  EXPECT_TRUE(waiting(1)) << "all that in one step of the greedy owner";
}

TEST_F(EngineLongStep, OfSeveralOwnersHoldsUpNoOther) {
  const std::string modest = mesh(0.3, "modest");
  int count = 0;
  for (const char* owner : {"greedy", "greedier", "greediest"}) {
    submit_long(mesh(0.2 + 0.01 * count, owner), owner);
    ASSERT_TRUE(waiting(++count)) << owner;
    EXPECT_EQ(solve(modest, "modest"), JobState::succeeded);
  }
}

TEST_F(EngineLongStep, GivesItsOwnerNoSecondThread) {
  const std::string modest = mesh(0.3, "modest");
  submit_long(mesh(0.2, "greedy"), "greedy");
  ASSERT_TRUE(waiting(1));
  const std::string second = submit_long(mesh(0.21, "greedy"), "greedy");
  for (int i = 0; i < 5; ++i) EXPECT_EQ(solve(modest, "modest"), JobState::succeeded);
  EXPECT_TRUE(waiting(1));
  EXPECT_NE(engine->get(second).state, JobState::running);
}

TEST_F(EngineLongStep, WithoutNamesHoldsUpNoOtherMesh) {
  const std::string other = mesh(0.3, "");
  submit_long(mesh(0.2, ""), "");
  ASSERT_TRUE(waiting(1));
  EXPECT_EQ(solve(other, ""), JobState::succeeded);
}

}  // namespace
}  // namespace anticrack::jobs
