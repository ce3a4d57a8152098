// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace anticrack::metrics {

/// One page over HTTP, made anew for each GET, on a thread of its own. Nobody who connects and says
/// nothing keeps others from it: connections are few, and not for long.
///
/// By libmicrohttpd and not by prometheus-cpp's exposer: that one's threads have 100 kB of stack,
/// of which OpenBLAS and METIS take 90 kB for their thread-local variables.
class HttpPage {
 public:
  /// Listens at HOST:PORT (port 0 picks one) when it returns. `make` must not throw. Throws
  /// std::runtime_error with a sentence where it cannot.
  HttpPage(const std::string& address, std::string path, std::string content_type,
           std::function<std::string()> make);
  /// Waits for a page being made.
  ~HttpPage();
  HttpPage(const HttpPage&) = delete;
  HttpPage& operator=(const HttpPage&) = delete;

  const std::string& address() const noexcept;  ///< HOST:PORT with the real port

 private:
  struct State;
  std::unique_ptr<State> _state;
};

}  // namespace anticrack::metrics
