# SPDX-License-Identifier: GPL-3.0-or-later
"""What the files of `anticrack plot` and `anticrack mesh show` have in them: panels of this folder put together, each
a picture of one column or, of two columns, an overview. Each returns the picture by format."""
from __future__ import annotations

import functools
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..result import Load, Result
from .along import Profile, can_open, draw_traces, edge_pressure, finish, heading, jump, pressed, pressure, shade
from .history import bounded, convergence, error_band, errors
from .meshes import Plan, draw_mesh
from .panel import CURVES, cut, legend_below, named, offset_of, rounded, stretch_of
from .perspective import membrane, not_converged, view
from .plane import plan
from .sheet import ABOVE, BELOW, KEY, LEFT, RIGHT, Look, Sheet
from .sweeps import Rows, contact_length, contact_map, slopes, sweep

Files = dict[str, bytes]
_GAP = 3.0  # between panels over one axis, mm


def title_of(result: Result, load: Load | None = None) -> str:
    return " \u2014 ".join(text for text in (result.title, load.name if load else "") if text)


def _axes(sheet: Sheet, left: float, top: float, height: float, **options: Any) -> Any:
    """Of a column, without what its numbers and names take."""
    return sheet.panel(left + LEFT, top, sheet.look.width - LEFT - RIGHT, height, **options)


