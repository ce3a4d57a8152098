// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/tls.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <array>
#include <string>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

template <class Object, void (*free)(Object*)>
struct Free {
  void operator()(Object* object) const { free(object); }
};
using Certificate = std::unique_ptr<X509, Free<X509, X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY, EVP_PKEY_free>>;
struct FreeBio {
  void operator()(BIO* bio) const { BIO_free(bio); }
};
using Bio = std::unique_ptr<BIO, FreeBio>;

Error refused(const char* field, const std::string& what) {
  return Error(Reason::invalid_argument, what).at(field);
}

Bio reader_of(const std::string& pem) {
  return Bio(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
}

/// OpenSSL would ask for a passphrase at the terminal.
int no_passphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) {
  return -1;
}

std::vector<Certificate> certificates_of(const std::string& pem, const char* field) {
  const Bio bio = reader_of(pem);
  std::vector<Certificate> certificates;
  while (Certificate next{PEM_read_bio_X509(bio.get(), nullptr, no_passphrase, nullptr)})
    certificates.push_back(std::move(next));
  // The end of the text is an error too; any other means a damaged certificate.
  const bool at_end = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
  ERR_clear_error();
  if (certificates.empty()) {
    throw refused(field,
                  "no certificate in it; give PEM, which begins with "
                  "-----BEGIN CERTIFICATE-----");
  }
  if (!at_end) {
    throw refused(field, "certificate " + std::to_string(certificates.size() + 1) +
                             " in it is damaged; copy it again");
  }
  return certificates;
}

Key key_of(const std::string& pem) {
  const Bio bio = reader_of(pem);
  Key key(PEM_read_bio_PrivateKey(bio.get(), nullptr, no_passphrase, nullptr));
  ERR_clear_error();
  if (!key) {
    throw refused("tls-key",
                  "no private key in it; give PEM without a passphrase, which begins "
                  "with -----BEGIN PRIVATE KEY-----");
  }
  return key;
}

std::string text_of(const ASN1_TIME* time) {
  const Bio bio(BIO_new(BIO_s_mem()));
  ASN1_TIME_print(bio.get(), time);
  std::array<char, 64> text{};
  const int size = BIO_read(bio.get(), text.data(), static_cast<int>(text.size()));
  return {text.data(), static_cast<std::size_t>(size > 0 ? size : 0)};
}

void require_valid_today(const X509* certificate) {
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0) {
    throw refused("tls-certificate", "the certificate expired on " +
                                         text_of(X509_get0_notAfter(certificate)) +
                                         "; no client would accept it, renew it");
  }
  if (X509_cmp_current_time(X509_get0_notBefore(certificate)) > 0) {
    throw refused("tls-certificate", "the certificate is not valid before " +
                                         text_of(X509_get0_notBefore(certificate)) +
                                         "; check this machine's clock");
  }
}

}  // namespace

std::shared_ptr<grpc::ServerCredentials> server_credentials(const std::optional<Tls>& tls) {
  if (!tls) return grpc::InsecureServerCredentials();
  const std::vector<Certificate> chain = certificates_of(tls->certificate, "tls-certificate");
  const Key key = key_of(tls->key);
  if (X509_check_private_key(chain.front().get(), key.get()) != 1) {
    ERR_clear_error();
    throw refused("tls-key",
                  "the key belongs to another certificate than the first one of "
                  "tls-certificate");
  }
  require_valid_today(chain.front().get());
  const bool mutual = !tls->client_roots.empty();
  if (mutual) certificates_of(tls->client_roots, "tls-client-roots");
  grpc::SslServerCredentialsOptions options(
      mutual ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
             : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE);
  options.pem_root_certs = tls->client_roots;
  options.pem_key_cert_pairs.push_back({tls->key, tls->certificate});
  return grpc::SslServerCredentials(options);
}

}  // namespace anticrack::rpc
