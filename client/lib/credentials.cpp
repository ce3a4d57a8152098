// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/credentials.hpp"

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <memory>

#include "client/error.hpp"

namespace anticrack::client {
namespace {

constexpr std::size_t longest_token = 4'096;
constexpr std::uintmax_t largest_pem = 4U << 20;

using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Code::invalid_argument, message);
}

std::string content_of(const std::filesystem::path& path, const std::string& option) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  // A pipe, as in `--token-file <(command)`, is read although it has no size.
  if (std::filesystem::is_directory(path) || !file || (!error && size > largest_pem))
    refuse(option + ": " + path.string() + " is not a readable file of at most 4 MiB");
  return {std::istreambuf_iterator<char>(file), {}};
}

Bio bio_of(const std::string& text) {
  return {BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), &BIO_free};
}

Certificate first_certificate(const std::string& text) {
  const Bio bio = bio_of(text);
  return {PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr), &X509_free};
}

// Without the callback, OpenSSL would ask the terminal for a pass phrase.
Key private_key(const std::string& text) {
  const Bio bio = bio_of(text);
  const auto no_pass_phrase = [](char*, int, int, void*) { return -1; };
  return {PEM_read_bio_PrivateKey(bio.get(), nullptr, no_pass_phrase, nullptr), &EVP_PKEY_free};
}

std::string read_certificates(const std::filesystem::path& path, const std::string& option) {
  std::string text = content_of(path, option);
  if (!first_certificate(text)) {
    refuse(option + ": " + path.string() +
           " holds no certificate; it should contain -----BEGIN CERTIFICATE-----");
  }
  return text;
}

void read_pair(const CredentialFiles& files, Credentials& result) {
  if (files.certificate.empty() || files.key.empty()) {
    refuse(files.key.empty()
               ? "--cert needs --key, the private key of " + files.certificate.string()
               : "--key needs --cert, the certificate of " + files.key.string());
  }
  result.certificate = read_certificates(files.certificate, "--cert");
  result.key = content_of(files.key, "--key");
  const Key key = private_key(result.key);
  if (!key) refuse("--key: " + files.key.string() + " holds no private key without a pass phrase");
  if (X509_check_private_key(first_certificate(result.certificate).get(), key.get()) != 1) {
    refuse("--key: " + files.key.string() + " is not the key of the certificate in " +
           files.certificate.string());
  }
}

std::string read_token(const CredentialFiles& files) {
  const std::string origin =
      files.token.empty() ? "ANTICRACK_TOKEN" : "--token-file: " + files.token.string();
  std::string token =
      files.token.empty() ? files.token_text : content_of(files.token, "--token-file");
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  // Characters allowed in a header; others would fail later, with a less clear message.
  const bool printable =
      std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (token.empty() || token.size() > longest_token || !printable) {
    refuse(origin +
           " is not a token; one line of at most 4096 printable characters without blanks is");
  }
  return token;
}

}  // namespace

std::string plain_address(std::string_view address) {
  std::string lower(address);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string_view scheme : {"dns:///", "dns:", "ipv4:", "ipv6:"})
    if (lower.starts_with(scheme)) return lower.substr(scheme.size());
  return lower;
}

bool is_loopback(std::string_view any) {
  const std::string address = plain_address(any);
  for (const std::string_view scheme : {"unix:", "unix-abstract:"})
    if (address.starts_with(scheme)) return true;
  if (address == "::1" || address == "[::1]" || address.starts_with("[::1]:")) return true;
  const std::string_view host = std::string_view(address).substr(0, address.find(':'));
  // Only digits and dots count, as "127.evil.example" is an ordinary host name.
  const bool digits = host.find_first_not_of("0123456789.") == std::string_view::npos;
  return host == "localhost" || host == "localhost." || (host.starts_with("127.") && digits);
}

Credentials read_credentials(const CredentialFiles& files, std::string_view address) {
  Credentials result;
  result.files = files;
  result.files.token_text.clear();
  if (!files.ca.empty()) result.roots = read_certificates(files.ca, "--ca");
  if (!files.certificate.empty() || !files.key.empty()) read_pair(files, result);
  result.tls = files.tls || !result.roots.empty() || !result.certificate.empty();
  if (!files.token.empty() || !files.token_text.empty()) {
    result.token = read_token(files);
    if (!result.tls && !is_loopback(address)) {
      refuse("the token would go to " + std::string(address) +
             " unencrypted, for anybody on the way to read; add --ca FILE, or --tls where the "
             "server's certificate is of a public authority");
    }
  }
  return result;
}

}  // namespace anticrack::client
