# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as the server understood it, before anything is solved."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba_array

from ..arrays import Array
from ..result import GLUE, Units
from ..v1 import mesh_pb2
from .names import Names
from .panel import axes, legend_below, number_text, point_text, rounded
from .plane import beside, boundary, draw_boundary, draw_lines, frame
from .surface import Smooth

_PAINTS = ("#E8F1F8", "#FBEEDD", "#E9F5EC", "#F5E9F3", "#F6F5DC", "#ECECEC")  # pale: lines stand out
_EDGED = 60_000  # edges of more triangles could not be told apart
_NAMED = 16  # more names and arrows would cover the lines


class Plan:
    """What is drawn of a mesh: its message and the arrays of ReadMesh (see Client.mesh and Client.mesh_arrays). free:
    no traction acts where u is not given; None: not known."""

    def __init__(self, message: mesh_pb2.Mesh, arrays: Mapping[str, Array], units: Units | None = None,
                 free: bool | None = None) -> None:
        self.message, self.units = message, units or Units()
        self.nodes, self.triangles, self.subdomain = (arrays[name] for name in ("nodes", "triangles", "subdomain"))
        self.boundary, self.traction = arrays["boundary"], False if free else None
        self.lines = [(self.nodes[arrays[f"interfaces/{i}/nodes"]], arrays[f"interfaces/{i}/edge_kind"],
                       arrays[f"interfaces/{i}/edge_inclusion"]) for i in range(len(message.interfaces))]
        self.low, self.high = self.nodes.min(axis=0), self.nodes.max(axis=0)
        self.size = float((self.high - self.low).max())
        self.tips = np.array([(tip.at.x, tip.at.y) for tip in message.tips]).reshape(-1, 2)

    def finest(self) -> Any:
        """The tip with the smallest edge; None where the mesh around it is as coarse."""
        if not self.message.tips:
            return None
        tip = min(self.message.tips, key=lambda each: float(each.smallest_edge))
        (a, b, c) = np.moveaxis(self.nodes[self.triangles], 1, 0)
        area = float(np.abs(np.linalg.det(np.stack((b - a, c - a), axis=1))).sum() / 2)
        return tip if tip.smallest_edge <= (2 * area / len(self.triangles)) ** 0.5 / 4 else None

    def near(self, tip: Any) -> tuple[Array, Array]:
        """The corners of its neighbourhood: a twentieth of the mesh, or more where that has few triangles."""
        half = max(float(np.ptp(self.nodes[:, 0])) / 40, 20 * tip.smallest_edge)
        middle = np.array((tip.at.x, tip.at.y))
        return middle - half, middle + half


def mesh(message: mesh_pb2.Mesh, arrays: Mapping[str, Array], ax: Any = None, tip: bool = False,
         units: Units | None = None) -> Any:
    """The triangles of client.mesh(case), arrays those of client.mesh_arrays(message): its subdomains, boundary,
    interfaces with an arrow into their plus sides and a square where their arc length is 0, inclusions with dots on the
    side that came off, and tips. tip: the neighbourhood of that with the smallest edge."""
    ax, plan = axes(ax), Plan(message, arrays, units)
    finest = plan.finest() if tip else None
    draw_mesh(plan, ax, finest)
    handles, labels = ax.get_legend_handles_labels()
    legend_below(ax, 4, handles=handles, labels=labels)
    return ax


