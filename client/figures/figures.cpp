// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figures.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
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

/// More loads, rows and interfaces than this are drawn where they are asked for.
constexpr std::size_t many = 12;

std::string traces_suffix(std::size_t interface) {
  return interface == 0 ? "-traces" : "-traces-" + std::to_string(interface + 1);
}

bool named(const Options& options, std::string_view figure) {
  return std::ranges::find(options.only, figure) != options.only.end();
}

bool wanted(const Options& options, std::string_view figure) {
  return options.only.empty() || named(options, figure);
}

/// The index of the interface that is asked for; none: no interface is.
std::optional<std::size_t> asked_for(const Result& result, const Options& options) {
  if (options.interface.empty()) return std::nullopt;
  std::vector<std::string> known;
  for (const results::Interface& interface : result.interfaces) known.push_back(interface.name);
  const auto found = std::ranges::find(known, options.interface);
  if (found == known.end())
    throw Error("there is no interface " + options.interface + "; " +
                words::suggestion(options.interface, known));
  return static_cast<std::size_t>(found - known.begin());
}

Eventful eventful(const Result& result, const std::vector<Load>& loads, const Options& options) {
  const auto asked = asked_for(result, options);
  return asked ? Eventful{*asked, *asked} : most_eventful(result, loads);
}

std::vector<std::size_t> opening(const Result& result) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < result.interfaces.size(); ++i)
    if (can_open(result.interfaces[i])) found.push_back(i);
  return found;
}

/// Whether of the interfaces that can open only the most eventful is drawn.
bool chooses(const Result& result, const Options& options) {
  return !options.all_interfaces && options.interface.empty() && !named(options, "traces") &&
         opening(result).size() > many;
}

/// Those whose traces are drawn.
std::vector<std::size_t> drawn_interfaces(const Result& result, const Load& load,
                                          const Options& options) {
  if (const auto asked = asked_for(result, options)) return {*asked};
  if (!chooses(result, options)) return opening(result);
  const Eventful most = most_eventful(result, {load});
  if (most.open == most.pressed) return {most.open};
  return {std::min(most.open, most.pressed), std::max(most.open, most.pressed)};
}

void draw_traces(const Result& result, const Load& load, const std::string& stem,
                 const Options& options, Drawing& drawing) {
  if (!wanted(options, "traces") || load.traces.empty()) return;
  for (const std::size_t i : drawn_interfaces(result, load, options))
    drawing.draw(stem + traces_suffix(i), traces_picture(result, load, i));
}

void note_interfaces_left_out(const Result& result, const Options& options, Drawing& drawing) {
  if (!wanted(options, "traces") || !chooses(result, options)) return;
  drawing.drawn.notes.push_back("of " + std::to_string(opening(result).size()) +
                                " interfaces that can open the most eventful is drawn; --all draws "
                                "the traces of each, --interface NAME those of one");
}

/// How many of them are drawn; a note where not all are.
std::size_t first_of(std::size_t count, const char* what, const char* other, const Options& options,
                     Drawing& drawing) {
  if (options.all_loads || count <= many) return count;
  drawing.drawn.notes.push_back("the first " + std::to_string(many) + " of " +
                                std::to_string(count) + " " + what + " drawn; --load " + other +
                                " chooses others, --all draws all");
  return many;
}

void note_interfaces_that_cannot_open(const Result& result, const Options& options,
                                      Drawing& drawing) {
  if (!wanted(options, "traces") || !options.interface.empty()) return;
  std::vector<std::string> closed;
  for (const results::Interface& interface : result.interfaces)
    if (!can_open(interface)) closed.push_back(interface.name);
  if (closed.empty()) return;
  drawing.drawn.notes.push_back(
      (closed.size() == 1
           ? "an interface is glued or bonded all along and has no traces drawn"
           : std::to_string(closed.size()) +
                 " interfaces are glued or bonded all along and have no traces drawn") +
      std::string("; --interface ") + closed[0] + " draws them");
}

/// A sweep may have kept thousands of rows.
void draw_kept_rows(const Result& result, const Options& options, Drawing& drawing) {
  const std::size_t count =
      first_of(result.loads.size(), "rows with traces", "row-K", options, drawing);
  for (std::size_t i = 0; i < count; ++i)
    draw_traces(result, result.loads[i], result.loads[i].name, options, drawing);
}

/// Of fewer no convergence is drawn.
std::size_t fewest_steps(const Options& options) { return named(options, "convergence") ? 2 : 3; }

