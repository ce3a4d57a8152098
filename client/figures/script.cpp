// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/script.hpp"

#include "figures/canvas.hpp"
#include "figures/panels.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

using results::Load;
using results::Result;

Profile profile_of(const Result& result, const Load& load, std::size_t interface) {
  Profile along = profile(result.interfaces.at(interface), load.traces.at(interface));
  if (result.interfaces.size() > 1) along.name = result.interfaces[interface].name;
  return along;
}

std::string title_of(const Result& result, const Load& load) {
  return quoted(result.title.empty() ? load.name : result.title + " \xE2\x80\x94 " + load.name, 90);
}

}  // namespace

std::string membrane_script(const Result& result, const Load& load, const Surface& surface,
                            const std::vector<Output>& outputs) {
  return script(
      membrane_data(surface), title_of(result, load),
      [&](Format format) {
        return membrane_panel(surface, membrane_view(result), {0, 0, 1, 0.93}, format);
      },
      single, outputs);
}

std::string traces_script(const Result& result, const Load& load, std::size_t interface,
                          const std::vector<Output>& outputs) {
  const Profile along = profile_of(result, load, interface);
  return script(
      traces_data(along, load.traces[interface]), title_of(result, load),
      [&](Format) {
        return traces_panel(along, load, {0, 0, 1, 0.93});
      },
      single, outputs);
}

std::string convergence_script(const Result& result, const Load& load,
                               const std::vector<Output>& outputs) {
  return script(
      convergence_data(load), title_of(result, load),
      [&](Format) {
        return convergence_panel(load, {0, 0, 1, 0.93});
      },
      single, outputs);
}

std::string combined_script(const Result& result, const Load& load, const Surface& surface,
                            const std::vector<Output>& outputs) {
  const Profile along = profile_of(result, load, 0);
  return script(
      membrane_data(surface) + traces_data(along, load.traces[0]), title_of(result, load),
      [&](Format format) {
        return membrane_panel(surface, membrane_view(result), {0, 0, 0.5, 0.93}, format) +
               traces_panel(along, load, {0.5, 0, 0.5, 0.93});
      },
      wide, outputs);
}

}  // namespace anticrack::figures
