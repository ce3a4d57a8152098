// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/certificates.hpp"

#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <stdexcept>

namespace anticrack::testing {
namespace {

constexpr long day = 24 * 3600;

void require(bool done) {
  if (!done) throw std::runtime_error("OpenSSL refuses to make a certificate");
}

void extend(X509* certificate, X509* issuer, int extension, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* added = X509V3_EXT_conf_nid(nullptr, &context, extension, value);
  require(added != nullptr);
  X509_add_ext(certificate, added, -1);
  X509_EXTENSION_free(added);
}

/// What `write` writes.
template <class Write>
std::string pem_of(Write write) {
  BIO* bio = BIO_new(BIO_s_mem());
  require(write(bio) == 1);
  std::string pem(BIO_ctrl_pending(bio), '\0');
  BIO_read(bio, pem.data(), static_cast<int>(pem.size()));
  BIO_free(bio);
  return pem;
}

}  // namespace

Authority::Authority(const std::string& name) : _key(new_key()) {
  _certificate = sign(name, _key.get(), 1, "");
  _root = pem_of([&](BIO* bio) { return PEM_write_bio_X509(bio, _certificate.get()); });
}

Pem Authority::issue(const std::string& name, int days, const std::string& hosts) {
  const Key key = new_key();
  const Certificate certificate = sign(name, key.get(), days, hosts);
  return {pem_of([&](BIO* bio) { return PEM_write_bio_X509(bio, certificate.get()); }),
          pem_of([&](BIO* bio) {
            return PEM_write_bio_PrivateKey(bio, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
          })};
}

Authority::Key Authority::new_key() {
  Key key(EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "P-256"));
  require(key != nullptr);
  return key;
}

Authority::Certificate Authority::sign(const std::string& name, EVP_PKEY* key, int days,
                                       const std::string& hosts) {
  Certificate certificate(X509_new());
  X509* to = certificate.get();
  X509* issuer = _certificate ? _certificate.get() : to;
  X509_set_version(to, 2);  // X.509 v3
  ASN1_INTEGER_set(X509_get_serialNumber(to), ++_serial);
  X509_gmtime_adj(X509_getm_notBefore(to), -2 * day);
  X509_gmtime_adj(X509_getm_notAfter(to), days * day);
  X509_set_pubkey(to, key);
  if (!name.empty()) {
    require(X509_NAME_add_entry_by_txt(X509_get_subject_name(to), "CN", MBSTRING_UTF8,
                                       reinterpret_cast<const unsigned char*>(name.data()),
                                       static_cast<int>(name.size()), -1, 0) == 1);
  }
  X509_set_issuer_name(to, X509_get_subject_name(issuer));
  extend(to, issuer, NID_basic_constraints, _certificate ? "CA:FALSE" : "critical,CA:TRUE");
  if (_certificate) extend(to, issuer, NID_subject_alt_name, hosts.c_str());
  require(X509_sign(to, _key.get(), EVP_sha256()) > 0);
  return certificate;
}

}  // namespace anticrack::testing
