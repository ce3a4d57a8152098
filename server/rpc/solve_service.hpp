// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/grpcpp.h>

#include "anticrack/v1/solve.grpc.pb.h"
#include "rpc/edge.hpp"

namespace anticrack::rpc {

/// Translates, calls the job engine, maps the status. See solve.proto for the methods.
class SolveService final : public v1::SolveService::CallbackService {
 public:
  explicit SolveService(Edge& edge) : _edge(edge) {}

  Unary* CreateJob(Context* context, const v1::CreateJobRequest* request,
                   v1::Job* response) override;
  Unary* GetJob(Context* context, const v1::GetJobRequest* request, v1::Job* response) override;
  Unary* ListJobs(Context* context, const v1::ListJobsRequest* request,
                  v1::ListJobsResponse* response) override;
  Unary* CancelJob(Context* context, const v1::CancelJobRequest* request,
                   v1::Job* response) override;
  Unary* DeleteJob(Context* context, const v1::DeleteJobRequest* request,
                   google::protobuf::Empty* response) override;
  Answers<v1::WatchJobResponse>* WatchJob(Context* context,
                                          const v1::WatchJobRequest* request) override;
  Answers<v1::ReadResultResponse>* ReadResult(Context* context,
                                              const v1::ReadResultRequest* request) override;

 private:
  Edge& _edge;
};

}  // namespace anticrack::rpc
