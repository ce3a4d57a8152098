// SPDX-License-Identifier: GPL-3.0-or-later
#include "log/log.hpp"

#include <fmt/core.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <memory>
#include <utility>

#include "log/escape.hpp"

namespace anticrack::log {
namespace {

struct Logger {
  std::shared_ptr<spdlog::logger> to;
  Format format = Format::text;
};

/// Set by start() before any thread logs.
Logger& current() {
  static Logger logger;
  return logger;
}

std::string text_line(std::string_view event, const Fields& fields) {
  std::string line = escape(event);
  for (const auto& [key, value] : fields)
    line += fmt::format(" {}={}", escape(key), quote_if_needed(value.text()));
  return line;
}

/// The members of a JSON line; the pattern adds time, level and braces.
std::string json_members(std::string_view event, const Fields& fields) {
  std::string line = fmt::format(R"("event":"{}")", escape(event));
  for (const auto& [key, value] : fields) {
    line += fmt::format(R"(,"{}":)", escape(key));
    line += value.is_number() ? value.text() : fmt::format(R"("{}")", escape(value.text()));
  }
  return line;
}

/// %* in a pattern: the text of a line logged through spdlog itself, escaped.
class EscapedText : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& line) override {
    const std::string text =
        escape(std::string_view(message.payload.data(), message.payload.size()));
    line.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<EscapedText>();
  }
};

std::shared_ptr<spdlog::logger> make_logger(const std::string& level, const std::string& pattern) {
  auto logger = std::make_shared<spdlog::logger>("anticrackd",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<EscapedText>('*').set_pattern(pattern);
  logger->set_formatter(std::move(formatter));
  logger->set_level(spdlog::level::from_str(level));
  return logger;
}

void write(spdlog::level::level_enum level, std::string_view event, const Fields& fields) {
  const Logger& logger = current();
  if (!logger.to || !logger.to->should_log(level)) return;
  const std::string line =
      logger.format == Format::json ? json_members(event, fields) : text_line(event, fields);
  logger.to->log(level, spdlog::string_view_t(line));
}

}  // namespace

Value::Value(double number)
    : _text(std::isfinite(number) ? fmt::format("{:.3f}", number) : "null"), _is_number(true) {}

void start(const std::string& level, Format format) {
  const bool json = format == Format::json;
  const std::string json_begin = R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",)";
  const std::string text_begin = "%Y-%m-%dT%H:%M:%S.%e%z %l ";
  current() = {make_logger(level, json ? json_begin + "%v}" : text_begin + "%v"), format};
  // for libraries that log through spdlog
  spdlog::set_default_logger(
      make_logger(level, json ? json_begin + R"("event":"%*"})" : text_begin + "%*"));
}

void info(std::string_view event, const Fields& fields) {
  write(spdlog::level::info, event, fields);
}

void warn(std::string_view event, const Fields& fields) {
  write(spdlog::level::warn, event, fields);
}

void error(std::string_view event, const Fields& fields) {
  write(spdlog::level::err, event, fields);
}

}  // namespace anticrack::log
