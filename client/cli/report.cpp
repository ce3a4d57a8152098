// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report.hpp"

#include <exception>
#include <sstream>
#include <string>

#include "cli/json.hpp"
#include "cli/programs.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

struct Complaint {
  int exit_code = exit_job_failed;
  std::string code;  ///< stable, for scripts
  std::string message;
  client::Details details;
};

Complaint current_complaint() {
  try {
    throw;
  } catch (const client::Interrupted&) {
    return {exit_interrupted, "INTERRUPTED", "interrupted", {}};
  } catch (const client::Error& error) {
    return {exit_code_of(error.code()), std::string(name(error.code())), error.what(),
            error.details()};
  } catch (const LocalServerError& error) {
    return {exit_server, "LOCAL_SERVER", error.what(), {}};
  } catch (const UsageError& error) {
    return {exit_usage, "USAGE", error.what(), {}};
  } catch (const CaseError& error) {
    return {exit_usage, "CASE", error.what(), {}};
  } catch (const results::Error& error) {
    return {exit_usage, "RESULT_FILE", error.what(), {}};
  } catch (const FiguresError& error) {
    return {exit_usage, "FIGURES", error.what(), {}};
  } catch (const std::exception& error) {
    return {exit_usage, "ERROR", error.what(), {}};
  }
}

std::string document_of(const Complaint& complaint) {
  Json fields = Json::array();
  for (const client::FieldViolation& violation : complaint.details.fields)
    fields.push_back({{"field", violation.field}, {"description", violation.description}});
  return to_text({{"error",
                   {{"code", complaint.code},
                    {"reason", complaint.details.reason},
                    {"message", complaint.message},
                    {"fields", std::move(fields)}}}});
}

}  // namespace

int exit_code_of(client::Code code) noexcept {
  switch (code) {
    case client::Code::invalid_argument:
    case client::Code::not_found:
    case client::Code::already_exists:
    case client::Code::failed_precondition:
    case client::Code::out_of_range:
    case client::Code::unimplemented:
      return exit_usage;
    case client::Code::cancelled:
      return exit_interrupted;
    default:
      return exit_server;
  }
}

int guarded(const Globals& globals, const std::function<int()>& command) {
  try {
    return command();
  } catch (...) {
    const Complaint complaint = current_complaint();
    std::istringstream lines(complaint.message);
    for (std::string line; std::getline(lines, line);) complain(line);
    if (globals.json) print_document(document_of(complaint));
    return complaint.exit_code;
  }
}

}  // namespace anticrack::cli
