# SPDX-License-Identifier: GPL-3.0-or-later
"""The membrane as triangles, and a collection that draws hundreds of thousands of them in space."""
from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.artist import allow_rasterization

from ..arrays import Array
from ..errors import Error
from ..result import Load, Result, joined
from ..text import harmless
from .panel import widened

# The middle is light grey and not white, so that the membrane is seen on paper.
DIVERGING = LinearSegmentedColormap.from_list("anticrack", [
    "#1b4f8f", "#4a90c8", "#a6cbe3", "#dedede", "#f4b698", "#d6604d", "#97162b"])
_EDGED = 12_000  # triangles; the edges of more could not be told apart


class Surface:
    """All subdomains together, without triangles that have no u; both faces of an open crack have their own nodes.

    nodes (n, 2); u (n); triangles (m, 3): indices into nodes; areas (m); flux (m): |T grad u|; flux_of_nodes (n) and
    slopes (n, 2), grad u: means weighted by area."""

    def __init__(self, result: Result, load: Load) -> None:
        parts = load.fields
        if not parts:
            raise Error(f"{harmless(load.name)} has no fields; solve with Case(fields=True), in TOML [output] "
                        "fields = true")
        nodes, _, self.triangles = joined(parts)
        self.nodes = result.mesh.nodes[nodes]
        self.u = np.concatenate([part.u for part in parts])
        known = np.isfinite(self.u[self.triangles]).all(axis=1)
        self.triangles = self.triangles[known]
        self.areas, slopes, fluxes = (np.concatenate([getattr(part, name) for part in parts])[known].T
                                      for name in ("areas", "slopes", "flux"))
        self.flux = np.hypot(*fluxes)
        self.around = self._of_nodes(np.ones_like(self.flux))  # three times the area of the triangles at a node
        self.flux_of_nodes, *means = (self._of_nodes(each) / np.where(self.around == 0, 1, self.around)
                                      for each in (self.flux, *slopes))
        self.slopes = np.stack(means, axis=1)

    def _of_nodes(self, values: Array) -> Array:
        return np.bincount(self.triangles.ravel(), np.repeat(values * self.areas, 3), len(self.u)).astype(float)

    @property
    def known(self) -> Array:
        """The known values of u; a single 0 if there are no nodes."""
        found = self.u[np.isfinite(self.u)]
        return np.asarray(found if len(found) else np.zeros(1))

    def shades(self, limits: tuple[float, float] | None, cmap: Any) -> Any:
        """The colours of u, from blue to red around 0 if u has both signs."""
        from matplotlib.cm import ScalarMappable
        low, high = limits or (float(self.known.min()), float(self.known.max()))
        both = min(-low, high) > 0.05 * max(-low, high) > 0
        if both and limits is None:
            low, high = -max(-low, high), max(-low, high)
        return ScalarMappable(Normalize(*widened(low, high)), cmap or (DIVERGING if both else "viridis"))


class Heights(PolyCollection):  # type: ignore[misc]
    """Triangles in space, drawn from the farthest to the nearest on axes of three dimensions, in colours that blend.
    They are an image in vector files; a million take a second. edges: draw the triangles' edges, unless they are many.
    points (n, 3); triangles (m, 3); colours (n, 4) of the points."""

    def __init__(self, points: Array, triangles: Array, colours: Array, edges: bool) -> None:
        super().__init__([], linewidths=0.15, edgecolors=(0, 0, 0, 0.3), rasterized=True, zorder=0)
        self.points, self.triangles, self.colours = points, triangles, colours
        self._edged = edges and len(triangles) <= _EDGED

    def do_3d_projection(self) -> float:
        projected = np.c_[self.points, np.ones(len(self.points))] @ np.asarray(self.axes.M).T
        projected = projected[:, :3] / projected[:, 3:]
        depths = projected[:, 2][self.triangles].sum(axis=1)
        self._shown = self.triangles[np.argsort(-depths)]
        self._corners = projected[:, :2][self._shown]
        return float(depths.min()) if len(depths) else 0.0

    @allow_rasterization  # type: ignore[misc]
    def draw(self, renderer: Any) -> None:
        colours = self.colours[self._shown]
        if self._edged:
            self.set_verts(self._corners)
            self.set_facecolors(colours.mean(axis=1))
            super().draw(renderer)
        elif len(colours) and self.get_visible():
            gc = renderer.new_gc()
            self._set_gc_clip(gc)
            renderer.draw_gouraud_triangles(gc, self._corners, colours, self.get_transform().frozen())
            gc.restore()
