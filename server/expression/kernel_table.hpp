// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the tables of kernels have in common. `Lanes` says how many numbers are computed at once
// and by which functions. Names nothing of the standard library that the linker could take from a
// file compiled for a newer processor.
#pragma once

#include "expression/kernels.hpp"

namespace anticrack::expression {

template <class Lanes>
struct KernelTable {
  using Numbers = typename Lanes::Numbers;

  template <Numbers (*f)(Numbers)>
  static void one(const double* a, const double*, const double*, double* out, std::size_t n) {
    for (std::size_t i = 0; i < n; i += Lanes::width) {
      Lanes::store(out + i, f(Lanes::load(a + i)));
    }
  }
  template <Numbers (*f)(Numbers, Numbers)>
  static void two(const double* a, const double* b, const double*, double* out, std::size_t n) {
    for (std::size_t i = 0; i < n; i += Lanes::width) {
      Lanes::store(out + i, f(Lanes::load(a + i), Lanes::load(b + i)));
    }
  }
  static void three(const double* a, const double* b, const double* c, double* out, std::size_t n) {
    for (std::size_t i = 0; i < n; i += Lanes::width) {
      Lanes::store(out + i,
                   Lanes::select(Lanes::load(a + i), Lanes::load(b + i), Lanes::load(c + i)));
    }
  }

  static Numbers add(Numbers a, Numbers b) { return a + b; }
  static Numbers subtract(Numbers a, Numbers b) { return a - b; }
  static Numbers multiply(Numbers a, Numbers b) { return a * b; }
  static Numbers divide(Numbers a, Numbers b) { return a / b; }
  static Numbers negate(Numbers a) { return -a; }
  static Numbers nearest(Numbers a) { return Lanes::lower(a + Lanes::all(0.5)); }
  static Numbers sign(Numbers a) {
    return Lanes::less(Lanes::all(0), a) - Lanes::less(a, Lanes::all(0));
  }
  static Numbers both(Numbers a, Numbers b) {
    return Lanes::unequal(a, Lanes::all(0)) * Lanes::unequal(b, Lanes::all(0));
  }
  static Numbers either(Numbers a, Numbers b) {
    return Lanes::maximum(Lanes::unequal(a, Lanes::all(0)), Lanes::unequal(b, Lanes::all(0)));
  }

  static constexpr Kernels make() {
    using L = Lanes;
    return {nullptr,
            nullptr,
            nullptr,
            two<add>,
            two<subtract>,
            two<multiply>,
            two<divide>,
            one<negate>,
            two<L::power>,
            one<L::square_root>,
            one<L::exponential>,
            one<L::logarithm>,
            one<L::logarithm2>,
            one<L::logarithm10>,
            one<L::sine>,
            one<L::cosine>,
            one<L::tangent>,
            one<L::arc_sine>,
            one<L::arc_cosine>,
            one<L::arc_tangent>,
            one<L::hyperbolic_sine>,
            one<L::hyperbolic_cosine>,
            one<L::hyperbolic_tangent>,
            one<L::area_sine>,
            one<L::area_cosine>,
            one<L::area_tangent>,
            two<L::arc_tangent2>,
            one<L::absolute>,
            two<L::minimum>,
            two<L::maximum>,
            one<nearest>,
            one<L::lower>,
            one<L::upper>,
            one<sign>,
            two<L::less>,
            two<L::less_equal>,
            two<L::equal>,
            two<L::unequal>,
            two<both>,
            two<either>,
            three};
  }
};

}  // namespace anticrack::expression
