// SPDX-License-Identifier: GPL-3.0-or-later
//
// store_driver FOLDER: does every operation on a store there, and says so on standard output as
// each is acknowledged ("done 3") or refused ("refused 3 DISK_FULL"); what is refused is tried
// again. Ends with 3 where something is refused over and over.
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include "store/operations.hpp"

namespace {

using namespace anticrack;

constexpr int attempts = 4;

void say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

template <class Call>
void insist(const std::string& name, const Call& call) {
  for (int i = 0; i < attempts; ++i) {
    try {
      call();
      return;
    } catch (const errors::Error& error) {
      say("refused " + name + ' ' + std::string(errors::name(error.reason())) + ' ' + error.what());
    }
  }
  std::exit(3);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::unique_ptr<store::Store> opened;
  const auto start = [&] {
    opened.reset();
    insist("open", [&] { opened = store::open({argv[1], 0}); });
  };
  start();
  const auto operations = store::operations();
  for (std::size_t i = 0; i < operations.size(); ++i) {
    if (i == store::second_start) start();
    insist(std::to_string(i), [&] { operations[i](*opened); });
    say("done " + std::to_string(i));
  }
  opened.reset();
  return 0;
}
