// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a client identifies itself and verifies the server.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace anticrack::client {

/// The files that the user gives; empty: not given.
struct CredentialFiles {
  bool tls = false;                   ///< use TLS even without files, with the system's roots
  std::filesystem::path ca;           ///< PEM; trusted instead of the system's roots
  std::filesystem::path certificate;  ///< PEM; of this client
  std::filesystem::path key;          ///< PEM, without a pass phrase
  std::filesystem::path token;        ///< holds one bearer token
  /// The token itself, if no file is given. It never comes from the command line, which other users
  /// can read.
  std::string token_text;
};

struct Credentials {
  bool tls = false;
  std::string roots, certificate, key;  ///< PEM texts; empty roots: the system's
  std::string token;                    ///< empty: none
  CredentialFiles files;                ///< the files they come from, for error messages
};

/// The address in lower case, without a scheme of gRPC that stands before a host.
std::string plain_address(std::string_view address);

/// Whether data sent to this address stay on the machine: a unix socket, localhost, 127.x.x.x or
/// ::1.
bool is_loopback(std::string_view address);

/// Reads and checks the files before anything is sent. Throws Error (invalid_argument) with the
/// file and the cure for a file that cannot be read or is not PEM, a key of another certificate, a
/// certificate without its key, a malformed token, or a token that would cross a network
/// unencrypted.
Credentials read_credentials(const CredentialFiles& files, std::string_view address);

}  // namespace anticrack::client
