// SPDX-License-Identifier: GPL-3.0-or-later
//
// How a client identifies itself and verifies the server.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace anticrack::client {

/// As the user gives them; empty: not given.
struct CredentialFiles {
  bool tls = false;                   ///< even without files: with the system's roots
  std::filesystem::path ca;           ///< PEM; trusted instead of the system's roots
  std::filesystem::path certificate;  ///< PEM; of this client
  std::filesystem::path key;          ///< PEM, without a pass phrase
  std::filesystem::path token;        ///< holds one bearer token
  /// The token itself, if no file is given. Never from the command line, which other users can
  /// read.
  std::string token_text;
};

struct Credentials {
  bool tls = false;
  std::string roots, certificate, key;  ///< PEM texts; no roots: the system's
  std::string token;                    ///< empty: none
  CredentialFiles files;                ///< their origin, for error messages
};

/// Whether what is sent to this address stays on the machine: a unix socket, localhost, 127.x.x.x
/// or ::1.
bool is_loopback(std::string_view address);

/// Reads and checks them before anything is sent. Throws Error (invalid_argument) that names the
/// file and the cure: one that cannot be read, is not PEM, or whose key is of another certificate;
/// a certificate without its key; a malformed token, or one that would cross a network unencrypted.
Credentials read_credentials(const CredentialFiles& files, std::string_view address);

}  // namespace anticrack::client
