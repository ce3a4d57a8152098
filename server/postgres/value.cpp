// SPDX-License-Identifier: GPL-3.0-or-later
#include "postgres/value.hpp"

namespace anticrack::postgres {

namespace {

constexpr unsigned bytea_list = 1001, text_list = 1009, bigint_list = 1016;

/// The lowest bytes of a number, in the network's order.
std::string network(std::uint64_t number, unsigned bytes) {
  std::string text;
  for (unsigned i = bytes; i-- > 0;) text += static_cast<char>((number >> (8 * i)) & 0xffU);
  return text;
}

std::vector<std::string> encoded(const std::vector<std::int64_t>& numbers) {
  std::vector<std::string> elements;
  elements.reserve(numbers.size());
  for (const std::int64_t number : numbers)
    elements.push_back(network(static_cast<std::uint64_t>(number), 8));
  return elements;
}

}  // namespace

Value::Value(unsigned type, std::optional<std::int64_t> number) : _type(type), _null(!number) {
  if (number) _own = network(static_cast<std::uint64_t>(*number), type == boolean ? 1 : 8);
}

/// An array of one dimension: dimensions, whether there are nulls, type, length, lower bound, and
/// each element after its length.
Value::Value(unsigned type, unsigned element, const std::vector<std::string>& elements)
    : _type(type) {
  _own = network(elements.empty() ? 0 : 1, 4) + network(0, 4) + network(element, 4);
  if (elements.empty()) return;
  _own += network(elements.size(), 4) + network(1, 4);
  for (const std::string& one : elements) (_own += network(one.size(), 4)) += one;
}

Value::Value(const std::vector<std::string>& texts) : Value(text_list, text_type, texts) {}

Value::Value(const std::vector<std::int64_t>& numbers)
    : Value(bigint_list, bigint, encoded(numbers)) {}

Value Value::bytes(std::string_view bytes) { return {bytea, bytes}; }

Value Value::bytes(std::span<const std::byte> bytes) {
  return {bytea, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())};
}

Value Value::list_of_bytes(const std::vector<std::string>& list) {
  return {bytea_list, bytea, list};
}

}  // namespace anticrack::postgres
