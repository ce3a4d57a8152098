// SPDX-License-Identifier: GPL-3.0-or-later
//
// Expressions in x and y. -max_len is the server's bound of their length.
#include "expression/function.hpp"

#include <string>

#include "errors/errors.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace anticrack;
  try {
    const expression::Function f(std::string(fuzz::text_of(data, size)), "force.expression");
    for (const double x : {-1.0, 0.0, 0.25, 1e300}) {
      try {
        const double once = f(x, 1 - x);
        fuzz::require(once == f(x, 1 - x), "a second evaluation gives another value");
      } catch (const errors::Error&) {  // not finite here
      }
    }
  } catch (const errors::Error& error) {
    fuzz::require(error.reason() != errors::Reason::internal, "muParser reads another expression");
  }
  return 0;
}
