// SPDX-License-Identifier: GPL-3.0-or-later
//
// Certificates made as they are needed.
#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <memory>
#include <string>

namespace anticrack::testing {

struct Pem {
  std::string certificate;
  std::string key;
};

/// A private certificate authority.
class Authority {
 public:
  explicit Authority(const std::string& name = "authority of a test");
  const std::string& root() const { return _root; }
  /// For `name` at `hosts` (as OpenSSL writes alternative names), valid from two days ago to
  /// now + `days`.
  Pem issue(const std::string& name, int days = 1, const std::string& hosts = here);

  static constexpr const char* here = "DNS:localhost,IP:127.0.0.1";

 private:
  template <class Object, void (*free)(Object*)>
  struct Free {
    void operator()(Object* object) const { free(object); }
  };
  using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY, EVP_PKEY_free>>;
  using Certificate = std::unique_ptr<X509, Free<X509, X509_free>>;

  static Key new_key();
  /// Signed by the authority; by itself while it has no certificate yet.
  Certificate sign(const std::string& name, EVP_PKEY* key, int days, const std::string& hosts);

  Key _key;
  Certificate _certificate;
  std::string _root;
  long _serial = 0;
};

}  // namespace anticrack::testing
