# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures in the files of `anticrack plot` and `anticrack mesh show`, made of the panels of this folder: a picture
has one column, an overview two. Each function returns the picture's files by format."""
from __future__ import annotations

import functools
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from ..result import Load, Result
from .along import (Profile, can_open, common, draw_traces, edge_pressure, finish, heading, jump, pressed, pressure,
                    shade)
from .growth import growth, release
from .history import bounded, convergence, error_band, errors
from .meshes import Plan, draw_mesh
from .panel import CURVES, cut, legend_below, named, rounded, stretch_of, unit_of
from .perspective import membrane, not_converged
from .plane import plan
from .sheet import ABOVE, BELOW, INCH, KEY, LEFT, RIGHT, Look, Sheet
from .sweeps import Rows, contact_length, contact_map, slopes, sweep

Files = dict[str, bytes]


def title_of(result: Result, load: Load | None = None) -> str:
    return " \u2014 ".join(text for text in (result.title, load.name if load else "") if text)


def _handles(*panels: Any) -> list[Any]:
    """The entries of a legend: all that the panels name, each name once."""
    return [*{handle.get_label(): handle for ax in panels for handle in ax.get_legend_handles_labels()[0]}.values()]


def _over_one_axis(panels: list[Any]) -> None:
    for ax in panels[:-1]:
        ax.tick_params(labelbottom=False)
        ax.set_xlabel("")
    for ax in panels[1:]:
        ax.set_title("")
    width = panels[0].get_position().width * panels[0].figure.get_size_inches()[0]
    for ax in panels:  # aligns the axes' names, however wide the numbers are
        ax.yaxis.set_label_coords(-(LEFT - 5) / INCH / width, 0.5)


def draw_membrane(sheet: Sheet, result: Result, load: Load, *_: float) -> float:
    look, wide = sheet.look, sheet.look.width
    height = 0.7 * wide
    bar = sheet.panel(0.24 * wide, height + 2.5, 0.52 * wide, 1.8)
    ax = sheet.panel(0, 0.5, wide, height + 1, projection="3d")
    membrane(result, load, ax, amplify=look.amplify, limits=look.limits, heights=look.heights, colorbar=bar)
    ax.set_title(ax.get_title().partition(": ")[2], y=1 - 2.5 / (height + 1))
    sheet.centre(ax)
    return height + 12.5


def _map_size(sides: Any, width: float, most: float) -> tuple[float, float]:
    """Width and height of the axes of a map [mm]."""
    shown = stretch_of(sides) * sides + 0.06 * sides.max()
    high = width * float(shown[1] / shown[0])
    return (width, high) if high <= most else (most * float(shown[0] / shown[1]), most)


def draw_plan(sheet: Sheet, result: Result, load: Load, _: float = 0, top: float = 0) -> float:
    wide = sheet.look.width
    sides = np.ptp(result.mesh.nodes, axis=0)
    flat = sides[0] > 2 * sides[1]
    room = wide - LEFT - (RIGHT if flat else 17)
    width, high = _map_size(sides, room, 0.72 * wide)
    left, down = LEFT + (room - width) / 2, top + ABOVE + (12.0 if flat else 0)
    bar = (sheet.panel(left + 0.15 * width, top + ABOVE, 0.7 * width, 1.8) if flat else
           sheet.panel(left + width + 2.5, down, 1.8, high))
    ax = sheet.panel(left, down, width, high)
    plan(result, load, ax, colorbar=bar)
    heading_of_map = ax.get_title().partition(": ")[2]
    ax.set_title("")
    (bar if flat else ax).set_title(heading_of_map)
    if flat:
        bar.xaxis.set_ticks_position("bottom")
    return down - top + high + BELOW + sheet.legend(ax, 2, _handles(ax))


def draw_curves(draw: Any, sheet: Sheet, result: Result, load: Load, left: float = 0, top: float = 0) -> float:
    """Draws curves with one of the functions of this folder."""
    high = 0.5 * sheet.look.width
    ax = sheet.axes(left, top + ABOVE, high)
    draw(result, load, ax=ax)
    ax.set_title(ax.get_title().rpartition(": ")[2])
    return ABOVE + high + BELOW + (sheet.legend(ax, 1, _handles(ax)) if ax.get_legend() else 0)