/// The overview, the membrane and the plan.
void draw_fields(const Result& result, const Load& load, const std::string& stem,
                 const Options& options, Drawing& drawing) {
  const bool overview = wanted(options, "overview"), membrane = wanted(options, "membrane"),
             plan = wanted(options, "plan");
  if (!overview && !membrane && !plan) return;
  const Surface shape = load.fields.empty() ? Surface{} : surface(result, load, surface_triangles);
  if (shape.triangles.empty()) {
    drawing.drawn.notes.push_back("load \"" + load.name +
                                  "\": no membrane and no plan drawn, it has no fields; " +
                                  results::fields_cure(result));
    return;
  }
  if (overview)
    drawing.draw(stem, overview_picture(result, load, shape, eventful(result, {load}, options)));
  if (membrane) drawing.draw(stem + "-membrane", membrane_picture(result, load, shape));
  if (plan) drawing.draw(stem + "-plan", plan_picture(result, load, shape));
}

void draw_load(const Result& result, const Load& load, const std::string& stem,
               const Options& options, Drawing& drawing) {
  if (load.traces.empty()) {
    drawing.drawn.notes.push_back("load \"" + load.name + "\" has no traces (" +
                                  std::string(results::name(load.status)) + "): nothing to draw");
    return;
  }
  draw_fields(result, load, stem, options, drawing);
  draw_traces(result, load, stem, options, drawing);
  if (wanted(options, "convergence") && load.history.size() >= fewest_steps(options))
    drawing.draw(stem + "-convergence", convergence_picture(result, load));
  if (!wanted(options, "accuracy")) return;
  if (bounded_stages(load) > 1) {
    drawing.draw(stem + "-accuracy", accuracy_picture(result, load));
  } else if (load.stages.size() != 0 || named(options, "accuracy")) {
    drawing.drawn.notes.push_back("load \"" + load.name +
                                  "\": no accuracy drawn, fewer than two stages have bounds");
  }
}

void note_few_steps(const Result& result, const Options& options, Drawing& drawing) {
  const std::size_t fewest = fewest_steps(options);
  const auto count = std::ranges::count_if(result.loads, [&](const Load& load) {
    return !load.traces.empty() && load.history.size() < fewest;
  });
  if (count == 0 || !wanted(options, "convergence")) return;
  drawing.drawn.notes.push_back(std::to_string(count) +
                                (count == 1 ? " load was solved in " : " loads were solved in ") +
                                (fewest == 2 ? "a single step: no convergence is drawn"
                                             : "one or two steps: no convergence is drawn; --only "
                                               "convergence draws that of two"));
}

/// The interfaces of a sweep on which it is drawn where they are closed.
std::vector<std::size_t> drawn_maps(const Result& result, const Options& options,
                                    Drawing& drawing) {
  if (const auto asked = asked_for(result, options)) return {*asked};
  std::vector<std::size_t> chosen = opening(result);
  if (options.all_interfaces || chosen.size() <= many) return chosen;
  drawing.drawn.notes.push_back("contact is drawn on the first " + std::to_string(many) + " of " +
                                std::to_string(chosen.size()) +
                                " interfaces that can open; --interface NAME chooses another, "
                                "--all draws all");
  chosen.resize(many);
  return chosen;
}

void require_consistent(const Result& result) {
  const std::string fault = results::first_fault(result);
  if (!fault.empty()) throw Error("the result is inconsistent: " + fault);
}

}  // namespace

Drawn draw(const Result& result, const fs::path& folder, const Options& options) {
  require_consistent(result);
  asked_for(result, options);  // before a folder is made
  std::vector<std::string> names;
  for (const Load& load : result.loads) names.push_back(load.name);
  std::vector<std::string> suffixes{"-membrane", "-plan", "-convergence", "-accuracy"};
  for (std::size_t i = 0; i < result.interfaces.size(); ++i) suffixes.push_back(traces_suffix(i));
  const std::vector<std::string> stems = file_stems(names, suffixes);

  Drawing drawing(folder, options);
  if (result.sweep) {
    if (options.only.empty()) draw_sweep(result, drawing);
    if (options.only.empty() && summary(*result.sweep).converged != 0)
      draw_contacts(result, drawn_maps(result, options, drawing), drawing);
    draw_kept_rows(result, options, drawing);
    if (!result.loads.empty()) {
      note_interfaces_left_out(result, options, drawing);
      note_interfaces_that_cannot_open(result, options, drawing);
    }
    return std::move(drawing.drawn);
  }
  const std::size_t count = first_of(result.loads.size(), "loads", "NAME", options, drawing);
  for (std::size_t i = 0; i < count; ++i)
    draw_load(result, result.loads[i], stems[i], options, drawing);
  note_interfaces_left_out(result, options, drawing);
  note_interfaces_that_cannot_open(result, options, drawing);
  note_few_steps(result, options, drawing);
  return std::move(drawing.drawn);
}

Drawn draw_together(Result result, const fs::path& folder, const Options& options) {
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
  drawing.draw("together",
               together_picture(result, eventful(result, result.loads, options).pressed));
  return std::move(drawing.drawn);
}

}  // namespace anticrack::figures
