// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/options.hpp"

#include <gtest/gtest.h>

namespace anticrack::app {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

/// Every value another, so that none can stand in for another.
Config distinct() {
  Config config;
  config.listen = "127.0.0.1:1";
  config.data_dir = "/data";
  config.mesher = "/bin/true";
  config.disk_budget = 101;
  config.mesher_memory = 102;
  config.mesh_triangles = 103;
  config.upload_limit = 104;
  config.memory_budget = 105;
  config.event_log = 106;
  config.result_limit = 107;
  config.result_budget = 108;
  config.queued_bytes = 109;
  config.pending_meshes = 201;
  config.kept_meshes = 202;
  config.threads = 203;
  config.columns = 204;
  config.load_cases = 205;
  config.max_sweep_rows = 214;
  config.max_sweep_basis = 215;
  config.iterations = 206;
  config.expression_bytes = 207;
  config.queued_jobs = 208;
  config.queued_cases = 209;
  config.crashes = 216;
  config.kept_jobs = 210;
  config.watchers = 211;
  config.transfers = 212;
  config.streams_a_client = 213;
  config.meshing_time = milliseconds(1001);
  config.queue_time = milliseconds(302);
  config.run_time = milliseconds(303);
  config.result_ttl = milliseconds(304);
  config.upload_ttl = milliseconds(305);
  return config;
}

TEST(Options, OfTheEngineAreTheConfigurations) {
  const jobs::EngineOptions options = engine_options(distinct());
  EXPECT_EQ(options.event_log_bytes, 106u);
  EXPECT_EQ(options.max_result_bytes, 107u);
  EXPECT_EQ(options.result_budget, 108u);
  EXPECT_EQ(options.max_queued_bytes, 109u);
  EXPECT_EQ(options.threads, 203);
  EXPECT_EQ(options.columns, 204);
  EXPECT_EQ(options.max_load_cases, 205);
  EXPECT_EQ(options.max_iterations, 206);
  EXPECT_EQ(options.max_sweep_rows, 214u);
  EXPECT_EQ(options.max_sweep_basis, 215);
  EXPECT_EQ(options.max_expression_bytes, 207u);
  EXPECT_EQ(options.max_queued_jobs, 208);
  EXPECT_EQ(options.max_queued_cases, 209);
  EXPECT_EQ(options.max_crashes, 216);
  EXPECT_EQ(options.max_kept_jobs, 210);
  EXPECT_EQ(options.queue_time, milliseconds(302));
  EXPECT_EQ(options.run_time, milliseconds(303));
  EXPECT_EQ(options.result_ttl, milliseconds(304));
  EXPECT_EQ(options.upload_ttl, milliseconds(305));
}

TEST(Options, OfMeshesAndTheStoreAreTheConfigurations) {
  const meshes::CatalogueOptions meshes = catalogue_options(distinct());
  EXPECT_EQ(meshes.helper.executable, "/bin/true");
  EXPECT_EQ(meshes.helper.time_limit, seconds(2)) << "rounded up, never to none";
  EXPECT_EQ(meshes.helper.memory_limit, 102u);
  EXPECT_EQ(meshes.max_triangles, 103u);
  EXPECT_EQ(meshes.max_pending, 201u);
  EXPECT_EQ(meshes.max_meshes, 202u);
  const store::StoreOptions store = store_options(distinct());
  EXPECT_EQ(store.folder, "/data");
  EXPECT_EQ(store.disk_budget, 101u);
}

TEST(Options, OfTheEdgeAreTheConfigurations) {
  const rpc::ServerOptions options = server_options(distinct());
  EXPECT_EQ(options.listen, "127.0.0.1:1");
  EXPECT_EQ(options.limits.mesh_triangles, 103u);
  EXPECT_EQ(options.limits.upload_bytes, 104u);
  EXPECT_EQ(options.limits.memory_budget_bytes, 105u);
  EXPECT_EQ(options.limits.meshing_time, seconds(2));
  EXPECT_EQ(options.limits.watchers, 211);
  EXPECT_EQ(options.limits.transfers, 212);
  EXPECT_EQ(options.limits.streams_a_client, 213);
}

}  // namespace
}  // namespace anticrack::app
