// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/palette.hpp"
#include "figures/panels.hpp"
#include "figures/plan_layers.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

constexpr std::size_t shade_count = 32;
constexpr int levels = 10;

std::vector<std::string> paints() {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < shade_count; ++i)
    all.push_back("#" + colour(pale, (static_cast<double>(i) + 0.5) / shade_count).substr(2));
  return all;
}

/// What the colours are.
struct Shown {
  std::string symbol, unit;
};

Shown shown_of(const results::Result& result) {
  if (!result.mesh.tension_law.empty()) return {"|\xE2\x88\x87u|", ""};
  return {"|T \xE2\x88\x87u|", result.units.label("F/L")};
}

std::string bar(const Peaks& flux, const Shown& shown, const Place& place) {
  const Range range{0, flux.shown > 0 ? flux.shown : 1};
  const Scale scale(range);
  std::string label = scale.label(shown.symbol, shown.unit);
  if (flux.cut_off()) label += ", peaks cut off, up to " + readable(flux.highest, 2);
  const auto at = [&](double x, double y) {
    return "screen " + number(place.x + x * place.width) + ", screen " +
           number(place.y + y * place.height);
  };
  return colour_bar(pale, scale.drawn(range)) + "set cbtics offset -0.6,0\n" +
         "set colorbox user vertical origin " + at(0.8, 0.16) + " size screen " +
         number(0.025 * place.width) + ", screen " + number(0.7 * place.height) + "\nset label 5 " +
         figures::quoted(label) + " at " + at(0.975, 0.51) +
         " center rotate by 90 noenhanced font ',7'\n";
}

std::string plan_heading(const results::Load& load, const Shown& shown) {
  std::string text = "u in lines, " + shown.symbol + " in colours";
  if (load.status == results::Status::not_converged) text += ",  not converged";
  return text;
}

}  // namespace

Picture plan_picture(const results::Result& result, const results::Load& load,
                     const Surface& surface) {
  const Peaks flux = flux_peaks(surface);
  const MeshLayers layers = plan_layers(result, surface, flux, shade_count, levels);
  const Shown shown = shown_of(result);
  const MeshPanel panel{"P",  whole(result.mesh), plan_heading(load, shown),
                        true, result.units,       paints()};
  return {mesh_data(layers, panel.tag),
          {result.title, load.name},
          [=](Format, const Place& place) {
            const int rows = legend_rows(layers, 2);
            const auto [map, below_map] = above_foot(place, square, legend_height(rows));
            return bar(flux, shown, map) +
                   mesh_panel(layers, panel, {map.x, map.y, 0.8 * map.width, map.height},
                              aspect(place, square)) +
                   mesh_legend(layers, rows, below_map);
          },
          square};
}

}  // namespace anticrack::figures
