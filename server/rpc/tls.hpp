// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <optional>

#include "rpc/server.hpp"

namespace anticrack::rpc {

/// What the server listens with: nothing, TLS, or TLS with client certificates that chain to
/// Tls::client_roots. Throws errors::Error (invalid_argument; field "tls-certificate", "tls-key" or
/// "tls-client-roots") where a text is no such PEM, the key belongs to another certificate, or the
/// certificate is not valid today: gRPC would refuse each connection without a word.
std::shared_ptr<grpc::ServerCredentials> server_credentials(const std::optional<Tls>& tls);

}  // namespace anticrack::rpc