def _legend(ax: Any, columns: int, handles: list[Any] | None = None, labels: list[str] | None = None) -> float:
    """Below the axis, in place of its own; its height, mm."""
    if handles is None or labels is None:
        if ax.get_legend() is None:
            return 0.0
        handles, labels = ax.get_legend_handles_labels()
    legend_below(ax, columns, (BELOW - 1) / 25.4, handles=handles, labels=labels)
    rows: int = -(-len(labels or ()) // columns)
    return 1 + KEY * rows


def _draw_membrane(sheet: Sheet, result: Result, load: Load, *_: float) -> float:
    look, wide = sheet.look, sheet.look.width
    height = 0.7 * wide
    bar = sheet.panel(0.24 * wide, height + 2.5, 0.52 * wide, 1.8)
    aside = (-0.05 if view(result)[1] > -90 else 0.085) * wide  # room for the numbers of u
    ax = sheet.panel(aside, 0.5, wide, height + 1, projection="3d")
    membrane(result, load, ax, amplify=look.amplify, limits=look.limits, colorbar=bar)
    ax.set_title(ax.get_title().partition(": ")[2], y=1 - 2.5 / (height + 1))
    return height + 12.5


def _map_size(sides: Any, width: float, most: float) -> tuple[float, float]:
    """Of the axes of a map, mm."""
    shown = stretch_of(sides) * sides + 0.06 * sides.max()
    high = width * float(shown[1] / shown[0])
    return (width, high) if high <= most else (most * float(shown[0] / shown[1]), most)


def _draw_plan(sheet: Sheet, result: Result, load: Load, _: float, top: float) -> float:
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
    ax.grid(False)
    heading_of_map = ax.get_title().partition(": ")[2]
    ax.set_title("")
    (bar if flat else ax).set_title(heading_of_map)
    if flat:
        bar.xaxis.set_ticks_position("bottom")
    legend = ax.get_legend()
    handles = legend.legend_handles if hasattr(legend, "legend_handles") else legend.legendHandles  # before 3.7
    labels = [text.get_text() for text in legend.get_texts()]
    return down - top + high + BELOW + _legend(ax, 2, handles, labels)


def _draw_along(sheet: Sheet, result: Result, load: Load, index: int, left: float, heights: tuple[float, float, float],
                with_pressure: bool) -> float:
    """u on both sides, [u] and the pressure over one axis; heights of the panels, mm."""
    line, trace = result.interfaces[index], load.traces[index]
    profile, unit = Profile(result, line), result.units.behind("L").strip()
    top = ABOVE
    sides = _axes(sheet, left, top, heights[0])
    draw_traces(result, load, index, sides, ("#0072B2", "#D55E00"))
    shade(profile, trace, sides)
    finish(sides, profile, load, [trace.u_minus, trace.u_plus, trace.jump], "u", unit)
    profile.bars(result, sides)
    sides.set_title(heading(result, load, line) + not_converged(load))
    top += heights[0]
    panels = [sides]
    if can_open(line):
        panels.append(_axes(sheet, left, top + _GAP, heights[1], sharex=sides))
        jump(result, load, index, panels[-1])
        panels[-1].yaxis.set_major_locator(rounded(3))
        top += _GAP + heights[1]
    if with_pressure and pressed(line, trace):
        panels.append(_axes(sheet, left, top + _GAP, heights[2], sharex=sides))
        pressure(result, load, index, panels[-1], whole=True)
        top += _GAP + heights[2]
    for ax in panels[1:]:
        ax.set_title("")
    _over_one_axis(panels)
    return top + BELOW + _legend(panels[-1], 2, *sides.get_legend_handles_labels())


def _over_one_axis(panels: list[Any]) -> None:
    for ax in panels[:-1]:
        ax.tick_params(labelbottom=False)
        ax.set_xlabel("")
    figure = panels[0].figure
    width = panels[0].get_position().width * figure.get_size_inches()[0]
    for ax in panels:  # names in one line, wherever the numbers end
        ax.yaxis.set_label_coords(-(LEFT - 4) / 25.4 / width, 0.5)


def traces_picture(look: Look, result: Result, load: Load, index: int) -> Files:
    sheet, scale = Sheet(look, title_of(result, load)), look.width / 85
    return sheet.files(_draw_along(sheet, result, load, index, 0, (34 * scale, 18 * scale, 20 * scale), True))


def together_picture(look: Look, result: Result, loads: list[Load], index: int) -> Files:
    """[u], u- and u+ and, where there is contact, the pressure along an interface; colour and dash are the load."""
    sheet, scale = Sheet(look, title_of(result)), look.width / 85
    line, unit = result.interfaces[index], result.units.behind("L").strip()
    profile, traces = Profile(result, line), [load.traces[index] for load in loads]
    energy = max((load for load in loads), key=lambda load: abs(load.energy) if np.isfinite(load.energy) else 0)
    every = np.concatenate([values for trace in traces for values in (trace.u_minus, trace.u_plus)])
    every = every[np.isfinite(every)]
    offset = offset_of(every.min(), every.max(), max(np.ptp(trace.jump) for trace in traces)) if len(every) else 0.0
    top, panels = ABOVE, list[Any]()
    for name, column, height in (("[u]", "jump", 28), ("u\u207b", "u_minus", 26), ("u\u207a", "u_plus", 26)):
        ax = _axes(sheet, 0, top, height * scale, **({"sharex": panels[0]} if panels else {}))
        less = 0.0 if column == "jump" else offset
        for trace, (color, dash) in zip(traces, CURVES):
            ax.plot(profile.at, getattr(trace, column) - less, color=color, linestyle=dash)
        values = [values for trace in traces for values in (trace.u_minus, trace.u_plus, trace.jump)]
        if column == "jump" and len(every) and max(np.nanmax(np.abs(trace.jump), initial=0) for trace in traces) <= (
                1e-9 * np.abs(every).max()):
            ax.set_ylim(-np.abs(every).max() or -1, np.abs(every).max() or 1)
        finish(ax, profile, energy, values, name if not less else f"{name} \u2212 {less:.15g}", unit)
        top += height * scale + _GAP
        panels.append(ax)
    profile.bars(result, panels[-1])
    of_parts = panels[-1].get_legend_handles_labels()
    found = [edge_pressure(line, trace) for trace in traces]
    if any(closed.any() for *_, closed in found):
        ax = _axes(sheet, 0, top, 24 * scale, sharex=panels[0])
        shown = 0.0
        for (s, means, lengths, closed), (color, dash) in zip(found, CURVES):
            ax.plot(profile.place(s), np.where(closed, means, np.nan), color=color, linestyle=dash)
            shown = max(shown, cut(means[closed], lengths[closed], 0.9, 1.5)[0])
        finish(ax, profile, energy, [], "pressure", result.units.behind("F/L").strip())
        ax.set_ylim(0, 1.06 * shown)
        ax.yaxis.set_major_locator(rounded(4))
        top += 24 * scale + _GAP
        panels.append(ax)
    panels[0].set_title(f"interface {named(line.name, 30)}" if len(result.interfaces) > 1 else
                        "the interface under each load")
    _over_one_axis(panels)
    handles = [Line2D([], [], color=color, linestyle=dash) for _, (color, dash) in zip(loads, CURVES)]
    key = _legend(panels[-1], 2, handles + of_parts[0], [named(load.name, 24) for load in loads] + of_parts[1])
    return sheet.files(top - _GAP + BELOW + key)


def _draw_curves(draw: Any, sheet: Sheet, result: Result, load: Load, left: float, top: float) -> float:
    """By one of the functions of this folder."""
    high = 0.5 * sheet.look.width
    ax = _axes(sheet, left, top + ABOVE, high)
    draw(result, load, ax=ax)
    ax.set_title(ax.get_title().rpartition(": ")[2])
    return ABOVE + high + BELOW + _legend(ax, 1)


def picture(figure: str, look: Look, result: Result, load: Load) -> Files:
    """Of one panel: "membrane", "plan" or "convergence"."""
    sheet = Sheet(look, title_of(result, load))
    draw: dict[str, Any] = {"membrane": _draw_membrane, "plan": _draw_plan,
                            "convergence": functools.partial(_draw_curves, convergence)}
    return sheet.files(draw[figure](sheet, result, load, 0, 0))


def accuracy_picture(look: Look, result: Result, load: Load) -> Files:
    sheet, high = Sheet(look, title_of(result, load)), 0.4 * look.width
    upper = _axes(sheet, 0, ABOVE, high)
    errors(result, load, upper)
    top = ABOVE + high + 2 + KEY * len(upper.get_legend_handles_labels()[0])
    legend_below(upper, 1, 1.2 / 25.4)
    lower = _axes(sheet, 0, top + _GAP, high, sharex=upper)
    error_band(result, load, lower)
    lower.set_title("")
    _over_one_axis([upper, lower])
    return sheet.files(top + _GAP + high + BELOW + _legend(lower, 1))


def overview_picture(look: Look, result: Result, load: Load, opened: int, closed: int) -> Files:
    """Membrane left, traces of an interface right, as in the paper's Figures 2-5. Where there is something for it, a
    second row: the plan, and the first that there is of the contact pressure, the bounds of an accuracy and the
    convergence."""
    sheet, scale = Sheet(look, title_of(result, load), 2), look.width / 85
    row = max(_draw_membrane(sheet, result, load), _draw_along(
        sheet, result, load, opened, look.width, (25 * scale, 13 * scale, 0), False))
    if pressed(result.interfaces[closed], load.traces[closed]):
        draw: Any = functools.partial(pressure, interface=closed)
    elif len(bounded(load)["triangles"]) > 1:
        draw = errors
    elif load.history and len(load.history["iteration"]) > 2:
        draw = convergence
    else:
        return sheet.files(row)
    right = _draw_curves(draw, sheet, result, load, look.width, row)
    return sheet.files(row + max(right, _draw_plan(sheet, result, load, 0, row)))


def _rows(result: Result) -> str:
    columns = result.sweep
    assert columns is not None
    count, left_out = len(columns.status), int((~columns.converged).sum())
    return f"{count} row{'' if count == 1 else 's'}" + (f", {left_out} without an answer left out" if left_out else "")


def _stacked(look: Look, result: Result, draw: list[Any], bounds: bool = False) -> Files:
    """Panels over one axis, the legend of the first below all."""
    sheet, high = Sheet(look, title_of(result) or "sweep"), 0.44 * look.width
    panels: list[Any] = []
    for i, each in enumerate(draw):
        panels.append(_axes(sheet, 0, ABOVE + i * (high + _GAP), high, **({"sharex": panels[0]} if panels else {})))
        each(ax=panels[-1])
    handles, labels = panels[0].get_legend_handles_labels()
    legends = [ax.get_legend() for ax in panels if ax.get_legend() is not None]
    for legend in legends:
        legend.remove()
    panels[0].set_title(_rows(result) + ("; shaded: bounds" if bounds else ""))
    _over_one_axis(panels)
    key = _legend(panels[-1], 3, handles[::-1], labels[::-1]) if legends else 0.0
    return sheet.files(ABOVE + len(draw) * (high + _GAP) - _GAP + BELOW + key)


def sweep_picture(look: Look, result: Result) -> Files:
    """A of every inclusion above, contact length below."""
    assert result.sweep is not None
    panels: list[Any] = [lambda ax: sweep(result, ax=ax)] if result.sweep.inclusions else []
    return _stacked(look, result, [*panels, lambda ax: contact_length(result, ax)],
                    bool(panels) and result.sweep.displacement_lower is not None and Rows(result.sweep).joined)


def slope_picture(look: Look, result: Result) -> Files:
    return _stacked(look, result, [lambda ax: slopes(result, 0, ax), lambda ax: slopes(result, 1, ax)])


def contact_picture(look: Look, result: Result, index: int) -> Files:
    sheet, high = Sheet(look, title_of(result) or "sweep"), 0.6 * look.width
    ax = _axes(sheet, 0, ABOVE, high)
    contact_map(result, index, ax)
    ax.set_title(f"{ax.get_title()}, {_rows(result)}")
    legend = ax.get_legend()
    labels = [text.get_text() for text in legend.get_texts()]
    return sheet.files(ABOVE + high + BELOW + _legend(ax, 2, [Patch(color="#e4e4e4"), Patch(color="#0072B2")], labels))


def mesh_picture(look: Look, plan_of: Plan) -> tuple[Files, list[str]]:
    """All of it and, where there is one, the finest tip; and what is left out."""
    tip, notes = plan_of.finest(), []
    sheet = Sheet(look, plan_of.message.title or plan_of.message.name, 1 if tip is None else 2)
    room, bottom, first = look.width - LEFT - RIGHT, 0.0, None
    for column, (where, shown) in enumerate([("in the whole", None)] + [("around the tip", tip)] * (tip is not None)):
        sides = plan_of.high - plan_of.low if shown is None else np.ones(2)
        width, high = _map_size(sides, room, 0.9 * look.width)
        ax = sheet.panel(column * look.width + LEFT + (room - width) / 2, ABOVE, width, high)
        ax.grid(False)
        left_out = draw_mesh(plan_of, ax, shown)
        if left_out:
            notes.append(f"no triangles drawn {where}: {left_out} of them could not be told apart")
        bottom, first = max(bottom, high), first or ax
    assert first is not None
    columns = 2 if tip is None else 4
    handles, labels = first.get_legend_handles_labels()
    first.figure.legend(handles, labels, loc="lower center", ncol=columns, fontsize="small", borderaxespad=0.2)
    return sheet.files(ABOVE + bottom + BELOW + 1 + KEY * -(-len(handles) // columns)), notes
