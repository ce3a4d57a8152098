// SPDX-License-Identifier: GPL-3.0-or-later
//
// Divides lists into pages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "errors/errors.hpp"

namespace anticrack::rpc {

/// A request for a page of a list (AIP-158). The token is the id of the last resource before it.
struct Page {
  std::size_t size = 0;
  std::string after;
};
constexpr std::size_t default_page_size = 50;
constexpr std::size_t max_page_size = 1000;
/// A page ends early if it grows beyond this, since the client's limit is gRPC's 4 MiB.
constexpr std::size_t max_page_bytes = 2u << 20;
/// A page ends early if this many records were read for it.
constexpr std::size_t max_page_records = 1000;

/// The page of a request; size 0 is the default. Throws with "page_size" or "page_token" at fault.
Page to_page(std::int32_t page_size, const std::string& page_token);

/// Fills one page. `list(after, count)` gives records in their order; `add(record)` appends one to
/// the answer and returns its bytes, or 0 if it leaves the record out. A page ends after
/// max_page_records at the latest, however few of them it has. Returns the token of the next page,
/// empty after the last. Records are fetched a few at a time: one may be large, and a page ends at
/// max_page_bytes.
template <class List, class Add>
std::string fill_page(const Page& page, List list, Add add) {
  constexpr std::size_t batch = 16;
  std::string after = page.after;
  std::size_t count = 0;
  std::size_t bytes = 0;
  std::size_t read = 0;
  for (;;) {
    const std::size_t wanted = std::min(batch, page.size - count + 1);
    decltype(list(after, wanted)) records;
    try {
      records = list(after, wanted);
    } catch (const errors::Error& error) {
      if (error.reason() != errors::Reason::not_found) throw;
      if (after != page.after) return after;  // erased meanwhile; the next page says so
      throw errors::Error(errors::Reason::invalid_argument,
                          "the resource this page_token stands for is gone; start the list again")
          .at("page_token");
    }
    for (auto& record : records) {
      if (count == page.size || bytes >= max_page_bytes || read == max_page_records) return after;
      ++read;
      after = record.id;
      const std::size_t added = add(record);  // it may move from the record
      bytes += added;
      count += added > 0 ? 1 : 0;
    }
    if (records.size() < wanted) return {};
  }
}

}  // namespace anticrack::rpc