def draw_mesh(plan: Plan, ax: Any, tip: Any = None) -> int:
    """The number of triangles whose edges are left out."""
    low, high = (plan.low, plan.high) if tip is None else plan.near(tip)
    unit = plan.units.behind("L").strip()
    stretched = frame(ax, low, high, unit, 0 if tip is not None else 0.03)
    if tip is not None:
        for axis in (ax.xaxis, ax.yaxis):
            axis.set_major_locator(rounded(4))
    corners = plan.nodes[plan.triangles]
    least = (high - low).max() / 3000  # about a pixel
    seen = ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    seen &= (np.ptp(corners, axis=1) > least).any(axis=1)
    left_out = int(seen.sum()) if seen.sum() > _EDGED else 0
    drawn: dict[str, Any] = {}
    paints = np.repeat(to_rgba_array(_PAINTS)[plan.subdomain[seen] % len(_PAINTS)][:, None], 3, axis=1)
    ax.add_collection(Smooth(plan.nodes, plan.triangles[seen], paints), autolim=False)
    if not left_out:
        edges = np.unique(np.sort(np.concatenate([plan.triangles[seen][:, [i, (i + 1) % 3]] for i in range(3)]), 1),
                          axis=0)
        ax.add_collection(LineCollection(plan.nodes[edges], linewidth=0.25, color="#A8A8A8", zorder=0.5,
                                         rasterized=len(edges) > 5000), autolim=False)
    edges_of = boundary(plan.nodes, plan.triangles, plan.boundary, plan.traction)
    draw_boundary(ax, plan.nodes, edges_of, drawn)
    away = 0.012 * (stretched * (high - low)).max() / stretched
    draw_lines(ax, [(points, kinds) for points, kinds, _ in plan.lines if tip is None or (
        (points.max(axis=0) >= low) & (points.min(axis=0) <= high)).all()], away, drawn)
    if len(plan.tips):
        (drawn["tip"],) = ax.plot(*plan.tips.T, "o", color="black", markersize=2.5, markerfacecolor="white", zorder=4,
                                  markeredgewidth=0.8)
    if plan.lines and len(plan.lines) <= _NAMED:
        begins = np.array([points[0] for points, *_ in plan.lines])
        (drawn["s = 0"],) = ax.plot(*begins.T, "s", color="#0072B2", markersize=3.5, markerfacecolor="none", zorder=4,
                                    markeredgewidth=0.8)
    for what, handle in drawn.items():
        handle.set_label(what)
    _name(plan, ax, low, high, away, [*edges_of.values()], corners[seen], plan.subdomain[seen])
    if tip is None:
        ax.set_title(f"{len(plan.triangles)} triangles, {len(plan.nodes)} nodes")
    else:
        zoom = number_text(plan.size / float((high - low).max()), 2)
        ax.set_title(f"at the tip {point_text(tip.at.x, tip.at.y, plan.size, 3)}, \u00d7{zoom}, edges from "
                     f"{number_text(tip.smallest_edge, 2)}{' ' * bool(unit)}{unit}")
    return left_out


def _name(plan: Plan, ax: Any, low: Array, high: Array, away: Array, edges: list[Array], corners: Array,
          subdomain: Array) -> None:
    """Interfaces, inclusions and subdomains, as far as there is room."""
    every = [points for points, *_ in plan.lines] + [plan.nodes[ends].mean(axis=1) for ends in edges]
    lines = np.concatenate(every)
    names = Names(ax, lines[((lines >= low) & (lines <= high)).all(axis=1)])

    def seen(points: Array) -> Array:
        inside = ((points >= low) & (points <= high)).all(axis=1)
        return np.asarray(inside[1:] & inside[:-1])
    if len(plan.lines) <= _NAMED or len(plan.lines) * (high - low).max() < _NAMED * plan.size:
        told = set()
        for info, (points, _, _) in zip(plan.message.interfaces, plan.lines):
            # A little off the middle: there may be a tip, a cross point or another interface's arrow.
            where = beside(points, np.flatnonzero(seen(points)), away, (0.56, 0.3, 0.8, 0.42, 0.15, 0.9), (1,))
            if names.beside(f"{info.name} +", where, arrow=True):
                told.add(info.name)
        for index, name in enumerate(plan.message.inclusions):
            for points, kinds, inclusions in plan.lines:
                of_it = np.flatnonzero((inclusions == index) & (kinds != GLUE) & seen(points))
                if len(of_it) and name not in told:
                    names.beside(name, beside(points, of_it, away, (0.5, 0.25, 0.75, 0.1, 0.9), (-1, 1)))
                    break
    for i, info in enumerate(plan.message.subdomains):
        centres = corners[subdomain == i].mean(axis=1)
        names.on(info.name, centres[((centres > low) & (centres < high)).all(axis=1)], 6)
