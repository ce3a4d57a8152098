// SPDX-License-Identifier: GPL-3.0-or-later
//
// What people do every day, through the real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "service/processes.hpp"

namespace anticrack::service_test {
namespace {

using ::testing::HasSubstr;

TEST(Everyday, RunSolvesThePapersExamplesAndSavesThem) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const std::string file = (folder / "paper.h5").string();

  const Ended run = server.client({"run", example("paper.toml"), "-o", file});
  ASSERT_EQ(run.code, 0) << run.output << run.error;
  ASSERT_TRUE(std::filesystem::exists(file));

  // The numbers of the paper's mesh, from the file alone.
  const Ended show = server.client({"show", file, "--json"});
  ASSERT_EQ(show.code, 0) << show.error;
  const auto answers = parse_json(show.output).fields().at("answers").list_value();
  ASSERT_EQ(answers.values_size(), 4);
  const auto& opening = answers.values(2).struct_value().fields();
  EXPECT_EQ(opening.at("status").string_value(), "converged");
  const auto& inclusion = opening.at("inclusions").list_value().values(0).struct_value().fields();
  EXPECT_NEAR(inclusion.at("A").number_value(), 0.0863, 0.001);
  EXPECT_EQ(opening.at("contact_length").number_value(), 0.0);
  EXPECT_NEAR(opening.at("theta_star").number_value(), 1.74, 0.02);

  const Ended plot = server.client({"plot", file, "-o", folder / "figures"});
  ASSERT_EQ(plot.code, 0) << plot.error;
  int images = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "figures")) {
    EXPECT_GT(entry.file_size(), 2000U) << entry.path();
    ++images;
  }
  EXPECT_GE(images, 4 * 2);
}

TEST(Everyday, SecondJobOnAMeshFactorisesNothing) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  for (const char* name : {"paper-1.toml", "paper-3.toml"}) {
    ASSERT_EQ(server.client({"run", example(name), "-o", folder / name}).code, 0);
  }
  const v1::ServerInfo info = server.info();
  EXPECT_EQ(info.metrics().factorizations(), 1U);
  EXPECT_EQ(info.metrics().meshings(), 1U);
  EXPECT_GE(info.metrics().operator_hits(), 1U);
}

TEST(Everyday, TwoClientsOnOneMeshShareOneFactorisation) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const auto first = server.start_client({"run", example("paper-2.toml"), "-o", folder / "a.h5"});
  const auto second = server.start_client({"run", example("paper-4.toml"), "-o", folder / "b.h5"});
  EXPECT_EQ(first->wait(), 0) << first->error();
  EXPECT_EQ(second->wait(), 0) << second->error();
  EXPECT_EQ(server.info().metrics().factorizations(), 1U);
}

TEST(Everyday, SubmitWatchFetchAreThreeSeparateThings) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const Ended submit = server.client({"job", "submit", example("paper-3.toml"), "--json"});
  ASSERT_EQ(submit.code, 0) << submit.error;
  const std::string name = parse_json(submit.output).fields().at("name").string_value();
  ASSERT_THAT(name, ::testing::StartsWith("jobs/"));

  const Ended watch = server.client({"job", "watch", name});
  EXPECT_EQ(watch.code, 0) << watch.error;
  const Ended fetch = server.client({"job", "fetch", name, "-o", folder / "three.h5"});
  EXPECT_EQ(fetch.code, 0) << fetch.error;
  EXPECT_EQ(server.client({"show", folder / "three.h5"}).code, 0);
  EXPECT_THAT(server.client({"mesh", "list"}).output, HasSubstr("meshes/"));
}

TEST(Everyday, LocalNeedsNoServer) {
  const Server bystander;  // only for its client()
  const anticrack::testing::TemporaryFolder folder;
  const Ended run =
      bystander.client({"--local", "run", example("paper-1.toml"), "-o", folder / "one.h5"});
  EXPECT_EQ(run.code, 0) << run.error;
  EXPECT_EQ(bystander.info().metrics().jobs_created(), 0U);
}

TEST(Everyday, ClosingLoadIsReportedNotHidden) {
  const Server server;
  const anticrack::testing::TemporaryFolder folder;
  const std::vector<std::string> closing = {"run", example("paper-3.toml"), "--set",
                                            "load.0.f='y > 0 ? -1 : 1'", "-o"};
  auto fixed = closing;
  fixed.push_back(folder / "fixed.h5");
  const Ended refused = server.client(fixed);
  EXPECT_EQ(refused.code, 3) << refused.output << refused.error;
  EXPECT_THAT(refused.output + refused.error, HasSubstr("theta"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fixed.h5")) << "what was reached is saved";

  auto automatic = closing;
  automatic.insert(automatic.end(), {folder / "auto.h5", "--set", "solver.theta=auto", "--json"});
  const Ended run = server.client(automatic);
  ASSERT_EQ(run.code, 0) << run.error;
  const auto answers = parse_json(run.output).fields().at("answers").list_value();
  const auto& closed = answers.values(0).struct_value().fields();
  EXPECT_NEAR(closed.at("contact_length").number_value(), 1.0, 0.03) << "contact everywhere";
}

}  // namespace
}  // namespace anticrack::service_test
