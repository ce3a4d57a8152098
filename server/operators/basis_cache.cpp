// SPDX-License-Identifier: GPL-3.0-or-later
#include "operators/basis_cache.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <exception>
#include <iterator>
#include <variant>

#include "errors/errors.hpp"
#include "fields/walk.hpp"
#include "operators/row_tips.hpp"
#include "operators/shared_bounds.hpp"

namespace anticrack::operators {
namespace {

std::size_t bytes_of(const Eigen::VectorXd& vector) {
  return sizeof(double) * static_cast<std::size_t>(vector.size());
}

void append(std::string& key, std::uint64_t value) {
  for (int shift = 0; shift < 64; shift += 8)
    key.push_back(static_cast<char>(value >> shift & 0xff));
}

void append(std::string& key, double value) { append(key, std::bit_cast<std::uint64_t>(value)); }

/// Appends the length too, so that different lists never give the same bytes.
void append(std::string& key, const std::string& text) {
  append(key, std::uint64_t{text.size()});
  key += text;
}

}  // namespace

std::optional<std::string> key_of(std::span<const fem::Load* const> loads, Bounds bounds,
                                  bool tips) {
  std::string key{static_cast<char>(bounds), tips ? 't' : '-'};
  for (const fem::Load* load : loads) {
    const auto* array = std::get_if<fem::Array>(&load->force);
    if (array != nullptr && array->upload.empty()) return std::nullopt;
    fields::for_each(*load, [&key](const auto& field) {
      if (field.name != "name")
        fields::walk(field.value, [&key](const auto& leaf) { append(key, leaf); });
    });
  }
  return key;
}

struct BasisCache::Flight {
  bool landed = false;
  Basis basis;
  std::optional<errors::Error> error;
};

std::size_t CondensedBasis::bytes() const noexcept {
  std::size_t bytes = sizeof(*this) + reduced.bytes();
  for (const LoadOnTraces& load : loads) {
    bytes += sizeof(load) + sizeof(contact::InclusionForce) * load.inclusion_forces.capacity();
    for (const ddm::CondensedLoad& part : load.subdomains) {
      bytes += sizeof(part) + bytes_of(part.g) + bytes_of(part.z_interior) +
               bytes_of(part.g_boundary) + bytes_of(part.dirichlet) +
               bytes_of(part.dirichlet_force) + bytes_of(part.on_dirichlet) +
               bytes_of(part.z_boundary);
    }
  }
  for (const BalancedLoad& load : balanced) bytes += sizeof(load) + load.bytes();
  for (const ddm::LoadProducts& product : products)
    bytes += sizeof(double) * static_cast<std::size_t>(product.energy.size() + product.norm.size());
  return bytes + (shared ? shared->bytes() : 0) + (tips ? tips->bytes() : 0);
}

BasisCache::Basis BasisCache::get(const std::string& key, const std::stop_token& stop,
                                  const std::function<Basis()>& make) {
  std::unique_lock lock(_mutex);
  for (;;) {
    const auto found = std::find_if(_entries.begin(), _entries.end(),
                                    [&key](const Entry& entry) { return entry.key == key; });
    if (found != _entries.end()) {
      _entries.splice(_entries.begin(), _entries, found);
      return found->basis;
    }
    const auto under_way = _flights.find(key);
    if (under_way == _flights.end()) break;
    const std::shared_ptr<Flight> flight = under_way->second;
    if (!_landed.wait(lock, stop, [&flight] { return flight->landed; }))
      throw errors::Error(errors::Reason::cancelled, "stopped while loads were condensed");
    if (flight->basis) return flight->basis;
    if (flight->error && flight->error->reason() != errors::Reason::cancelled)
      throw errors::Error(*flight->error);
  }
  const auto flight = std::make_shared<Flight>();
  _flights.emplace(key, flight);
  lock.unlock();
  std::exception_ptr failure;
  try {
    flight->basis = make();
  } catch (const errors::Error& error) {
    flight->error = error;
    failure = std::current_exception();
  } catch (...) {
    failure = std::current_exception();
  }
  Entries evicted;  // freed without the lock
  lock.lock();
  flight->landed = true;
  _flights.erase(key);
  if (flight->basis) keep(key, flight->basis, evicted);
  _landed.notify_all();
  lock.unlock();
  if (failure) std::rethrow_exception(failure);
  return flight->basis;
}

void BasisCache::keep(const std::string& key, const Basis& basis, Entries& evicted) {
  const std::size_t bytes = basis->bytes() + key.size();
  if (bytes > most_bytes) return;
  _entries.push_front({key, basis, bytes});
  _bytes += bytes;
  while (_entries.size() > most_bases || _bytes > most_bytes) {
    _bytes -= _entries.back().bytes;
    evicted.splice(evicted.end(), _entries, std::prev(_entries.end()));
  }
}

}  // namespace anticrack::operators
