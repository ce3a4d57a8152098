// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/pages.hpp"

#include "api/names.hpp"

namespace anticrack::rpc {

using errors::Error;
using errors::Reason;

Page to_page(std::int32_t page_size, const std::string& page_token) {
  if (page_size < 0 || page_size > static_cast<std::int32_t>(max_page_size)) {
    throw Error(Reason::invalid_argument,
                "page_size {} is not between 0 (the default of {}) and {}", page_size,
                default_page_size, max_page_size)
        .at("page_size");
  }
  if (!page_token.empty() && !api::is_id(page_token)) {
    throw Error(Reason::invalid_argument,
                "page_token is none that this server gave; leave it empty to start again")
        .at("page_token");
  }
  return {page_size == 0 ? default_page_size : static_cast<std::size_t>(page_size), page_token};
}

}  // namespace anticrack::rpc
