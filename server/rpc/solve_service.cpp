// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/solve_service.hpp"

#include <memory>

#include "jobs/job_engine.hpp"
#include "rpc/block_feed.hpp"
#include "rpc/from_domain.hpp"
#include "rpc/names.hpp"
#include "rpc/pages.hpp"
#include "rpc/to_domain.hpp"
#include "rpc/watch_feed.hpp"
#include "rpc/write_stream.hpp"

namespace anticrack::rpc {

SolveService::SolveService(const Backend& backend, const Limits& limits, const Admission& admission,
                           StreamHub& hub, WorkThread& work)
    : _backend(backend), _limits(limits), _admission(admission), _hub(hub), _work(work) {}

v1::Job SolveService::to_answer(const store::JobRecord& record) const {
  return from_domain(record, interface_names(_backend.catalogue, record.spec.mesh));
}

grpc::ServerUnaryReactor* SolveService::CreateJob(grpc::CallbackServerContext* context,
                                                  const v1::CreateJobRequest* request,
                                                  v1::Job* response) {
  const auto limit = static_cast<std::size_t>(_limits.waiting_creations);
  return answer_on(_work, limit, context, "CreateJob", [this, request, response] {
    _admission.require_open();
    const jobs::EngineOptions& options = _backend.engine.options();
    require_request_id(request->request_id());
    const store::JobSpec spec =
        to_spec(request->job(), {options.max_load_cases, options.max_iterations});
    try {
      *response = to_answer(_backend.engine.submit(spec, request->request_id()));
    } catch (const errors::Error& error) {
      throw below_job_request(error);
    }
  });
}

grpc::ServerUnaryReactor* SolveService::GetJob(grpc::CallbackServerContext* context,
                                               const v1::GetJobRequest* request,
                                               v1::Job* response) {
  return answer(context, "GetJob", [&] {
    *response = to_answer(_backend.engine.get(job_id(request->name(), "name")));
  });
}

grpc::ServerUnaryReactor* SolveService::ListJobs(grpc::CallbackServerContext* context,
                                                 const v1::ListJobsRequest* request,
                                                 v1::ListJobsResponse* response) {
  return answer(context, "ListJobs", [&] {
    response->set_next_page_token(fill_page(
        to_page(request->page_size(), request->page_token()),
        [&](const std::string& after, std::size_t count) {
          return _backend.engine.list(after, count);
        },
        [&](const store::JobRecord& record) {
          return (*response->add_jobs() = to_answer(record)).ByteSizeLong();
        }));
  });
}

grpc::ServerUnaryReactor* SolveService::CancelJob(grpc::CallbackServerContext* context,
                                                  const v1::CancelJobRequest* request,
                                                  v1::Job* response) {
  return answer(context, "CancelJob", [&] {
    *response = to_answer(_backend.engine.cancel(job_id(request->name(), "name")));
  });
}

grpc::ServerUnaryReactor* SolveService::DeleteJob(grpc::CallbackServerContext* context,
                                                  const v1::DeleteJobRequest* request,
                                                  google::protobuf::Empty* /*response*/) {
  return answer(context, "DeleteJob",
                [&] { _backend.engine.erase(job_id(request->name(), "name")); });
}

grpc::ServerWriteReactor<v1::WatchJobResponse>* SolveService::WatchJob(
    grpc::CallbackServerContext* context, const v1::WatchJobRequest* request) {
  return stream<v1::WatchJobResponse>(context, _hub, StreamKind::watch, "WatchJob", [&] {
    return std::make_unique<WatchFeed>(_backend.engine, _backend.catalogue,
                                       job_id(request->name(), "name"), request->after_sequence());
  });
}

grpc::ServerWriteReactor<v1::ReadResultResponse>* SolveService::ReadResult(
    grpc::CallbackServerContext* context, const v1::ReadResultRequest* request) {
  return stream<v1::ReadResultResponse>(context, _hub, StreamKind::transfer, "ReadResult", [&] {
    return std::make_unique<BlockFeed<v1::ReadResultResponse>>(
        _backend.engine.result(job_id(request->name(), "name")), request->offset());
  });
}

}  // namespace anticrack::rpc
