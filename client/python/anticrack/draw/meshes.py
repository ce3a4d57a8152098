# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a mesh as the server understood it, before anything is solved."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.colors import ListedColormap

from ..arrays import Array
from ..result import Units
from ..v1 import mesh_pb2
from .names import Names
from .panel import axes, legend_below, number_text, point_text, rounded
from .plane import NAMED, Plane

# Pale colours, so that lines stand out.
_PAINTS = ListedColormap(["#E8F1F8", "#FBEEDD", "#E9F5EC", "#F5E9F3", "#F6F5DC", "#ECECEC"])
_EDGED = 60_000  # triangles; the edges of more could not be told apart


class Plan(Plane):
    """A mesh to draw, made of its message and the arrays of ReadMesh (see Client.mesh and Client.mesh_arrays). free: no
    traction acts where u is not given; None if not known."""

    def __init__(self, message: mesh_pb2.Mesh, arrays: Mapping[str, Array], units: Units | None = None,
                 free: bool | None = None) -> None:
        lines = [(arrays["nodes"][arrays[f"interfaces/{i}/nodes"]], arrays[f"interfaces/{i}/edge_kind"],
                  arrays[f"interfaces/{i}/edge_inclusion"]) for i in range(len(message.interfaces))]
        super().__init__(arrays["nodes"], arrays["triangles"], arrays["boundary"], False if free else None, lines,
                         list(message.inclusions), (units or Units()).behind("L").strip())
        self.message, self.subdomain = message, arrays["subdomain"]
        self.size = float((self.high - self.low).max())
        self.tips = np.array([(tip.at.x, tip.at.y) for tip in message.tips]).reshape(-1, 2)

    def finest(self) -> Any:
        """The tip with the smallest edge; None if the mesh around it is hardly finer than elsewhere."""
        if not self.message.tips:
            return None
        tip = min(self.message.tips, key=lambda each: float(each.smallest_edge))
        (a, b, c) = np.moveaxis(self.nodes[self.triangles], 1, 0)
        area = float(np.abs(np.linalg.det(np.stack((b - a, c - a), axis=1))).sum() / 2)
        return tip if tip.smallest_edge <= (2 * area / len(self.triangles)) ** 0.5 / 4 else None

    def near(self, tip: Any) -> tuple[Array, Array]:
        """The corners of a tip's neighbourhood: a twentieth of the mesh, or more if that has few triangles."""
        half = max(float(np.ptp(self.nodes[:, 0])) / 40, 20 * tip.smallest_edge)
        middle = np.array((tip.at.x, tip.at.y))
        return middle - half, middle + half


def mesh(message: mesh_pb2.Mesh, arrays: Mapping[str, Array], ax: Any = None, tip: bool = False,
         units: Units | None = None) -> Any:
    """Draws the mesh of client.mesh(case) with arrays of client.mesh_arrays(message): triangles, subdomains, boundary,
    interfaces with an arrow into their plus sides and a square where their arc length is 0, inclusions with dots on the
    side that came off, and tips. tip: draw only the neighbourhood of the tip with the smallest edge."""
    ax, plan = axes(ax), Plan(message, arrays, units)
    draw_mesh(plan, ax, plan.finest() if tip else None)
    legend_below(ax, 4)
    return ax


def draw_mesh(plan: Plan, ax: Any, tip: Any = None) -> int:
    """Draws a plan, or the neighbourhood of a tip; returns the number of triangles whose edges are left out."""
    low, high = (plan.low, plan.high) if tip is None else plan.near(tip)
    corners = plan.nodes[plan.triangles]
    least = (high - low).max() / 3000  # about a pixel
    seen = ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    seen &= (np.ptp(corners, axis=1) > least).any(axis=1)
    left_out = int(seen.sum()) if seen.sum() > _EDGED else 0
    if seen.any():
        ax.tripcolor(*plan.nodes.T, plan.triangles[seen], facecolors=plan.subdomain[seen] % _PAINTS.N, cmap=_PAINTS,
                     vmin=0, vmax=_PAINTS.N, zorder=0, edgecolors="none" if left_out else "#A8A8A8", linewidth=0.25,
                     rasterized=seen.sum() > 3000)
    names = plan.draw(ax, low, high, 0.03 if tip is None else 0)
    if len(plan.tips):
        ax.plot(*plan.tips.T, "o", color="black", markersize=2.5, markerfacecolor="white", zorder=4,
                markeredgewidth=0.8, label="tip")
    _name(plan, names, low, high, corners[seen], plan.subdomain[seen])
    if tip is None:
        ax.set_title(f"{len(plan.triangles)} triangles, {len(plan.nodes)} nodes")
    else:
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_locator(rounded(4))
        zoom = number_text(plan.size / float((high - low).max()), 2)
        ax.set_title(f"at the tip {point_text(tip.at.x, tip.at.y, plan.size, 3)}, \u00d7{zoom}, edges from "
                     f"{number_text(tip.smallest_edge, 2)}{' ' * bool(plan.unit)}{plan.unit}")
    return left_out


def _name(plan: Plan, names: Names, low: Array, high: Array, corners: Array, subdomain: Array) -> None:
    """Writes the names of interfaces, inclusions and subdomains as far as there is room."""
    if len(plan.lines) <= NAMED or len(plan.lines) * (high - low).max() < NAMED * plan.size:
        told = []
        for info, (points, _, _) in zip(plan.message.interfaces, plan.lines):
            # A little off the middle, where a tip, a cross point or another interface's arrow may be.
            where = plan.beside(points, np.array(True), (0.56, 0.3, 0.8, 0.42, 0.15, 0.9), (1,))
            if names.beside(f"{info.name} +", where, arrow=True):
                told.append(info.name)
        plan.name_inclusions(names, told)
    for i, info in enumerate(plan.message.subdomains):
        centres = corners[subdomain == i].mean(axis=1)
        names.on(info.name, centres[((centres > low) & (centres < high)).all(axis=1)], 6)
