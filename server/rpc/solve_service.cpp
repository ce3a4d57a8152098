// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/solve_service.hpp"

#include <algorithm>
#include <memory>

#include "api/names.hpp"
#include "api/requests.hpp"
#include "jobs/check.hpp"
#include "jobs/job_engine.hpp"
#include "records/job_record.hpp"
#include "rpc/block_feed.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/pages.hpp"
#include "rpc/sweep_upload.hpp"
#include "rpc/unary.hpp"
#include "rpc/visible.hpp"
#include "rpc/watch_feed.hpp"
#include "rpc/write_stream.hpp"

namespace anticrack::rpc {

using access::Identity;

Unary* SolveService::CreateJob(Context* context, const v1::CreateJobRequest* request,
                               v1::Job* response) {
  return create(_edge, context, *request, [this, request, response](const Identity& who) {
    _edge.admission.require_open();
    const jobs::EngineOptions& options = _edge.backend.engine.options();
    const std::string& id = request->request_id();
    api::require_request_id(id);
    const v1::JobSpec& asked = request->spec();
    const std::string print = id.empty() ? "" : api::fingerprint(asked);
    // First: a retry is answered whatever the limits are now, however full the queue, and though
    // its mesh is gone.
    if (const auto made = _edge.backend.engine.submitted(who.name, id, print)) {
      *response = from_domain(*made);
      return;
    }
    try {
      records::JobSpec spec =
          api::to_spec(asked, {options.max_iterations, options.queue_time, options.run_time});
      visible_mesh(_edge.backend, who, spec.mesh);
      if (has_packed_matrix(asked)) {
        jobs::check(spec, options);  // a refused job must leave nothing on the disk
        keep_packed_matrix(asked, _edge.backend.store, who.name);
      }
      *response = from_domain(_edge.backend.engine.submit({std::move(spec), who.name, id, print}));
    } catch (const errors::Error& error) {
      throw api::below_job_request(error);
    }
  });
}

Unary* SolveService::GetJob(Context* context, const v1::GetJobRequest* request, v1::Job* response) {
  return look_up(_edge, context, *request, [this, request, response](const Identity& who) {
    records::JobRecord record =
        visible_job(_edge.backend, who, api::job_id(request->name(), "name"));
    *response =
        request->view() == v1::JOB_VIEW_BASIC ? basic(std::move(record)) : from_domain(record);
  });
}

Unary* SolveService::ListJobs(Context* context, const v1::ListJobsRequest* request,
                              v1::ListJobsResponse* response) {
  return look_up(_edge, context, *request, [this, request, response](const Identity& who) {
    const std::string mesh = request->mesh().empty() ? "" : api::mesh_id(request->mesh(), "mesh");
    response->set_next_page_token(fill_page(
        to_page(request->page_size(), request->page_token()),
        [&](const std::string& after, std::size_t count) {
          return _edge.backend.engine.list(
              {after, count, owner_filter(who, request->owner()), request->oldest_first()});
        },
        [&](records::JobRecord& record) -> std::size_t {
          if (!mesh.empty() && record.spec.mesh != mesh) return 0;
          if (!request->states().empty() &&
              !std::ranges::count(request->states(), static_cast<int>(record.state)))
            return 0;
          const bool full = request->view() == v1::JOB_VIEW_FULL;
          return (*response->add_jobs() = full ? from_domain(record) : basic(std::move(record)))
              .ByteSizeLong();
        }));
  });
}

Unary* SolveService::CancelJob(Context* context, const v1::CancelJobRequest* request,
                               v1::Job* response) {
  return change(_edge, context, *request, [this, request, response](const Identity& who) {
    const std::string id = api::job_id(request->name(), "name");
    visible_job(_edge.backend, who, id);
    *response = from_domain(_edge.backend.engine.cancel(id));
  });
}

Unary* SolveService::DeleteJob(Context* context, const v1::DeleteJobRequest* request,
                               google::protobuf::Empty* /*response*/) {
  return change(_edge, context, *request, [this, request](const Identity& who) {
    const std::string id = api::job_id(request->name(), "name");
    visible_job(_edge.backend, who, id);
    _edge.backend.engine.erase(id);
  });
}

Answers<v1::WatchJobResponse>* SolveService::WatchJob(Context* context,
                                                      const v1::WatchJobRequest* request) {
  return stream<v1::WatchJobResponse>(
      _edge, context, StreamKind::watch, *request, [this, request](const Identity& who) {
        std::string id = api::job_id(request->name(), "name");
        visible_job(_edge.backend, who, id);
        return std::make_unique<WatchFeed>(_edge.backend, _edge.watch_groups, std::move(id),
                                           request->after_sequence());
      });
}

Answers<v1::ReadResultResponse>* SolveService::ReadResult(Context* context,
                                                          const v1::ReadResultRequest* request) {
  return stream<v1::ReadResultResponse>(
      _edge, context, StreamKind::transfer, *request, [this, request](const Identity& who) {
        const std::string id = api::job_id(request->name(), "name");
        visible_job(_edge.backend, who, id);
        return std::make_unique<BlockFeed<v1::ReadResultResponse>>(_edge.backend.engine.result(id),
                                                                   request->offset());
      });
}

}  // namespace anticrack::rpc
