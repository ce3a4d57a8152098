// SPDX-License-Identifier: GPL-3.0-or-later
//
// A log on standard error with one line per event, as text or JSON. Uses spdlog.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace anticrack::log {

enum class Format { text, json };

/// Call it once before logging. `level`: trace, debug, info, warn, error or off.
void start(const std::string& level, Format format);

/// Values are escaped, so that clients cannot forge lines or keys.
using Fields = std::initializer_list<std::pair<std::string_view, std::string>>;

/// text: 2026-11-21T17:40:00.123+00:00 info job ended job=jobs/ab12 state=SUCCEEDED
/// JSON: {"time":"...","level":"info","event":"job ended","job":"jobs/ab12","state":"SUCCEEDED"}
void info(std::string_view event, const Fields& fields = {});
void warn(std::string_view event, const Fields& fields = {});
void error(std::string_view event, const Fields& fields = {});

}  // namespace anticrack::log
