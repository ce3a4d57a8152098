// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/authentication.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <utility>

#include "errors/errors.hpp"
#include "words/shown.hpp"

namespace anticrack::rpc {
namespace {

using errors::Error;
using errors::Reason;

constexpr std::size_t max_name_bytes = 64;  // limit of a common name in X.509

std::string_view view(const grpc::string_ref& text) { return {text.data(), text.size()}; }

/// The text after "Bearer ", which may be in any case.
std::optional<std::string_view> bearer_token(std::string_view value) {
  constexpr std::string_view scheme = "bearer ";
  if (value.size() <= scheme.size()) return std::nullopt;
  const bool fits = std::equal(scheme.begin(), scheme.end(), value.begin(), [](char a, char b) {
    return a == std::tolower(static_cast<unsigned char>(b));
  });
  if (!fits) return std::nullopt;
  return value.substr(scheme.size());
}

/// The common name of the certificate that the peer proved to own; empty if there is none.
std::string certificate_name(const grpc::CallbackServerContext& call) {
  const std::shared_ptr<const grpc::AuthContext> peer = call.auth_context();
  if (!peer || !peer->IsPeerAuthenticated()) return {};
  const std::vector<grpc::string_ref> names = peer->FindPropertyValues(GRPC_X509_CN_PROPERTY_NAME);
  return names.size() == 1 ? std::string(view(names.front())) : std::string();
}

}  // namespace

Authentication::Authentication(const Security& security)
    : _tokens(std::make_shared<const access::TokenTable>(security.tokens)),
      _admins(security.admins),
      _certificates(security.tls && !security.tls->client_roots.empty()) {}

void Authentication::replace(access::TokenTable table) {
  auto made = std::make_shared<const access::TokenTable>(std::move(table));
  const std::lock_guard lock(_mutex);
  _tokens.swap(made);
}

std::shared_ptr<const access::TokenTable> Authentication::tokens() const {
  const std::lock_guard lock(_mutex);
  return _tokens;
}

access::Identity Authentication::identify(const grpc::CallbackServerContext& call) const {
  const std::shared_ptr<const access::TokenTable> known = tokens();
  if (known->empty() && !_certificates) return {"", access::Role::admin};
  if (!known->empty()) {
    const auto [begin, end] = call.client_metadata().equal_range("authorization");
    if (begin != end) {
      const std::optional<std::string_view> token =
          std::next(begin) == end ? bearer_token(view(begin->second)) : std::nullopt;
      const std::optional<access::Identity> who = token ? known->find(*token) : std::nullopt;
      if (who) return *who;
      throw Error(Reason::unauthenticated,
                  token ? "this server does not know the token; ask its administrator for one"
                        : "send one metadata entry \"authorization: Bearer TOKEN\"");
    }
  }
  if (_certificates) {
    std::string name = certificate_name(call);
    if (!name.empty() && name.size() <= max_name_bytes &&
        words::printable(name, max_name_bytes) == name) {
      const bool admin = std::find(_admins.begin(), _admins.end(), name) != _admins.end();
      return {std::move(name), admin ? access::Role::admin : access::Role::user};
    }
    if (known->empty()) {
      throw Error(Reason::unauthenticated,
                  "the client certificate has no usable common name (CN); ask for another one");
    }
  }
  throw Error(Reason::unauthenticated,
              "this server asks who calls: send the metadata \"authorization: Bearer TOKEN\"");
}

std::string client_of(const access::Identity& who, const grpc::CallbackServerContext& call) {
  return who.name.empty() ? without_port(call.peer()) : who.name;
}

std::string without_port(const std::string& peer) {
  const bool network = peer.starts_with("ipv4:") || peer.starts_with("ipv6:");
  return network ? peer.substr(0, peer.rfind(':')) : peer;
}

}  // namespace anticrack::rpc
