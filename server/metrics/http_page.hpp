// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace anticrack::metrics {

/// Serves one page over HTTP, made anew for each GET, on a separate thread. Idle connections are
/// closed, and if there are too many, the oldest is, so that no client can keep out another.
///
/// Uses libmicrohttpd instead of prometheus-cpp's exposer, whose threads have 100 kB of stack:
/// thread-local variables of OpenBLAS and METIS take 90 kB of it.
class HttpPage {
 public:
  /// Listens at HOST:PORT (port 0: any free port) when it returns. `make` must not throw. There is
  /// also /ready, 200 or 503 as ready() says. Throws std::runtime_error if the address cannot be
  /// used.
  HttpPage(const std::string& address, std::string path, std::string content_type,
           std::function<std::string()> make, std::function<bool()> ready);
  /// Waits until a page that is being made is done.
  ~HttpPage();
  HttpPage(const HttpPage&) = delete;
  HttpPage& operator=(const HttpPage&) = delete;

  const std::string& address() const noexcept;  ///< HOST:PORT with the real port

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::metrics
