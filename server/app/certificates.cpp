// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/certificates.hpp"

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <memory>

#include "app/config.hpp"

namespace anticrack::app {
namespace {

template <auto free>
struct FreeWith {
  template <class Object>
  void operator()(Object* object) const {
    free(object);
  }
};

using Bio = std::unique_ptr<BIO, FreeWith<BIO_free>>;
using Certificate = std::unique_ptr<X509, FreeWith<X509_free>>;
using PrivateKey = std::unique_ptr<EVP_PKEY, FreeWith<EVP_PKEY_free>>;

Bio over(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

/// Keeps OpenSSL from asking on the terminal.
int no_passphrase(char* /*buffer*/, int /*size*/, int /*writing*/, void* /*data*/) { return -1; }

Certificate first_certificate(const std::string& setting, const std::string& pem) {
  Certificate certificate(PEM_read_bio_X509(over(pem).get(), nullptr, no_passphrase, nullptr));
  ERR_clear_error();
  if (!certificate) throw ConfigError(setting + ": holds no certificate in PEM form");
  return certificate;
}

}  // namespace

int check_certificate(const std::string& certificate, const std::string& key) {
  const Certificate own = first_certificate("tls-certificate", certificate);
  const PrivateKey secret(
      PEM_read_bio_PrivateKey(over(key).get(), nullptr, no_passphrase, nullptr));
  if (!secret) {
    ERR_clear_error();
    throw ConfigError("tls-key: holds no private key in PEM form without a passphrase");
  }
  const bool together = X509_check_private_key(own.get(), secret.get()) == 1;
  ERR_clear_error();
  if (!together) throw ConfigError("tls-key: not the key of the certificate in tls-certificate");
  int days = 0;
  int seconds = 0;
  ASN1_TIME_diff(&days, &seconds, nullptr, X509_get0_notAfter(own.get()));
  return seconds < 0 && days == 0 ? -1 : days;
}

void check_roots(const std::string& roots) { first_certificate("tls-client-roots", roots); }

}  // namespace anticrack::app
