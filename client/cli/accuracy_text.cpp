// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/live_view.hpp"
#include "cli/progress.hpp"
#include "cli/text.hpp"
#include "results/result.hpp"

namespace anticrack::cli {
namespace {

// The larger of two numbers; an unknown one (NaN) counts as the largest.
double larger(double a, double b) { return std::isnan(a) || b <= a ? a : b; }

double energy_error(const v1::StageAnswer& answer) {
  if (!answer.has_energy_lower() || !answer.has_energy_upper()) return results::unknown;
  const double width = answer.energy_upper() - answer.energy_lower();
  return width > 0 ? width / std::abs(answer.energy()) : 0;
}

// "0.21 % (asked 0.1 %)"
std::string error_text(double error, double asked) {
  if (!(asked > 0)) return per_cent(error);
  return pad_left(number(100 * error, 3), 6) + " % (asked " + number(100 * asked, 6) + " %)";
}

// What is told of a stage, each with its error: of A unless the mesh has no inclusion, and of its
// estimate where that is asked for or known beside the proof.
std::vector<std::pair<std::string, std::string>> errors_told(const StageErrors& stage,
                                                             const v1::Accuracy& asked) {
  std::vector<std::pair<std::string, std::string>> told{
      {"energy", error_text(stage.energy, asked.energy())}};
  const bool estimated = asked.has_displacement_estimated();
  if (!asked.has_displacement() && !estimated && !std::isfinite(stage.displacement)) return told;
  told.emplace_back("A", error_text(stage.displacement, asked.displacement()));
  if (estimated || (asked.has_displacement() && std::isfinite(stage.probable)))
    told.emplace_back("probably", error_text(stage.probable, asked.displacement_estimated()));
  return told;
}

double fraction_of(const StageErrors& stage, const v1::Accuracy& asked) {
  double fraction = 1;
  if (asked.has_energy()) fraction = bar_fraction(stage.energy, asked.energy());
  if (asked.has_displacement())
    fraction = std::min(fraction, bar_fraction(stage.displacement, asked.displacement()));
  if (asked.has_displacement_estimated())
    fraction = std::min(fraction, bar_fraction(stage.probable, asked.displacement_estimated()));
  return fraction;
}

// "energy 0.21 % (asked 0.1 %), A 0.8 %"; `scale` stands behind the error of A.
std::string errors_text(const StageErrors& stage, const v1::Accuracy& asked,
                        const std::string& scale = "") {
  std::string text;
  for (auto& [name, error] : errors_told(stage, asked)) {
    error.erase(0, error.find_first_not_of(' '));
    if (name == "A") error.insert(error.find('%') + 1, scale);
    text += (text.empty() ? "" : ", ") + name + " " + error;
  }
  return text;
}

// The value to which the error of A is relative, if there are several inclusions.
std::string scale_of(const v1::Job& job) {
  const auto several = [](const v1::LoadCaseAnswer& answer) {
    return answer.inclusions_size() > 1;
  };
  if (std::ranges::none_of(job.status().answers(), several)) return "";
  return job.spec().accuracy().largest() ? " of the largest A" : " of each A";
}

}  // namespace

StageErrors errors_of(const v1::Stage& stage) {
  StageErrors errors;
  for (const v1::StageAnswer& answer : stage.answers()) {
    const auto take = [&answer](double& largest, const char* name) {
      largest = larger(largest, results::number_in(answer, name));
    };
    errors.energy = larger(errors.energy, energy_error(answer));
    take(errors.displacement, "displacement_error");
    take(errors.probable, "displacement_error_probable");
  }
  return errors;
}

std::vector<v1::Stage> stages_of(const v1::Job& job) {
  std::vector<v1::Stage> stages;
  for (const v1::Stage& stage : job.status().stages())
    if (stage.answers_size() > 0) stages.push_back(stage);
  return stages;
}

std::vector<std::string> stage_lines(const std::vector<v1::Stage>& stages,
                                     const v1::Accuracy& asked, std::size_t width,
                                     std::size_t count) {
  const bool foretold = count > 0 && !stages.empty() && !stages.back().forecast().empty();
  if (foretold) --count;
  std::vector<std::string> lines;
  for (std::size_t i = stages.size() - std::min(stages.size(), count); i < stages.size(); ++i) {
    std::string line = "  stage " + pad_left(std::to_string(i + 1), 2) + "  " +
                       pad_left(std::to_string(stages[i].triangles()), 8) + " triangles";
    for (const auto& [name, error] : errors_told(errors_of(stages[i]), asked))
      line += "   " + name + " " + error;
    lines.push_back(std::move(line));
  }
  std::size_t widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, line.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const StageErrors errors = errors_of(stages[stages.size() - lines.size() + i]);
    if (widest + bar_room <= width)
      lines[i] = pad_right(lines[i], widest) + bar(fraction_of(errors, asked), width - widest);
    lines[i] = fit(lines[i], width);
  }
  if (foretold) lines.push_back(fit("  " + sanitise(stages.back().forecast()), width));
  return lines;
}

std::string stage_text(std::size_t number, const v1::Stage& stage, const v1::Accuracy& asked) {
  return fmt::format("stage {}: {} triangles, {}", number, stage.triangles(),
                     errors_text(errors_of(stage), asked)) +
         (stage.forecast().empty() ? "" : "; " + sanitise(stage.forecast()));
}

std::string accuracy_text(const v1::Job& job) {
  std::string text;
  if (const auto stages = stages_of(job); !stages.empty()) {
    const v1::Stage& last = stages.back();
    text = fmt::format("accuracy: {}; {}, {} triangles, {} s\n",
                       errors_text(errors_of(last), job.spec().accuracy(), scale_of(job)),
                       counted(stages.size(), "stage"), last.triangles(), seconds(last.seconds()));
  }
  if (!job.status().not_reached().empty())
    text += "not reached: " + sanitise(job.status().not_reached()) + "\n";
  return text;
}

}  // namespace anticrack::cli
