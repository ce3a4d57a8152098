// SPDX-License-Identifier: GPL-3.0-or-later
//
// What a benchmark program measures, and how it prints it: one JSON object on standard output.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace anticrack::benchmarks {

/// Seconds of the same thing done again and again, entry i of both from the same time.
struct Times {
  std::vector<double> wall;
  std::vector<double>
      cpu;  ///< of all threads of the process, and of the server's where there is one
};

/// Runs from construction. `server`: a process whose CPU time is counted as well; 0: none.
class Stopwatch {
 public:
  explicit Stopwatch(int server = 0);
  /// Adds the time since the start, divided by `parts`, to `times`.
  void stop(Times& times, double parts = 1) const;

 private:
  int _server;
  double _wall, _cpu;
};

/// Waits until the threads that OpenBLAS makes at the start of a process, and none of our programs
/// uses, have fallen asleep: they spin for a tenth of a second on a core of their own.
void let_blas_fall_asleep();

/// A JSON object in the order of the calls.
class Figures {
 public:
  void set(const std::string& name, double value);
  void set(const std::string& name, const std::vector<double>& values);
  void set(const std::string& name, const std::string& text);
  void set(const std::string& name, const Times& times);  ///< {"wall": [...], "cpu": [...]}
  void set(const std::string& name, const Figures& figures);
  void set(const std::string& name, const std::vector<Figures>& list);

  std::string json() const;
  /// On standard output, with a new line.
  void print() const;

 private:
  std::vector<std::pair<std::string, std::string>> _entries;  // name, value in JSON
};

}  // namespace anticrack::benchmarks
