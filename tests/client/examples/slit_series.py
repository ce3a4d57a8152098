# SPDX-License-Identifier: GPL-3.0-or-later
"""A crack (-1/2, 1/2) x {0} in the square (-1, 1)^2 held all around, under a load that is odd in y, by a series.

u is odd in y, so the upper half is a problem of its own: u = 0 on its boundary but where the crack is open, and
du/dy = 0 there. With sines across, w = pi k/2, the half answers a displacement g of y = 0 by the slope w coth(w) g;
on the open part g = sum b_n sin((n+1) t), x = c + a cos(t), and b comes from as many equations (Galerkin).
"""
import math

import numpy

SINES = 3000  # what is cut off is below 1e-5 of the values
CHEBYSHEV = 20
POINTS = 4000

K = numpy.arange(1, SINES + 1)
W = K * math.pi / 2
EVEN = numpy.where(K % 2 == 1, 2 / W, 0)  # of f = 1, y > 0
ODD = (2 * numpy.cos(W) - 1 - numpy.cos(2 * W)) / W  # of f = sgn(x), y > 0


class OpenPart:
    """The crack open from `begin` to its right end."""

    def __init__(self, force, begin):
        centre, half = (begin + 0.5) / 2, (0.5 - begin) / 2
        t = (numpy.arange(POINTS) + 0.5) * math.pi / POINTS
        shapes = numpy.array([numpy.sin((n + 1) * t) for n in range(CHEBYSHEV)])
        modes = (shapes * (half * numpy.sin(t) * math.pi / POINTS)) @ numpy.sin(
            numpy.outer(centre + half * numpy.cos(t) + 1, W))
        load = modes @ (force / W * numpy.tanh(W / 2))
        self._b = numpy.linalg.solve(modes @ ((W / numpy.tanh(W))[:, None] * modes.T), load)
        self.jump = 2 * float(numpy.max(self._b @ shapes))
        held = float(numpy.sum((force / W) ** 2 * (1 - 2 * numpy.tanh(W / 2) / W)))
        self.energy = -held - float(self._b @ load)  # of both halves
        # u ~ r^(1/2) at `begin` times this; 0 where open crack and contact meet
        self.left_end = float(numpy.sum(self._b * numpy.arange(1, CHEBYSHEV + 1) * (-1.0) ** numpy.arange(CHEBYSHEV)))


def opening():
    """Of f = sgn(y)."""
    return OpenPart(EVEN, -0.5)


def half_open():
    """Of f = sgn(x y), and the length of the part that stays shut."""
    shut, open_ = -0.3, 0.0
    for _ in range(20):
        middle = (shut + open_) / 2
        if OpenPart(ODD, middle).left_end < 0:
            shut = middle
        else:
            open_ = middle
    return OpenPart(ODD, shut), shut + 0.5
