// SPDX-License-Identifier: GPL-3.0-or-later
//
// Who calls. Asked at the head of every method by answer(), answer_on(), stream() and
// receive_upload(), which are the only ways to a method's work, so that none can forget it.
//
// Not a grpc::AuthMetadataProcessor: gRPC takes one with TLS credentials only, and it would lock
// out health checks, which balancers send without a token. Health and reflection stay open: they
// tell no more than proto/ does.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "access/identity.hpp"
#include "access/tokens.hpp"
#include "rpc/server.hpp"

namespace anticrack::rpc {

/// Thread-safe.
class Authentication {
 public:
  /// Copies what it needs.
  explicit Authentication(const Security& security);

  /// A token that is sent decides, also where there is a certificate. Without tokens and client
  /// certificates everybody is the administrator without a name. Throws errors::Error
  /// (unauthenticated); never repeats what was sent.
  access::Identity identify(const grpc::CallbackServerContext& call) const;

  /// Calls that begin from now on need one of these tokens. Neither table, the old or the new, is
  /// empty where the other is not.
  void replace(access::TokenTable table);

 private:
  std::shared_ptr<const access::TokenTable> tokens() const;

  mutable std::mutex _mutex;                          ///< of `_tokens`
  std::shared_ptr<const access::TokenTable> _tokens;  ///< never null
  const std::vector<std::string> _admins;
  const bool _certificates;
};

/// Whom a stream is counted for: the identity, or without one the machine the call comes from.
std::string client_of(const access::Identity& who, const grpc::CallbackServerContext& call);

/// "ipv4:10.0.0.1:4711" -> "ipv4:10.0.0.1": one machine is one client, whatever its connections.
std::string without_port(const std::string& peer);

}  // namespace anticrack::rpc
