// SPDX-License-Identifier: GPL-3.0-or-later
//
// Colours for numbers. For the sources of this folder only.
#pragma once

#include <array>
#include <span>
#include <string>

#include "figures/axes.hpp"

namespace anticrack::figures {

/// Red, green and blue, 0 to 255, from the lowest number to the highest, evenly.
using Colour = std::array<double, 3>;
using Palette = std::span<const Colour>;

/// viridis: for u of one sign.
inline constexpr std::array<Colour, 10> viridis{{{68, 1, 84},
                                                 {72, 40, 120},
                                                 {62, 74, 137},
                                                 {49, 104, 142},
                                                 {38, 130, 142},
                                                 {31, 158, 137},
                                                 {53, 183, 121},
                                                 {110, 206, 88},
                                                 {181, 222, 43},
                                                 {253, 231, 37}}};

/// Blue to red through light grey: for u of both signs, zero in the middle.
inline constexpr std::array<Colour, 7> diverging{{{27, 79, 143},
                                                  {74, 144, 200},
                                                  {166, 203, 227},
                                                  {222, 222, 222},
                                                  {244, 182, 152},
                                                  {214, 96, 77},
                                                  {151, 22, 43}}};

/// White to blue: for sizes, under lines that must be seen.
inline constexpr std::array<Colour, 5> pale{
    {{255, 255, 255}, {214, 230, 244}, {158, 201, 225}, {84, 153, 200}, {20, 90, 160}}};

/// "0xRRGGBB" at `part` of the palette, clamped to 0 to 1, times `brightness` of at most 1.
std::string colour(Palette palette, double part, double brightness = 1);

/// The commands of the palette and of a colour bar over `range`, labelled in at most about 4
/// places.
std::string colour_bar(Palette palette, const Range& range);

}  // namespace anticrack::figures
