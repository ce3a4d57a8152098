// SPDX-License-Identifier: GPL-3.0-or-later
//
// The file of tokens, and a token looked for in it.
#include <algorithm>

#include "access/tokens.hpp"
#include "errors/errors.hpp"
#include "fuzz/input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace anticrack;
  const std::string_view text = fuzz::text_of(data, size);
  try {
    const auto table = access::TokenTable::parse(text, "tokens");
    fuzz::require(!table.find(text.substr(0, 64)), "what is not a token opens");
  } catch (const errors::Error&) {
  }
  return 0;
}
