// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "casefile/sections.hpp"
#include "words/nearest_field.hpp"

namespace anticrack::casefile {
namespace {

std::optional<double> read_error(const Section& section, const char* key) {
  constexpr double least = 1e-6;
  const auto error = section.number(key);
  if (error && !(*error >= least && *error <= 1)) {
    throw Error(section.spot_of(key),
                shown(*section.find(key)) +
                    " is out of range; write a relative error from 1e-6 to 1, as 1e-3");
  }
  return error;
}

// Stages are on meshes that nobody has seen yet.
void refuse_arrays(const Case& result) {
  for (const ForceFile& file : result.force_files) {
    throw Error(result.spots.at(entry_field("load_cases", file.load_case) + ".force"),
                "values in a file belong to one mesh, and [accuracy] refines it; write f as an "
                "expression");
  }
}

}  // namespace

void read_accuracy(const Section& root, Case& result) {
  const auto section = root.section(
      "accuracy", {"energy", "A", "each_inclusion", "max_triangles", "time", "keep_stages"});
  if (!section) return;
  v1::Accuracy& accuracy = *result.job.mutable_accuracy();
  note(*section, "accuracy", result.spots);
  if (section->find("A")) result.spots["accuracy.displacement"] = section->spot_of("A");
  if (const auto error = read_error(*section, "energy")) accuracy.set_energy(*error);
  if (const auto error = read_error(*section, "A")) accuracy.set_displacement(*error);
  if (!accuracy.has_energy() && !accuracy.has_displacement())
    throw Error(section->spot(), "no accuracy; write energy = 1e-3, A = 1e-3, or both");
  if (const auto most = section->count("max_triangles"))
    accuracy.set_max_triangles(static_cast<std::uint64_t>(*most));
  if (const auto time = read_time(*section, "time")) *accuracy.mutable_time() = *time;
  if (section->find("each_inclusion") && !accuracy.has_displacement())
    throw Error(section->spot_of("each_inclusion"), "is about A; write A = 1e-2 with it");
  accuracy.set_each_inclusion(section->boolean("each_inclusion").value_or(false));
  accuracy.set_keep_stages(section->boolean("keep_stages").value_or(false));
  if (result.job.solver().has_uzawa()) {
    throw Error(*words::nearest_field(result.spots, "solver.uzawa"),
                "the answers of \"uzawa\" have no bounds; with [accuracy] write method = "
                "\"active-set\"");
  }
  refuse_arrays(result);
}

}  // namespace anticrack::casefile
