// SPDX-License-Identifier: GPL-3.0-or-later
//
// Large meshes hold up no smaller one, whatever step they are at.
#include <gtest/gtest.h>

#include <future>
#include <mutex>
#include <string>
#include <vector>

#include "meshes/size_class.hpp"
#include "support/backend.hpp"
#include "support/errors.hpp"
#include "support/eventually.hpp"

namespace anticrack::meshes {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::BackendOptions;
using anticrack::testing::eventually;
using anticrack::testing::TemporaryFolder;
using records::MeshState;

TEST(SizeClass, IsAFactorOfFourAndAllSmallMeshesAreOne) {
  EXPECT_EQ(size_class(0), size_class(4095));
  EXPECT_LT(size_class(4095), size_class(4096));
  EXPECT_EQ(size_class(4096), size_class(16'383));
  EXPECT_LT(size_class(16'383), size_class(16'384));
  EXPECT_EQ(size_class(1'048'576), size_class(4'000'000));
}

class Sizes : public ::testing::Test {
 protected:
  static constexpr std::size_t large_triangles = 5000;
  /// Three meshes of about 9,000 triangles, more than are factorised at a time, in background.
  std::vector<std::string> create_large() {
    return {backend.create(0.032), backend.create(0.033), backend.create(0.034)};
  }

  Backend backend;
};

TEST_F(Sizes, ASmallMeshIsReadyWhileLargeOnesAreFactorised) {
  backend.kept_out = large_triangles;
  backend.door.shut();
  const std::vector<std::string> large = create_large();
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 2; }));
  const std::string small = backend.create(0.2);
  EXPECT_TRUE(backend.reaches(small, MeshState::ready));
  for (const std::string& id : large) {
    EXPECT_NE(backend.state(id), MeshState::ready);
  }
  EXPECT_EQ(backend.door.waiting(), 2);  // no more of a size at a time
  backend.door.open();
  for (const std::string& id : large) {
    EXPECT_TRUE(backend.reaches(id, MeshState::ready));
  }
}

TEST_F(Sizes, ACallerGetsASmallMeshThatWasEvictedWhileLargeOnesAreFactorised) {
  const std::string small = backend.create(0.2);
  ASSERT_TRUE(backend.reaches(small, MeshState::ready));
  backend.catalogue.evict(small);
  backend.kept_out = large_triangles;
  backend.door.shut();
  const std::vector<std::string> large = create_large();
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 2; }));
  EXPECT_NE(backend.prepare(small), nullptr);
  EXPECT_EQ(backend.door.waiting(), 2);
  backend.door.open();
}

TEST(SizesMeshing, ASmallMeshIsMeshedWhileTheMesherHasLargeOnes) {
  BackendOptions options;
  options.mesher_hangs = true;  // with every mesh: what counts is that it is begun
  Backend backend(options);
  backend.create(0.01);
  backend.create(0.0105);
  ASSERT_TRUE(eventually([&] { return backend.catalogue.meshings() == 2; }));
  const std::string third = backend.create(0.011);
  const std::string small = backend.create(0.2);
  EXPECT_TRUE(backend.reaches(small, MeshState::meshing));
  EXPECT_EQ(backend.state(third), MeshState::pending);
  EXPECT_TRUE(eventually([&] { return backend.catalogue.meshings() == 3U; }));
}

TEST(SizesMeshing, ASmallMeshIsMeshedFirstThoughLargeOnesWaitedWhenTheServerStarted) {
  const TemporaryFolder folder;
  BackendOptions options;
  options.data_folder = (folder / "data").string();
  options.mesher_hangs = true;
  std::string small;
  {
    Backend backend(options);
    for (const double size : {0.01, 0.0105, 0.011}) {
      backend.create(size);
    }
    small = backend.create(0.2);
  }
  Backend backend(options);
  EXPECT_TRUE(backend.reaches(small, MeshState::meshing));
  EXPECT_TRUE(eventually([&] { return backend.catalogue.meshings() == 3U; }));
}

TEST_F(Sizes, AMeshIsReadyWhileThoseOfAnotherOwnerAreMade) {
  const auto create = [&](double size, const std::string& owner) {
    return backend.catalogue.create(Backend::definition(size), "", owner).id;
  };
  backend.door.shut();
  for (const double size : {0.1, 0.11, 0.125, 0.14, 0.16}) create(size, "greedy");
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 2; }));
  const std::string modest = create(0.2, "modest");
  // Its place does not depend on theirs.
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 3; }));
  create(0.25, "modest");
  const std::string third = create(0.3, "third");
  ASSERT_TRUE(eventually([&] { return backend.door.waiting() == 4; }));
  EXPECT_TRUE(backend.reaches(third, MeshState::factorizing))
      << "before the second one of the modest owner";
  const std::string last = create(0.4, "fourth");
  backend.door.open();
  for (const std::string& id : {modest, third, last})
    EXPECT_TRUE(backend.reaches(id, MeshState::ready));
}

TEST_F(Sizes, OwnersTakeTurnsInTheQueue) {
  std::vector<std::string> order;
  std::mutex mutex;
  BackendOptions options;
  options.meshed = [&](const records::MeshRecord& mesh) {
    const std::lock_guard lock(mutex);
    order.push_back(mesh.owner);
  };
  Backend one(options);
  one.door.shut();
  const auto create = [&](double size, const std::string& owner) {
    one.catalogue.create(Backend::definition(size), "", owner);
  };
  for (const double size : {0.1, 0.11, 0.125, 0.14, 0.16}) create(size, "greedy");
  ASSERT_TRUE(eventually([&] { return one.door.waiting() == 2; }));
  for (const double size : {0.2, 0.25}) create(size, "modest");
  ASSERT_TRUE(eventually([&] { return one.door.waiting() == 3; }));
  one.door.open();
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard lock(mutex);
    return order.size() == 7;
  }));
  const std::lock_guard lock(mutex);
  EXPECT_NE(order.back(), "modest") << "though they came last";
}

}  // namespace
}  // namespace anticrack::meshes
