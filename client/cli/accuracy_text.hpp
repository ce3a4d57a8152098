// SPDX-License-Identifier: GPL-3.0-or-later
//
// The progress of a job with an accuracy, as text. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "anticrack/v1/solve.pb.h"

namespace anticrack::cli {

/// A stage that has ended. The errors are those for which Accuracy asks: relative, and the largest
/// of all load cases; NaN if a load case has no bounds.
struct StageErrors {
  std::string mesh;  ///< "meshes/ID"
  std::uint64_t triangles = 0;
  double energy = 0;
  double displacement = 0;
  double probable = 0;        ///< of A by estimate
  double seconds = 0;         ///< since the first stage began
  std::string forecast = {};  ///< what cannot be proved within the limits
};

/// The errors of a stage that has ended.
StageErrors errors_of(const v1::Stage& stage);

/// The stages of a job that have ended.
std::vector<StageErrors> stages_of(const v1::Job& job);

/// "  stage 4    12345 triangles   energy  0.213 % (asked 0.1 %)   A 0.8 %  [######----]" for each
/// of the last stages, at most `count`. The bar is full if everything asked for is reached; a
/// narrow terminal has none.
std::vector<std::string> stage_lines(const std::vector<StageErrors>& stages,
                                     const v1::Accuracy& asked, std::size_t width,
                                     std::size_t count);

/// "stage 4: 12345 triangles, energy 0.213 % (asked 0.1 %), A 0.8 %, probably
/// 0.02 %", and the forecast.
std::string stage_text(std::size_t number, const StageErrors& stage, const v1::Accuracy& asked);

/// The text below the answers: what was reached on which mesh, and what was not and why. Empty for
/// a job without accuracy.
std::string accuracy_text(const v1::Job& job);

}  // namespace anticrack::cli
