// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// All operations: X(code, name as a function of expressions, time of a point in ns, value).
/// The value is a formula of the operands a, b, c, which is compiled for one number at a time and
/// for four or eight (kernel_table.hpp). ELEMENTARY: a function of the C library, or that of SLEEF.
/// PERIODIC: the same, accurate to 3.5 units in the last place, in three quarters of the time.
/// EXACT: the same, for functions that the processor rounds correctly.
#define ANTICRACK_OPERATIONS(X)                                           \
  X(add, "sum", 0.3, a + b)                                               \
  X(subtract, "", 0.3, a - b)                                             \
  X(multiply, "", 0.3, (a)*b)                                             \
  X(divide, "", 1, a / b)                                                 \
  X(negate, "", 0.3, -a)                                                  \
  X(power, "", 8, ELEMENTARY(pow, a, b))                                  \
  X(square_root, "sqrt", 1, EXACT(sqrt, a))                               \
  X(exponential, "exp", 4, ELEMENTARY(exp, a))                            \
  X(logarithm, "log", 4, ELEMENTARY(log, a))                              \
  X(logarithm2, "log2", 4, ELEMENTARY(log2, a))                           \
  X(logarithm10, "log10", 4, ELEMENTARY(log10, a))                        \
  X(sine, "sin", 4, PERIODIC(sin, a))                                     \
  X(cosine, "cos", 4, PERIODIC(cos, a))                                   \
  X(tangent, "tan", 8, ELEMENTARY(tan, a))                                \
  X(arc_sine, "asin", 8, ELEMENTARY(asin, a))                             \
  X(arc_cosine, "acos", 8, ELEMENTARY(acos, a))                           \
  X(arc_tangent, "atan", 8, ELEMENTARY(atan, a))                          \
  X(hyperbolic_sine, "sinh", 8, ELEMENTARY(sinh, a))                      \
  X(hyperbolic_cosine, "cosh", 8, ELEMENTARY(cosh, a))                    \
  X(hyperbolic_tangent, "tanh", 8, ELEMENTARY(tanh, a))                   \
  X(area_sine, "asinh", 8, ELEMENTARY(asinh, a))                          \
  X(area_cosine, "acosh", 8, ELEMENTARY(acosh, a))                        \
  X(area_tangent, "atanh", 8, ELEMENTARY(atanh, a))                       \
  X(arc_tangent2, "atan2", 8, ELEMENTARY(atan2, a, b))                    \
  X(absolute, "abs", 0.3, EXACT(fabs, a))                                 \
  X(minimum, "min", 0.3, b < a ? b : a)                                   \
  X(maximum, "max", 0.3, a < b ? b : a)                                   \
  X(nearest, "rint", 0.3, EXACT(floor, a + half))                         \
  X(lower, "floor", 0.3, EXACT(floor, a))                                 \
  X(upper, "ceil", 0.3, EXACT(ceil, a))                                   \
  X(sign, "sign", 0.3, (zero < a ? one : zero) - (a < zero ? one : zero)) \
  X(less, "", 0.3, a < b ? one : zero)                                    \
  X(less_equal, "", 0.3, a <= b ? one : zero)                             \
  X(equal, "", 0.3, a == b ? one : zero)                                  \
  X(unequal, "", 0.3, a != b ? one : zero)                                \
  X(both, "", 0.3, (a != zero ? one : zero) * (b != zero ? one : zero))   \
  X(either, "", 0.3, a != zero ? one : (b != zero ? one : zero))          \
  X(select, "", 0.3, a != zero ? b : c)
