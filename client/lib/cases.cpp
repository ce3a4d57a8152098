// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/cases.hpp"

#include "client/channel.hpp"

namespace anticrack::client {

v1::ReadCaseResponse read_case(Connection& connection, const v1::ReadCaseRequest& request,
                               const std::stop_token& stop) {
  return call(connection, &v1::CaseService::Stub::ReadCase, request, stop);
}

v1::ListCaseKeysResponse list_case_keys(Connection& connection,
                                        const v1::ListCaseKeysRequest& request,
                                        const std::stop_token& stop) {
  return call(connection, &v1::CaseService::Stub::ListCaseKeys, request, stop);
}

}  // namespace anticrack::client
