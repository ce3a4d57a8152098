// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/tls.hpp"

#include <fmt/core.h>
#include <grpc/grpc.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <array>
#include <stdexcept>
#include <string>
#include <utility>
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
int no_passphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return -1; }

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
    throw refused(field, fmt::format("certificate {} in it is damaged; copy it again",
                                     certificates.size() + 1));
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

/// gRPC's C library takes certificates from a function at each handshake; its C++ classes offer
/// only certificates that stay, or files that it watches and does not check.
class FetchedCredentials final : public grpc::ServerCredentials {
 public:
  explicit FetchedCredentials(grpc_server_credentials* credentials) : _credentials(credentials) {}
  ~FetchedCredentials() override { grpc_server_credentials_release(_credentials); }
  FetchedCredentials(const FetchedCredentials&) = delete;
  FetchedCredentials& operator=(const FetchedCredentials&) = delete;

  void SetAuthMetadataProcessor(
      const std::shared_ptr<grpc::AuthMetadataProcessor>& /*processor*/) override {
    throw std::logic_error("callers are identified by rpc/authentication");
  }

 private:
  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), _credentials);
  }

  grpc_server_credentials* _credentials;
};

}  // namespace

int check_certificate(const std::string& certificate, const std::string& key) {
  const std::vector<Certificate> chain = certificates_of(certificate, "tls-certificate");
  const X509* own = chain.front().get();
  if (X509_check_private_key(own, key_of(key).get()) != 1) {
    ERR_clear_error();
    throw refused("tls-key",
                  "the key belongs to another certificate than the first one of "
                  "tls-certificate");
  }
  require_valid_today(own);
  int days = 0;
  int seconds = 0;
  ASN1_TIME_diff(&days, &seconds, nullptr, X509_get0_notAfter(own));
  return days;
}

void check_roots(const std::string& roots) { certificates_of(roots, "tls-client-roots"); }

void require_usable(const Tls& tls) {
  check_certificate(tls.certificate, tls.key);
  if (!tls.client_roots.empty()) check_roots(tls.client_roots);
}

Certificates::Certificates(Tls tls) : _tls(std::move(tls)) { require_usable(_tls); }

void Certificates::replace(Tls tls) {
  require_usable(tls);
  const std::lock_guard lock(_mutex);
  _tls = std::move(tls);
  _fetched = false;
}

grpc_ssl_certificate_config_reload_status Certificates::fetch(
    void* self, grpc_ssl_server_certificate_config** config) {
  auto& source = *static_cast<Certificates*>(self);
  const std::lock_guard lock(source._mutex);
  if (source._fetched) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
  const Tls& tls = source._tls;
  const grpc_ssl_pem_key_cert_pair pair{tls.key.c_str(), tls.certificate.c_str()};
  // gRPC insists on roots, though it uses none if clients are not asked for certificates.
  const std::string& roots = tls.client_roots.empty() ? tls.certificate : tls.client_roots;
  *config = grpc_ssl_server_certificate_config_create(roots.c_str(), &pair, 1);
  source._fetched = true;
  return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
}

std::shared_ptr<grpc::ServerCredentials> Certificates::credentials() {
  const bool mutual = !_tls.client_roots.empty();
  return std::make_shared<FetchedCredentials>(grpc_ssl_server_credentials_create_with_options(
      grpc_ssl_server_credentials_create_options_using_config_fetcher(
          mutual ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                 : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE,
          &Certificates::fetch, this)));
}

}  // namespace anticrack::rpc
