// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_scanner.hpp"

#include <algorithm>

#include "mesher/mesh_start.hpp"

namespace anticrack::mesher {
namespace {

bool is_space(char c) noexcept { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

}  // namespace

std::string printable(std::string_view text) {
  std::string shown(text.substr(0, 32));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  if (text.size() > shown.size()) shown += "...";
  return shown;
}

void MshScanner::skip_space() noexcept {
  while (_at < _bytes.size() && is_space(_bytes[_at])) ++_at;
}

void MshScanner::skip_mark() noexcept {
  if (_at == 0 && _bytes.starts_with(byte_order_mark)) _at = byte_order_mark.size();
}

bool MshScanner::at_end() noexcept {
  skip_space();
  return _at == _bytes.size();
}

char MshScanner::next() {
  if (at_end()) truncated();
  return _bytes[_at];
}

std::string_view MshScanner::word() {
  if (at_end()) truncated();
  const std::size_t begin = _at;
  while (_at < _bytes.size() && !is_space(_bytes[_at])) ++_at;
  return _bytes.substr(begin, _at - begin);
}

std::string_view MshScanner::rest_of_line() {
  const std::size_t end = _bytes.find('\n', _at);
  if (end == std::string_view::npos) truncated();
  std::string_view line = _bytes.substr(_at, end - _at);
  _at = end + 1;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void MshScanner::expect(std::string_view wanted) {
  const std::string_view found = word();
  if (found != wanted) fail("expected {}, found \"{}\"", wanted, printable(found));
}

bool MshScanner::skip_past(std::string_view wanted) {
  for (std::size_t at = _at;;) {
    at = _bytes.find(wanted, at);
    if (at == std::string_view::npos) return false;
    const std::size_t end = at + wanted.size();
    const bool begins = at == 0 || _bytes[at - 1] == '\n';
    if (begins && (end == _bytes.size() || is_space(_bytes[end]))) {
      _at = end;
      return true;
    }
    at = end;
  }
}

void MshScanner::require_room(std::size_t count, std::size_t least_bytes) const {
  if (count > (_bytes.size() - _at) / least_bytes) {
    fail(
        "announces {} entries, more than the {} bytes that follow can hold; the file is truncated "
        "or "
        "damaged, save it again",
        count, _bytes.size() - _at);
  }
}

std::string MshScanner::place() const {
  const auto at = static_cast<std::ptrdiff_t>(_at);
  const std::string where =
      _binary ? fmt::format("byte {}", _at)
              : fmt::format("line {}", std::count(_bytes.begin(), _bytes.begin() + at, '\n') + 1);
  return fmt::format("{}, {}{}{}", _file, where, _section.empty() ? "" : ", in ", _section);
}

void MshScanner::truncated() const {
  fail("the file ends too early; it is truncated, save it again");
}

}  // namespace anticrack::mesher
