// SPDX-License-Identifier: GPL-3.0-or-later
#include "stop/stop.hpp"

#include <string>
#include <utility>

#include "errors/errors.hpp"

namespace anticrack::stop {
namespace {

thread_local const Asked* current = nullptr;

}  // namespace

Scope::Scope(std::stop_token token)
    : Scope(Asked([token = std::move(token)](const Look&) { return token.stop_requested(); })) {}

Scope::Scope(Asked asked) : _before(current) {
  if (_before == nullptr)
    _asked = std::move(asked);
  else if (asked)
    _asked = [before = _before, own = std::move(asked)](const Look& at) {
      return (*before && (*before)(at)) || own(at);
    };
  else
    _asked = *_before;
  current = &_asked;
}

Scope::~Scope() { current = _before; }

Asked asked() { return current == nullptr ? Asked() : *current; }

void look(const char* doing, std::size_t done) {
  if (current != nullptr && *current && (*current)({doing, done}))
    throw errors::Error(errors::Reason::cancelled, std::string("stopped while ") + doing);
}

}  // namespace anticrack::stop
