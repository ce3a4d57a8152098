// SPDX-License-Identifier: GPL-3.0-or-later
#include "log/log.hpp"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "log/escape.hpp"

namespace anticrack::log {
namespace {

struct Logger {
  std::shared_ptr<spdlog::logger> to;
  Format format = Format::text;
};

/// Written by start() alone, before there are threads that log.
Logger& current() {
  static Logger logger;
  return logger;
}

std::string text_line(std::string_view event, const Fields& fields) {
  std::string line = escape(event);
  for (const auto& [key, value] : fields) {
    line += ' ';
    line += escape(key);
    line += '=';
    line += quote_if_needed(value);
  }
  return line;
}

/// The pattern puts time and level before it and closes the object.
std::string json_members(std::string_view event, const Fields& fields) {
  std::string line = "\"event\":\"";
  line += escape(event);
  line += '"';
  for (const auto& [key, value] : fields) {
    line += ",\"";
    line += escape(key);
    line += "\":\"";
    line += escape(value);
    line += '"';
  }
  return line;
}

void write(spdlog::level::level_enum level, std::string_view event, const Fields& fields) {
  const Logger& logger = current();
  if (!logger.to || !logger.to->should_log(level)) return;
  const std::string line =
      logger.format == Format::json ? json_members(event, fields) : text_line(event, fields);
  logger.to->log(level, spdlog::string_view_t(line));
}

}  // namespace

void start(const std::string& level, Format format) {
  auto sink = std::make_shared<spdlog::sinks::stderr_sink_mt>();
  auto logger = std::make_shared<spdlog::logger>("anticrackd", std::move(sink));
  logger->set_pattern(format == Format::json
                          ? R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%v})"
                          : "%Y-%m-%dT%H:%M:%S.%e%z %l %v");
  logger->set_level(spdlog::level::from_str(level));
  current() = {std::move(logger), format};
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
