// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/server_service.hpp"

#include <array>

#include "api/translations.hpp"
#include "jobs/job_engine.hpp"
#include "meshes/mesh_catalogue.hpp"
#include "operators/operator_cache.hpp"
#include "rpc/unary.hpp"
#include "rpc/version.hpp"

namespace anticrack::rpc {
namespace {

constexpr std::array features{
    "accuracy",
    "active_set",
    "batching",
    "boundary_value",
    "cases",
    "durable",
    "fields",
    "force.array",
    "force.constant",
    "force.expression",
    "force.per_region",
    "inclusion_forces",
    "inclusion_moments",
    "mass.consistent",
    "mass.lumped",
    "mesh.align",
    "mesh.coarse",
    "mesh.delete",
    "mesh.evict",
    "mesh.fixed",
    "mesh.free",
    "mesh.geometry",
    "mesh.graded",
    "mesh.groups",
    "mesh.holes",
    "mesh.lines",
    "mesh.msh",
    "mesh.neumann",
    "mesh.paper",
    "mesh.sides",
    "mesh.tension",
    "mesh.tension_law",
    "mesh.tilt",
    "mesh.uniform",
    "mesh.warm",
    "point_forces",
    "priority",
    "sweep",
    "sweep.bounds",
    "sweep.tips",
    "timeouts",
    "traction",
    "units",
    "uzawa",
    "uzawa.kkt_tolerance",
    "uzawa.theta_auto",
};

v1::ServerLimits to_message(const Limits& limits, const jobs::EngineOptions& engine) {
  v1::ServerLimits to;
  to.set_upload_bytes(limits.upload_bytes);
  to.set_mesh_triangles(limits.mesh_triangles);
  to.set_memory_budget_bytes(limits.memory_budget_bytes);
  to.set_load_cases(engine.max_load_cases);
  to.set_iterations(engine.max_iterations);
  to.set_expression_bytes(static_cast<std::uint32_t>(engine.max_expression_bytes));
  to.set_queued_jobs(engine.max_queued_jobs);
  to.set_kept_jobs(engine.max_kept_jobs);
  to.set_watchers(limits.watchers);
  to.set_transfers(limits.transfers);
  to.set_streams_a_client(limits.streams_a_client);
  to.set_queued_cases(engine.max_queued_cases);
  to.set_queued_bytes(engine.max_job_memory);
  *to.mutable_queue_time() = api::message<std::chrono::nanoseconds>(engine.queue_time);
  *to.mutable_run_time() = api::message<std::chrono::nanoseconds>(engine.run_time);
  if (engine.result_ttl.count() > 0)
    *to.mutable_result_ttl() = api::message<std::chrono::nanoseconds>(engine.result_ttl);
  to.set_result_bytes(engine.max_result_bytes);
  to.set_meshes(static_cast<std::int32_t>(limits.meshes));
  to.set_pending_meshes(static_cast<std::int32_t>(limits.pending_meshes));
  if (limits.disk_budget_bytes > 0) to.set_disk_budget_bytes(limits.disk_budget_bytes);
  to.set_mesher_memory_bytes(limits.mesher_memory_bytes);
  to.set_message_bytes(max_message_bytes);
  to.set_event_log_bytes(engine.event_log_bytes);
  to.set_sweep_rows(engine.max_sweep_rows);
  to.set_sweep_basis(engine.max_sweep_basis);
  *to.mutable_meshing_time() = api::message<std::chrono::nanoseconds>(limits.meshing_time);
  return to;
}

v1::ServerMetrics to_message(const jobs::EngineMetrics& engine,
                             const operators::CacheMetrics& cache) {
  v1::ServerMetrics to;
  to.set_factorizations(cache.factorizations);
  to.set_operator_hits(cache.hits);
  to.set_operator_joins(cache.joins);
  to.set_operator_evictions(cache.evictions);
  to.set_operator_bytes(cache.bytes);
  to.set_jobs_created(engine.jobs_created);
  to.set_jobs_ended(engine.jobs_ended);
  to.set_load_cases_ended(engine.load_cases_ended);
  to.set_iterations(engine.iterations);
  to.set_jobs_queued(engine.jobs_queued);
  to.set_jobs_running(engine.jobs_running);
  return to;
}

}  // namespace

ServerService::ServerService(const Edge& edge, const Security& security)
    : _edge(edge), _features(features.begin(), features.end()) {
  // Features that are configured, besides those that all servers of this version have.
  if (security.tls) _features.emplace_back("tls");
  if (security.tls && !security.tls->client_roots.empty()) _features.emplace_back("tls.mutual");
  if (!security.tokens.empty()) _features.emplace_back("tokens");
}

Unary* ServerService::GetServerInfo(Context* context, const v1::GetServerInfoRequest* request,
                                    v1::ServerInfo* response) {
  return answer(_edge, context, *request, [&](const access::Identity&) {
    response->set_version(version());
    response->set_build(build());
    *response->mutable_start_time() = api::message(_start);
    const Backend& backend = _edge.backend;
    const jobs::EngineOptions& engine = backend.engine.options();
    response->set_threads(engine.threads);
    *response->mutable_limits() = to_message(_edge.limits, engine);
    *response->mutable_metrics() = to_message(backend.engine.metrics(), backend.cache.metrics());
    response->mutable_metrics()->set_meshings(backend.catalogue.meshings());
    response->mutable_metrics()->set_watchers(_edge.hub.counts().watchers);
    response->mutable_features()->Add(_features.begin(), _features.end());
  });
}

}  // namespace anticrack::rpc
