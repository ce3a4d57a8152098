// SPDX-License-Identifier: GPL-3.0-or-later
//
// One line an event on standard error: for people, or JSON for machines. On spdlog.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace anticrack::log {

enum class Format { text, json };

/// To be called once, before anything is logged. `level`: trace, debug, info, warn, error or off.
void start(const std::string& level, Format format);

/// Values are escaped: nothing a client sends can forge a line or a key.
using Fields = std::initializer_list<std::pair<std::string_view, std::string>>;

/// text: 2026-11-21T17:40:00.123+00:00 info job ended job=jobs/ab12 state=SUCCEEDED
/// JSON: {"time":"...","level":"info","event":"job ended","job":"jobs/ab12","state":"SUCCEEDED"}
void info(std::string_view event, const Fields& fields = {});
void warn(std::string_view event, const Fields& fields = {});
void error(std::string_view event, const Fields& fields = {});

}  // namespace anticrack::log
