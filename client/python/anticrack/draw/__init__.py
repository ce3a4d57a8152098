# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures with matplotlib. Each function draws one panel, on `ax` or on a new figure, and returns its Axes; draw
several load cases on the same Axes to compare them. `load` is a name or an answer. `mesh` draws a mesh."""
from . import panel  # noqa: F401  first, as it says if matplotlib is missing
from .animate import animate
from .along import jump, pressure, traces
from .growth import growth, release
from .history import convergence, error_band, errors
from .meshes import mesh
from .plane import displacement, flux, interfaces, plan
from .perspective import membrane
from .studies import contours, curves
from .sweeps import contact_length, contact_map, slopes, sweep

__all__ = ["animate", "contact_length", "contact_map", "contours", "convergence", "curves", "displacement",
           "error_band", "errors", "flux", "growth", "interfaces", "jump", "membrane", "mesh", "plan",
           "pressure", "release", "slopes", "sweep", "traces"]
