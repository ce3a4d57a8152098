// SPDX-License-Identifier: GPL-3.0-or-later
//
// Arithmetic of jets, and the elementary functions of jets.
#pragma once

#include "expression/enclosure.hpp"

namespace anticrack::expression {

Jet constant_jet(const Interval& value);

/// The smallest jet that holds both, up to `order`.
Jet hull(const Jet& a, const Jet& b, int order);
Jet operator-(const Jet& a);
Jet operator+(const Jet& a, const Jet& b);
Jet operator-(const Jet& a, const Jet& b);
Jet operator*(const Jet& a, const Jet& b);
Jet square(const Jet& a);

/// An elementary function of one operand, by its code, up to `order`. If the operand leaves the
/// function's domain, the result is for the part inside.
Jet elementary(Code code, const Jet& a, int order);
Jet power(const Jet& base, const Jet& exponent, int order);

}  // namespace anticrack::expression
