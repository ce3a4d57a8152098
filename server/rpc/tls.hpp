// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpc/grpc_security.h>
#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <mutex>

#include "rpc/server.hpp"

namespace anticrack::rpc {

/// Checks certificate and key; returns the days until the first certificate expires. Like
/// require_usable() it throws errors::Error (invalid_argument; field "tls-certificate", "tls-key"
/// or "tls-client-roots") if a text is not such a PEM, the key belongs to another certificate, or
/// the certificate is not valid today: gRPC would refuse each connection without a word.
int check_certificate(const std::string& certificate, const std::string& key);
void check_roots(const std::string& roots);
void require_usable(const Tls& tls);  ///< checks certificate and key, and client roots

/// The certificates of a server, which may be replaced while it serves. Thread-safe; outlives the
/// server.
class Certificates {
 public:
  /// If Tls::client_roots is set, clients need certificates that chain to them. Throws as
  /// require_usable() does.
  explicit Certificates(Tls tls);

  /// Handshakes that begin from now on use these; connections stay as they are. Throws as
  /// require_usable() does, and then changes nothing.
  void replace(Tls tls);

  /// Credentials for a port, which ask for the present certificates each time. To be called once.
  std::shared_ptr<grpc::ServerCredentials> credentials();

 private:
  static grpc_ssl_certificate_config_reload_status fetch(
      void* self, grpc_ssl_server_certificate_config** config);

  std::mutex _mutex;
  Tls _tls;
  bool _fetched = false;  ///< whether gRPC has these already
};

}  // namespace anticrack::rpc
