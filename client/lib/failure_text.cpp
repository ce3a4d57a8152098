// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/failure_text.hpp"

namespace anticrack::client {
namespace {

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

// gRPC tells the cause after its own story.
std::string_view cause_of(std::string_view story) {
  const std::size_t cause = story.rfind(": ");
  return cause == std::string_view::npos ? story : story.substr(cause + 2);
}

std::string roots_of(const Credentials& credentials) {
  return credentials.files.ca.empty()
             ? std::string("the roots of this system; name its own with --ca FILE")
             : "--ca " + credentials.files.ca.string();
}

std::string tls_cure(const std::string& address, const Credentials& credentials,
                     std::string_view story) {
  // OpenSSL's words for a signature by another authority of the same name, now and then.
  const bool no_signature = has(story, "asn1 encoding routines") && has(story, "EVP lib");
  if (no_signature || has(story, "CERTIFICATE_VERIFY_FAILED") ||
      has(story, "certificate verify failed")) {
    return "the certificate of " + address + " is not signed by " + roots_of(credentials) +
           ", or it has expired";
  }
  if (has(story, "is not in peer certificate") || has(story, "Hostname Verification")) {
    return "the certificate of the server is for another name than " + address +
           "; use the name it was made for, or make it again with this one";
  }
  if (has(story, "WRONG_VERSION_NUMBER") || has(story, "wrong version number")) {
    return address +
           " speaks no TLS; leave out --tls, --ca and --cert, or give the server a "
           "certificate";
  }
  if (has(story, "alert") || (has(story, "andshake") && credentials.certificate.empty())) {
    return credentials.certificate.empty()
               ? std::string("the server wants a certificate; give --cert FILE and --key FILE")
               : "the server does not accept the certificate in " +
                     credentials.files.certificate.string() + "; is it signed by its authority?";
  }
  return "";
}

}  // namespace

std::string unreachable_text(const std::string& address, const Credentials& credentials,
                             std::string_view story) {
  const std::string head =
      "cannot reach the server at " + address + " (" + std::string(cause_of(story)) + "); ";
  if (credentials.tls) {
    const std::string cure = tls_cure(address, credentials, story);
    if (!cure.empty()) return head + cure;
  }
  // A server with TLS hangs up on one that speaks none.
  const bool hung_up = has(story, "ocket closed") || has(story, "onnection reset") ||
                       has(story, "HTTP2") || has(story, "HTTP/2");
  return head + (hung_up && !credentials.tls
                     ? "is it anticrackd? If it wants TLS, add --ca FILE or --tls"
                     : "start anticrackd, name its address with --server, or use --local");
}

std::string refused_text(Code code, const std::string& message, const Credentials& credentials) {
  const std::string file = credentials.files.token.string();
  const std::string token = file.empty() ? "in ANTICRACK_TOKEN" : "in " + file;
  if (code == Code::permission_denied) {
    return message + (credentials.token.empty()
                          ? "; to come as somebody else give another --cert, or --token-file FILE"
                          : "; to come as somebody else replace the token " + token);
  }
  return message + (credentials.token.empty()
                        ? "; give a token with --token-file FILE or in ANTICRACK_TOKEN"
                        : "; check the token " + token);
}

}  // namespace anticrack::client
