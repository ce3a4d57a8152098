// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/axes.hpp"

#include "figures/text.hpp"

namespace anticrack::figures {

std::string margins(const Place& place, double left, double right, double bottom, double top) {
  return "set lmargin at screen " + number(place.x + left * place.width) +
         "\nset rmargin at screen " + number(place.x + right * place.width) +
         "\nset bmargin at screen " + number(place.y + bottom * place.height) +
         "\nset tmargin at screen " + number(place.y + top * place.height) + "\n";
}

std::string caption(const std::string& text, const Place& place) {
  return "set label 2 " + quoted(text) + " at screen " + number(place.x + 0.5 * place.width) +
         ", screen " + number(place.y + 0.965 * place.height) +
         " center noenhanced textcolor rgb '#222222'\n";
}

std::string below(const std::string& quoted_text, double height, const Place& place) {
  return "set label 3 " + quoted_text + " at graph 0.5, screen " +
         number(place.y + height * place.height) + " center noenhanced\n";
}

std::string axes() {
  return "set border 3 linewidth 0.8 linecolor rgb '#555555'\n"
         "set tics nomirror textcolor rgb '#333333'\n"
         "set grid xtics ytics linewidth 0.6 linecolor rgb '#cccccc' dashtype solid\n";
}

}  // namespace anticrack::figures
