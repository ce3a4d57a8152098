// SPDX-License-Identifier: GPL-3.0-or-later
//
// Finds out who calls. answer(), answer_on(), stream() and receive_upload() ask this first in every
// method; they are the only ways to a method's work, so that no method can forget it.
//
// It is no grpc::AuthMetadataProcessor, because gRPC takes one with TLS credentials only, and it
// would lock out health checks, which balancers send without a token. Health and reflection stay
// open, as they tell no more than proto/ does.
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
  /// Copies what it needs of `security`.
  explicit Authentication(const Security& security);

  /// The identity of a caller. A token, if sent, decides, even if there is a certificate. Without
  /// tokens and client certificates everybody is the administrator without a name. Throws
  /// errors::Error (unauthenticated), which never repeats what was sent.
  access::Identity identify(const grpc::CallbackServerContext& call) const;

  /// Calls that begin from now on need one of these tokens. The old and the new table must both be
  /// empty or both not empty.
  void replace(access::TokenTable table);

 private:
  std::shared_ptr<const access::TokenTable> tokens() const;

  mutable std::mutex _mutex;                          ///< guards _tokens
  std::shared_ptr<const access::TokenTable> _tokens;  ///< never null
  const std::vector<std::string> _admins;
  const bool _certificates;
};

/// The client for which a stream is counted: the identity, or without one the calling machine.
std::string client_of(const access::Identity& who, const grpc::CallbackServerContext& call);

/// "ipv4:10.0.0.1:4711" -> "ipv4:10.0.0.1": one machine is one client, whatever its connections.
std::string without_port(const std::string& peer);

}  // namespace anticrack::rpc
