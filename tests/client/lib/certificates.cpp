// SPDX-License-Identifier: GPL-3.0-or-later
#include "client/lib/certificates.hpp"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <memory>
#include <random>
#include <stdexcept>

namespace anticrack::client {
namespace {

using Bio = std::unique_ptr<BIO, decltype(&BIO_free)>;
using Certificate = std::unique_ptr<X509, decltype(&X509_free)>;
using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;

void need(bool fine, const char* what) {
  if (!fine) {
    throw std::runtime_error(std::string("OpenSSL does not make ") + what);
  }
}

std::string text_of(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

void add_extension(X509* certificate, int nid, const std::string& value) {
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, nullptr, nid, value.c_str());
  need(extension != nullptr, "an extension");
  X509_add_ext(certificate, extension, -1);
  X509_EXTENSION_free(extension);
}

/// `authority` null: signed by itself, an authority.
Pem make(const std::string& name, const Pem* authority) {
  const Key key(EVP_EC_gen("P-256"), &EVP_PKEY_free);
  need(key != nullptr, "a key");
  const Certificate certificate(X509_new(), &X509_free);
  X509* x509 = certificate.get();
  X509_set_version(x509, 2);
  ASN1_INTEGER_set(X509_get_serialNumber(x509), static_cast<long>(std::random_device{}() >> 1));
  constexpr long day = 86'400;
  X509_gmtime_adj(X509_getm_notBefore(x509), -day);
  X509_gmtime_adj(X509_getm_notAfter(x509), day);
  X509_set_pubkey(x509, key.get());
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): OpenSSL counts in unsigned char
  const auto* text = reinterpret_cast<const unsigned char*>(name.c_str());
  X509_NAME_add_entry_by_txt(X509_get_subject_name(x509), "CN", MBSTRING_UTF8, text, -1, -1, 0);
  if (authority == nullptr) {
    X509_set_issuer_name(x509, X509_get_subject_name(x509));
    add_extension(x509, NID_basic_constraints, "critical,CA:TRUE");
    need(X509_sign(x509, key.get(), EVP_sha256()) > 0, "an authority");
  } else {
    const Bio of_key(BIO_new_mem_buf(authority->key.data(), -1), &BIO_free);
    const Bio of_certificate(BIO_new_mem_buf(authority->certificate.data(), -1), &BIO_free);
    const Key signer(PEM_read_bio_PrivateKey(of_key.get(), nullptr, nullptr, nullptr),
                     &EVP_PKEY_free);
    const Certificate issuer(PEM_read_bio_X509(of_certificate.get(), nullptr, nullptr, nullptr),
                             &X509_free);
    X509_set_issuer_name(x509, X509_get_subject_name(issuer.get()));
    const bool is_address = name.find_first_not_of("0123456789.") == std::string::npos;
    add_extension(x509, NID_subject_alt_name, (is_address ? "IP:" : "DNS:") + name);
    need(X509_sign(x509, signer.get(), EVP_sha256()) > 0, "a certificate");
  }
  const Bio out(BIO_new(BIO_s_mem()), &BIO_free);
  const Bio out_key(BIO_new(BIO_s_mem()), &BIO_free);
  PEM_write_bio_X509(out.get(), x509);
  PEM_write_bio_PrivateKey(out_key.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr);
  return {text_of(out.get()), text_of(out_key.get())};
}

}  // namespace

Pem make_authority(const std::string& name) {
  return make(name, nullptr);
}

Pem make_certificate(const std::string& name, const Pem& authority) {
  return make(name, &authority);
}

}  // namespace anticrack::client
