// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/case_service.hpp"

#include "casefile/keys.hpp"
#include "casefile/read_case.hpp"
#include "jobs/job_engine.hpp"
#include "rpc/unary.hpp"

namespace anticrack::rpc {

Unary* CaseService::ReadCase(Context* context, const v1::ReadCaseRequest* request,
                             v1::ReadCaseResponse* response) {
  return answer_on(_edge, _edge.cases, _edge.limits.waiting_creations, context, *request,
                   [this, request, response](const access::Identity&) {
                     *response = casefile::read_case(
                         *request,
                         {_edge.backend.engine.options().max_load_cases, max_message_bytes});
                   });
}

Unary* CaseService::ListCaseKeys(Context* context, const v1::ListCaseKeysRequest* request,
                                 v1::ListCaseKeysResponse* response) {
  return answer_on(
      _edge, _edge.cases, _edge.limits.waiting_creations, context, *request,
      [request, response](const access::Identity&) { *response = casefile::list_keys(*request); });
}

}  // namespace anticrack::rpc
