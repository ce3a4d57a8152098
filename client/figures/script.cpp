// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/script.hpp"

#include "figures/canvas.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;
using results::Result;

Title title_of(const Result& result, const Load& load) {
  return {result.title, load.name};
}

}  // namespace

std::string membrane_script(const Result& result, const Load& load, const Surface& surface,
                            const std::vector<Output>& outputs) {
  return script(
      membrane_data(surface), title_of(result, load),
      [&](Format format, const Place& place) {
        return membrane_panel(surface, load, membrane_view(result), place, format);
      },
      column, outputs);
}

std::string traces_script(const Result& result, const Load& load, std::size_t interface,
                          const std::vector<Output>& outputs) {
  const Profile along = profile(result, interface, load.traces.at(interface));
  const results::Trace& trace = load.traces[interface];
  return script(
      traces_data(along, trace), title_of(result, load),
      [&](Format, const Place& place) { return traces_panel(along, trace, load, place); }, column,
      outputs);
}

std::string convergence_script(const Result& result, const Load& load,
                               const std::vector<Output>& outputs) {
  return script(
      convergence_data(load), title_of(result, load),
      [&](Format, const Place& place) { return convergence_panel(load, place); }, column, outputs);
}

std::string combined_script(const Result& result, const Load& load, const Surface& surface,
                            const std::vector<Output>& outputs) {
  const Profile along = profile(result, 0, load.traces.at(0));
  const results::Trace& trace = load.traces[0];
  return script(
      membrane_data(surface) + traces_data(along, trace), title_of(result, load),
      [&](Format format, const Place& place) {
        const auto [left, right] = halves(place);
        return membrane_panel(surface, load, membrane_view(result), left, format) +
               traces_panel(along, trace, load, right);
      },
      page, outputs);
}

}  // namespace anticrack::figures
