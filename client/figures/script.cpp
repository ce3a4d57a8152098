// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/script.hpp"

#include "figures/panels.hpp"

namespace anticrack::figures {

using results::Load;
using results::Result;

Picture membrane_picture(const Result& result, const Load& load, const Surface& surface) {
  return {membrane_data(surface),
          {result.title, load.name},
          [&](Format format, const Place& place) {
            return membrane_panel(surface, load, membrane_view(result), place, format);
          },
          narrow};
}

Picture traces_picture(const Result& result, const Load& load, std::size_t interface) {
  const results::Trace& trace = load.traces.at(interface);
  const Profile along = profile(result, interface, trace);
  return {
      traces_data(along, trace),
      {result.title, load.name},
      [&, along](Format, const Place& place) { return traces_panel(along, trace, load, place); },
      narrow};
}

Picture convergence_picture(const Result& result, const Load& load) {
  return {convergence_data(load),
          {result.title, load.name},
          [&](Format, const Place& place) { return convergence_panel(load, place); },
          narrow};
}

Picture combined_picture(const Result& result, const Load& load, const Surface& surface) {
  const Picture left = membrane_picture(result, load, surface);
  const Picture right = traces_picture(result, load, 0);
  return {left.data + right.data, left.title,
          [left = left.plots, right = right.plots](Format format, const Place& place) {
            const auto [left_half, right_half] = halves(place);
            return left(format, left_half) + right(format, right_half);
          },
          page};
}

}  // namespace anticrack::figures
