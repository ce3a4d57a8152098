// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figures.hpp"

#include <algorithm>
#include <utility>

#include "figures/drawing.hpp"
#include "figures/interface_axis.hpp"
#include "figures/panels.hpp"
#include "figures/surface.hpp"
#include "figures/sweep_figures.hpp"
#include "figures/text.hpp"
#include "words/nearest.hpp"

namespace anticrack::figures {
namespace {

namespace fs = std::filesystem;
using results::Load;
using results::Result;

/// Most triangles drawn: more are too small to see, and each adds 200 bytes to an SVG.
constexpr std::size_t surface_triangles = 24000;

std::string traces_suffix(std::size_t interface) {
  return interface == 0 ? "-traces" : "-traces-" + std::to_string(interface + 1);
}

void draw_traces(const Result& result, const Load& load, const std::string& stem,
                 Drawing& drawing) {
  for (std::size_t i = 0; i < load.traces.size(); ++i)
    drawing.draw(stem + traces_suffix(i), traces_picture(result, load, i));
}

/// A sweep may have kept thousands of rows.
void draw_kept_rows(const Result& result, Drawing& drawing) {
  constexpr std::size_t most = 12;
  for (std::size_t i = 0; i < std::min(most, result.loads.size()); ++i)
    draw_traces(result, result.loads[i], result.loads[i].name, drawing);
  if (result.loads.size() > most) {
    drawing.drawn.notes.push_back("traces drawn of the first " + std::to_string(most) + " of " +
                                  std::to_string(result.loads.size()) + " rows");
  }
}

void draw_load(const Result& result, const Load& load, const std::string& stem, Drawing& drawing) {
  if (load.traces.empty()) {
    drawing.drawn.notes.push_back("load \"" + load.name + "\" has no traces (" +
                                  std::string(results::name(load.status)) + "): nothing to draw");
    return;
  }
  const Surface membrane =
      load.fields.empty() ? Surface{} : surface(result, load, surface_triangles);
  if (membrane.triangles.empty()) {
    drawing.drawn.notes.push_back("load \"" + load.name +
                                  "\": no membrane and no plan drawn, it has no fields; " +
                                  results::fields_cure(result));
  } else {
    drawing.draw(stem, overview_picture(result, load, membrane));
    drawing.draw(stem + "-membrane", membrane_picture(result, load, membrane));
    drawing.draw(stem + "-plan", plan_picture(result, load, membrane));
  }
  draw_traces(result, load, stem, drawing);
  if (has_convergence(load)) drawing.draw(stem + "-convergence", convergence_picture(result, load));
  if (bounded_stages(load) > 1) {
    drawing.draw(stem + "-accuracy", accuracy_picture(result, load));
  } else if (load.stages.size() != 0) {
    drawing.drawn.notes.push_back("load \"" + load.name +
                                  "\": no accuracy drawn, fewer than two stages have bounds");
  }
}

void note_single_steps(const Result& result, Drawing& drawing) {
  const auto count = std::count_if(result.loads.begin(), result.loads.end(), [](const Load& load) {
    return !load.traces.empty() && !has_convergence(load);
  });
  if (count == 0) return;
  drawing.drawn.notes.push_back("no convergence drawn of " + std::to_string(count) +
                                (count == 1 ? " load" : " loads") + " solved in a single step");
}

void require_consistent(const Result& result) {
  const std::string fault = results::first_fault(result);
  if (!fault.empty()) throw Error("the result is inconsistent: " + fault);
}

/// The index of the interface called `name`; of none the most eventful.
std::size_t chosen(const Result& result, const std::string& name) {
  if (name.empty()) return most_eventful(result, result.loads);
  std::vector<std::string> known;
  for (const results::Interface& interface : result.interfaces) known.push_back(interface.name);
  const auto found = std::ranges::find(known, name);
  if (found == known.end())
    throw Error("there is no interface " + name + "; " + words::suggestion(name, known));
  return static_cast<std::size_t>(found - known.begin());
}

}  // namespace

Drawn draw(const Result& result, const fs::path& folder, const Options& options) {
  require_consistent(result);
  std::vector<std::string> names;
  for (const Load& load : result.loads) names.push_back(load.name);
  std::vector<std::string> suffixes{"-membrane", "-plan", "-convergence", "-accuracy"};
  for (std::size_t i = 0; i < result.interfaces.size(); ++i) suffixes.push_back(traces_suffix(i));
  const std::vector<std::string> stems = file_stems(names, suffixes);

  Drawing drawing(folder, options);
  if (result.sweep) {
    draw_sweep(result, drawing);
    draw_kept_rows(result, drawing);
    return std::move(drawing.drawn);
  }
  for (std::size_t i = 0; i < result.loads.size(); ++i)
    draw_load(result, result.loads[i], stems[i], drawing);
  note_single_steps(result, drawing);
  return std::move(drawing.drawn);
}

Drawn draw_together(Result result, const std::string& interface, const fs::path& folder,
                    const Options& options) {
  require_consistent(result);
  std::erase_if(result.loads, [](const Load& load) { return load.traces.empty(); });
  if (result.loads.empty() || result.interfaces.empty())
    throw Error("no load has traces of an interface: nothing to draw together");
  Drawing drawing(folder, options);
  const std::size_t count = result.loads.size();
  if (count > together_limit) {
    result.loads.resize(together_limit);
    drawing.drawn.notes.push_back("the first " + std::to_string(together_limit) + " of " +
                                  std::to_string(count) +
                                  " loads drawn together; choose others with --load");
  }
  drawing.draw("together", together_picture(result, chosen(result, interface)));
  return std::move(drawing.drawn);
}

}  // namespace anticrack::figures
