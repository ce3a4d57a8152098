// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/figures.hpp"

#include <time.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

namespace anticrack::benchmarks {
namespace {

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double cpu_seconds(int server) {
  clockid_t other{};
  const bool there = server != 0 && clock_getcpuclockid(server, &other) == 0;
  return seconds(CLOCK_PROCESS_CPUTIME_ID) + (there ? seconds(other) : 0);
}

std::string number(double value) {
  if (!std::isfinite(value)) return "null";  // JSON has no other word for it
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.17g", value);
  return text.data();
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result + '"';
}

template <class T, class Encode>
std::string list(const std::vector<T>& values, Encode&& encode) {
  std::string result = "[";
  for (const T& value : values) {
    if (result.size() > 1) result += ", ";
    result += encode(value);
  }
  return result + ']';
}

}  // namespace

Stopwatch::Stopwatch(int server)
    : _server(server), _wall(seconds(CLOCK_MONOTONIC)), _cpu(cpu_seconds(server)) {}

void Stopwatch::stop(Times& times, double parts) const {
  times.wall.push_back((seconds(CLOCK_MONOTONIC) - _wall) / parts);
  times.cpu.push_back((cpu_seconds(_server) - _cpu) / parts);
}

void let_blas_fall_asleep() { std::this_thread::sleep_for(std::chrono::milliseconds(500)); }

void Figures::set(const std::string& name, double value) {
  _entries.emplace_back(name, number(value));
}

void Figures::set(const std::string& name, const std::vector<double>& values) {
  _entries.emplace_back(name, list(values, number));
}

void Figures::set(const std::string& name, const std::string& text) {
  _entries.emplace_back(name, quoted(text));
}

void Figures::set(const std::string& name, const Times& times) {
  Figures both;
  both.set("wall", times.wall);
  both.set("cpu", times.cpu);
  set(name, both);
}

void Figures::set(const std::string& name, const Figures& figures) {
  _entries.emplace_back(name, figures.json());
}

void Figures::set(const std::string& name, const std::vector<Figures>& all) {
  _entries.emplace_back(name, list(all, [](const Figures& figures) { return figures.json(); }));
}

std::string Figures::json() const {
  std::string result = "{";
  for (const auto& [name, value] : _entries) {
    if (result.size() > 1) result += ", ";
    result += quoted(name);
    result += ": ";
    result += value;
  }
  return result + '}';
}

void Figures::print() const { std::printf("%s\n", json().c_str()); }

}  // namespace anticrack::benchmarks
