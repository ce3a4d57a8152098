// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep_text.hpp"

#include <array>
#include <charconv>
#include <utility>
#include <vector>

#include "cli/text.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

using results::SweepSummary;

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

constexpr std::array<const char*, 2> slope_parts{"Bx", "By"};

// "A", or "A fibre" where there are several.
std::string name_of(const char* number, const results::Sweep& sweep, std::size_t inclusion) {
  return sweep.inclusions.size() == 1 ? number : number + (" " + sweep.inclusions[inclusion]);
}

std::string endings(const SweepSummary& counts) {
  std::string text = std::to_string(counts.converged) + " converged";
  const auto add = [&text](std::size_t count, const char* what) {
    text += count > 0 ? ", " + std::to_string(count) + " " + what : std::string();
  };
  add(counts.not_converged, "did not converge");
  add(counts.failed, "failed");
  add(counts.other, "were not solved");
  return text;
}

Json range_json(const SweepSummary::Range& range) {
  return {{"min", range.low}, {"max", range.high}};
}

/// Shortest text that gives the number back.
void append(std::string& text, double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  text.append(buffer.data(), result.ptr);
}

std::string csv_head(const results::Sweep& sweep, std::size_t loads) {
  std::string head = "row";
  for (std::size_t i = 0; i < loads; ++i) head += "," + sweep.loads[i];
  for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
    head += "," + name_of("A", sweep, i);
    for (const char* part : slope_parts)
      if (!sweep.slope.empty()) head += "," + name_of(part, sweep, i);
  }
  return head + ",energy,contact_length,steps,status\n";
}

}  // namespace

std::string sweep_table(const results::Sweep& sweep) {
  const SweepSummary counts = summary(sweep);
  std::string text = counted(sweep.rows(), "row");
  if (!sweep.source.empty()) text += " of " + sanitise(sweep.source);
  text += ": " + endings(counts) + "\n";
  if (counts.converged > 0) {
    text += "at most " + counted(static_cast<std::size_t>(counts.most_steps), "step") +
            ", KKT residuals at most " + number(counts.worst_kkt, 2) + "\n\n";
    std::vector<std::vector<std::string>> rows{{"", "least", "most"}};
    const auto add = [&rows](const std::string& name, const SweepSummary::Range& range) {
      rows.push_back({sanitise(name), number(range.low), number(range.high)});
    };
    for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
      add(name_of("A", sweep, i), counts.displacement[i]);
      for (std::size_t part = 0; part < slope_parts.size() && counts.tilted(i); ++part)
        add(name_of(slope_parts[part], sweep, i), counts.slope[i][part]);
    }
    add("contact length", counts.contact_length);
    add("energy", counts.energy);
    text += table(rows);
  }
  if (!sweep.kept.empty()) text += "traces of " + counted(sweep.kept.size(), "row") + "\n";
  if (!sweep.error.empty()) text += sanitise(sweep.error) + "\n";
  return text;
}

Json sweep_json(const results::Sweep& sweep) {
  const SweepSummary counts = summary(sweep);
  Json inclusions = Json::array();
  for (std::size_t i = 0; i < sweep.inclusions.size(); ++i) {
    Json inclusion{{"name", sweep.inclusions[i]}, {"A", range_json(counts.displacement[i])}};
    for (std::size_t part = 0; part < slope_parts.size(); ++part)
      inclusion[slope_parts[part]] = range_json(counts.slope[i][part]);
    inclusions.push_back(std::move(inclusion));
  }
  return {{"source", sweep.source},
          {"rows", sweep.rows()},
          {"converged", counts.converged},
          {"not_converged", counts.not_converged},
          {"failed", counts.failed},
          {"not_solved", counts.other},
          {"most_steps", counts.most_steps},
          {"worst_kkt", counts.worst_kkt},
          {"error", sweep.error},
          {"loads", sweep.loads},
          {"inclusions", std::move(inclusions)},
          {"contact_length", range_json(counts.contact_length)},
          {"energy", range_json(counts.energy)}};
}

std::string sweep_csv(const results::Sweep& sweep) {
  const std::size_t loads = sweep.coefficients.empty() ? 0 : sweep.loads.size();
  const std::size_t inclusions = sweep.inclusions.size();
  std::string text = csv_head(sweep, loads);
  for (std::size_t row = 0; row < sweep.rows(); ++row) {
    const auto status = sweep.status[row];
    const bool right = status == results::Status::converged;
    const auto add = [&text, right](double value) {
      text += ',';
      if (right) append(text, value);
    };
    text += std::to_string(row);
    for (std::size_t i = 0; i < loads; ++i) {
      text += ',';
      append(text, sweep.coefficients[row * loads + i]);
    }
    for (std::size_t i = 0; i < inclusions; ++i) {
      add(sweep.displacement[row * inclusions + i]);
      for (std::size_t part = 0; part < slope_parts.size() && !sweep.slope.empty(); ++part)
        add(sweep.slope_at(row, i, part));
    }
    add(sweep.energy[row]);
    add(sweep.contact_length[row]);
    text += "," + std::to_string(sweep.steps[row]) + ",";
    text += results::name(status);
    text += '\n';
  }
  return text;
}

}  // namespace anticrack::cli