def _draw_along(sheet: Sheet, result: Result, load: Load, index: int, left: float, heights: tuple[float, ...]) -> float:
    """Draws u on both sides, [u] and, if it has a height, the pressure over one axis; heights of the panels in mm."""
    line, trace = result.interfaces[index], load.traces[index]
    profile = Profile(result, line)
    panels, bottom = sheet.stack(left, [heights[0], *heights[1:2] * can_open(line),
                                        *heights[2:] * pressed(line, trace)])
    draw_traces(result, load, index, panels[0], ("#0072B2", "#D55E00"))
    shade(profile, trace, panels[0])
    finish(panels[0], profile, [load], index, "u", unit_of(result))
    profile.bars(result, panels[0])
    panels[0].set_title(heading(result, load, line) + not_converged(load))
    below = iter(panels[1:])
    if can_open(line):
        ax = next(below)
        jump(result, load, index, ax)
        ax.yaxis.set_major_locator(rounded(3))
    for ax in below:
        pressure(result, load, index, ax, whole=True)
    _over_one_axis(panels)
    return bottom + sheet.legend(panels[-1], 2, _handles(panels[0]))


def traces_picture(look: Look, result: Result, load: Load, index: int) -> Files:
    sheet, scale = Sheet(look, title_of(result, load)), look.width / 85
    return sheet.files(_draw_along(sheet, result, load, index, 0, (34 * scale, 18 * scale, 20 * scale)))


def together_picture(look: Look, result: Result, loads: list[Load], index: int) -> Files:
    """Draws [u], u-, u+ and, if there is contact, the pressure along an interface; colour and dash mark the load."""
    sheet, scale = Sheet(look, title_of(result)), look.width / 85
    line, traces = result.interfaces[index], [load.traces[index] for load in loads]
    profile, offset = Profile(result, line), common(traces)
    pressures = [edge_pressure(line, trace) for trace in traces]
    touching = any(closed.any() for *_, closed in pressures)
    panels, bottom = sheet.stack(0, [scale * height for height in (28, 26, 26, *[24] * touching)])
    curves = [Line2D([], [], color=color, linestyle=dash, label=named(load.name, 24))
              for load, (color, dash) in zip(loads, CURVES)]
    for ax, name, column in zip(panels, ("[u]", "u\u207b", "u\u207a"), ("jump", "u_minus", "u_plus")):
        less = 0.0 if column == "jump" else offset
        for trace, (color, dash) in zip(traces, CURVES):
            ax.plot(profile.at, getattr(trace, column) - less, color=color, linestyle=dash)
        finish(ax, profile, loads, index, name if not less else f"{name} \u2212 {less:.15g}", unit_of(result))
    profile.bars(result, panels[2])
    for ax in panels[3:]:
        for (s, means, lengths, closed), (color, dash) in zip(pressures, CURVES):
            ax.plot(profile.place(s), np.where(closed, means, np.nan), color=color, linestyle=dash)
        finish(ax, profile, [], index, "pressure", unit_of(result, "F/L"))
        ax.set_ylim(0, 1.06 * max(cut(means[closed], lengths[closed], 0.9, 1.5)[0]
                                  for _, means, lengths, closed in pressures))
        ax.yaxis.set_major_locator(rounded(4))
    panels[0].set_title(f"interface {named(line.name, 30)}" if len(result.interfaces) > 1 else
                        "the interface under each load")
    _over_one_axis(panels)
    return sheet.files(bottom + sheet.legend(panels[-1], 2, curves + _handles(panels[2])))


def picture(draw: Any, look: Look, result: Result, load: Load) -> Files:
    """Makes a picture of one panel with `draw`, e.g. draw_membrane or draw_plan."""
    sheet = Sheet(look, title_of(result, load))
    return sheet.files(draw(sheet, result, load))


def growth_picture(look: Look, result: Result, load: Load) -> Files:
    """Draws the load against the displacement above, and G1 and Gc against the fronts below."""
    sheet = Sheet(look, title_of(result, load))
    top = draw_curves(growth, sheet, result, load)
    return sheet.files(top + draw_curves(release, sheet, result, load, 0, top))


draw_convergence = functools.partial(draw_curves, convergence)


def overview_picture(look: Look, result: Result, load: Load, opened: int, closed: int) -> Files:
    """Draws the membrane left and the traces of an interface right, as in the paper's Figures 2-5. A second row, if
    there is something to show, has the plan and the first available of contact pressure, bounds of an accuracy and
    convergence."""
    sheet, scale = Sheet(look, title_of(result, load), 2), look.width / 85
    row = max(draw_membrane(sheet, result, load),
              _draw_along(sheet, result, load, opened, look.width, (25 * scale, 13 * scale)))
    if pressed(result.interfaces[closed], load.traces[closed]):
        draw: Any = functools.partial(pressure, interface=closed)
    elif len(bounded(load)["triangles"]) > 1:
        draw = errors
    elif load.history and len(load.history["iteration"]) > 2:
        draw = convergence
    else:
        return sheet.files(row)
    right = draw_curves(draw, sheet, result, load, look.width, row)
    return sheet.files(row + max(right, draw_plan(sheet, result, load, 0, row)))


