// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <grpc/grpc_security.h>
#include <grpcpp/security/server_credentials.h>

#include <memory>
#include <mutex>

#include "rpc/server.hpp"

namespace anticrack::rpc {

/// Days until the first certificate expires. These throw errors::Error (invalid_argument; field
/// "tls-certificate", "tls-key" or "tls-client-roots") where a text is no such PEM, the key belongs
/// to another certificate, or the certificate is not valid today: gRPC would refuse each connection
/// without a word.
int check_certificate(const std::string& certificate, const std::string& key);
void check_roots(const std::string& roots);
void require_usable(const Tls& tls);  ///< both

/// The certificates of a server, which may be replaced while it serves. Thread-safe; outlives the
/// server.
class Certificates {
 public:
  /// With Tls::client_roots clients need certificates that chain to them. Throws as
  /// require_usable() does.
  explicit Certificates(Tls tls);

  /// Handshakes that begin from now on use these; connections stay as they are. Throws as
  /// require_usable() does, and then nothing has changed.
  void replace(Tls tls);

  /// What one port listens with, each time asking for the certificates in use. To be called once.
  std::shared_ptr<grpc::ServerCredentials> credentials();

 private:
  static grpc_ssl_certificate_config_reload_status fetch(
      void* self, grpc_ssl_server_certificate_config** config);

  std::mutex _mutex;
  Tls _tls;
  bool _fetched = false;  ///< gRPC has these already
};

}  // namespace anticrack::rpc
