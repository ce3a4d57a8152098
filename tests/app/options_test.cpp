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
  config.store.folder = "/data";
  config.meshes.helper.executable = "/bin/true";
  config.store.disk_budget = 101;
  config.meshes.helper.memory_limit = 102;
  config.meshes.max_triangles = 103;
  config.limits.upload_bytes = 104;
  config.limits.memory_budget_bytes = 105;
  config.jobs.event_log_bytes = 106;
  config.jobs.max_result_bytes = 107;
  config.jobs.result_budget = 108;
  config.jobs.max_job_memory = 109;
  config.meshes.max_pending = 201;
  config.meshes.max_meshes = 202;
  config.jobs.threads = 203;
  config.jobs.columns = 204;
  config.jobs.max_load_cases = 205;
  config.jobs.max_sweep_rows = 214;
  config.jobs.max_sweep_basis = 215;
  config.jobs.max_iterations = 206;
  config.jobs.max_expression_bytes = 207;
  config.jobs.max_queued_jobs = 208;
  config.jobs.max_queued_cases = 209;
  config.jobs.max_crashes = 216;
  config.jobs.max_kept_jobs = 210;
  config.limits.watchers = 211;
  config.limits.transfers = 212;
  config.limits.streams_a_client = 213;
  config.meshing_time = milliseconds(1001);
  config.jobs.queue_time = milliseconds(302);
  config.jobs.run_time = milliseconds(303);
  config.jobs.result_ttl = milliseconds(304);
  config.jobs.upload_ttl = milliseconds(305);
  return config;
}

TEST(Options, OfTheEngineAreTheConfigurations) {
  const jobs::EngineOptions options = distinct().jobs;
  EXPECT_EQ(options.event_log_bytes, 106u);
  EXPECT_EQ(options.max_result_bytes, 107u);
  EXPECT_EQ(options.result_budget, 108u);
  EXPECT_EQ(options.max_job_memory, 109u);
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
  const store::StoreOptions store = distinct().store;
  EXPECT_EQ(store.folder, "/data");
  EXPECT_EQ(store.disk_budget, 101u);
}

TEST(Options, OfTheEdgeAreTheConfigurations) {
  const rpc::ServerOptions options = server_options(distinct());
  EXPECT_EQ(options.listen, "127.0.0.1:1");
  EXPECT_EQ(options.limits.disk_budget_bytes, 101u);
  EXPECT_EQ(options.limits.mesher_memory_bytes, 102u);
  EXPECT_EQ(options.limits.mesh_triangles, 103u);
  EXPECT_EQ(options.limits.pending_meshes, 201u);
  EXPECT_EQ(options.limits.meshes, 202u);
  EXPECT_EQ(options.limits.upload_bytes, 104u);
  EXPECT_EQ(options.limits.memory_budget_bytes, 105u);
  EXPECT_EQ(options.limits.meshing_time, seconds(2));
  EXPECT_EQ(options.limits.watchers, 211);
  EXPECT_EQ(options.limits.transfers, 212);
  EXPECT_EQ(options.limits.streams_a_client, 213);
}

}  // namespace
}  // namespace anticrack::app