def _stacked(look: Look, result: Result, draw: list[Any], more: str = "") -> Files:
    """Draws panels of a sweep over one axis, with their legends below all panels."""
    sheet = Sheet(look, title_of(result) or "sweep")
    panels, bottom = sheet.stack(0, [0.44 * look.width] * len(draw))
    for each, ax in zip(draw, panels):
        each(ax=ax)
    handles = _handles(*(ax for ax in panels if ax.get_legend() is not None))
    for ax in panels:
        ax.legend_ = None
    panels[0].set_title(_rows(result) + more)
    _over_one_axis(panels)
    return sheet.files(bottom + sheet.legend(panels[-1], 3, handles))


def draw_accuracy(sheet: Sheet, result: Result, load: Load) -> float:
    """Draws the errors over the triangles of the stages, and the band of the energy below."""
    high = 0.4 * sheet.look.width
    upper = sheet.axes(0, ABOVE, high)
    errors(result, load, upper)
    legend_below(upper, 1, 1.2 / INCH)
    top = ABOVE + high + 5 + KEY * len(_handles(upper))
    lower = sheet.axes(0, top, high, sharex=upper)
    error_band(result, load, lower)
    _over_one_axis([upper, lower])
    return top + high + BELOW + sheet.legend(lower, 1, _handles(lower))


def _rows(result: Result) -> str:
    assert result.sweep is not None
    count, left_out = len(result.sweep.status), int((~result.sweep.converged).sum())
    return f"{count} row{'' if count == 1 else 's'}" + (f", {left_out} without an answer left out" if left_out else "")


def sweep_picture(look: Look, result: Result) -> Files:
    """Draws A of every inclusion above, and the contact length below."""
    columns = result.sweep
    assert columns is not None
    panels: list[Any] = [functools.partial(sweep, result)] if columns.inclusions else []
    shaded = bool(panels) and columns.displacement_lower is not None and Rows(columns).joined
    return _stacked(look, result, [*panels, functools.partial(contact_length, result)], "; shaded: bounds" * shaded)


def slope_picture(look: Look, result: Result) -> Files:
    return _stacked(look, result, [functools.partial(slopes, result, part) for part in (0, 1)])


def contact_picture(look: Look, result: Result, index: int) -> Files:
    sheet, high = Sheet(look, title_of(result) or "sweep"), 0.6 * look.width
    ax = sheet.axes(0, ABOVE, high)
    contact_map(result, index, ax)
    ax.set_title(f"{ax.get_title()}, {_rows(result)}")
    return sheet.files(ABOVE + high + BELOW + sheet.legend(ax, 2, _handles(ax)))


def mesh_picture(look: Look, plan_of: Plan) -> tuple[Files, list[str]]:
    """Draws the whole mesh and, if there is one, the finest tip. Returns the picture and notes on what is left out."""
    tip, notes, panels = plan_of.finest(), list[str](), list[Any]()
    sheet = Sheet(look, plan_of.message.title or plan_of.message.name, 1 if tip is None else 2)
    room, bottom = look.width - LEFT - RIGHT, 0.0
    for column, (where, shown) in enumerate([("in the whole", None)] + [("around the tip", tip)] * (tip is not None)):
        sides = plan_of.high - plan_of.low if shown is None else np.ones(2)
        width, high = _map_size(sides, room, 0.9 * look.width)
        panels.append(sheet.panel(column * look.width + LEFT + (room - width) / 2, ABOVE, width, high))
        left_out = draw_mesh(plan_of, panels[-1], shown)
        if left_out:
            notes.append(f"no triangles drawn {where}: {left_out} of them could not be told apart")
        bottom = max(bottom, high)
    columns = 2 if tip is None else 4
    handles = _handles(panels[0])
    panels[0].figure.legend(handles=handles, loc="upper center", bbox_to_anchor=(0.5, sheet.height(
        ABOVE + bottom + BELOW)), ncol=columns, fontsize="small", borderaxespad=0.2)
    return sheet.files(ABOVE + bottom + BELOW + 1 + KEY * -(-len(handles) // columns)), notes
