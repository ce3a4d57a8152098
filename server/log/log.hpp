// SPDX-License-Identifier: GPL-3.0-or-later
//
// A log on standard error with one line per event, as text or JSON. Uses spdlog.
#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace anticrack::log {

enum class Format { text, json };

/// Call it once before logging. `level`: trace, debug, info, warn, error or off.
void start(const std::string& level, Format format);

/// A text, or a number, which has no quotes in JSON.
class Value {
 public:
  template <class Text>
  requires std::convertible_to<Text, std::string> Value(Text&& text)
      : _text(std::forward<Text>(text)) {}
  template <std::integral Number>
  Value(Number number) : _text(std::to_string(number)), _is_number(true) {}
  /// A number with three decimals, as for seconds; null in JSON if it is not finite.
  Value(double number);

  const std::string& text() const noexcept { return _text; }
  bool is_number() const noexcept { return _is_number; }

 private:
  std::string _text;
  bool _is_number = false;
};

/// Values are escaped, so that clients cannot forge lines or keys.
using Fields = std::initializer_list<std::pair<std::string_view, Value>>;

/// text: 2026-11-21T17:40:00.123+00:00 info job ended job=jobs/ab12 attempt=1
/// JSON: {"time":"...","level":"info","event":"job ended","job":"jobs/ab12","attempt":1}
void info(std::string_view event, const Fields& fields = {});
void warn(std::string_view event, const Fields& fields = {});
void error(std::string_view event, const Fields& fields = {});

}  // namespace anticrack::log
