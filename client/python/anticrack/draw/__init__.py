# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures with matplotlib. Each function draws one panel, on `ax` or on a new figure, and returns its Axes: several
load cases lie over each other when they are drawn on the same one. `load` is a name or an answer."""
from .along import pressure, traces
from .history import convergence, error_band, sweep
from .plane import displacement, flux, interfaces, plan
from .perspective import membrane

__all__ = ["convergence", "displacement", "error_band", "flux", "interfaces", "membrane", "plan", "pressure", "sweep",
           "traces"]
