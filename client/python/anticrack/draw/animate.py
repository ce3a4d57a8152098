# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations: load cases one after another, u growing to its size and back, stages, growing fronts. Pillow writes GIF
and WebP, ffmpeg MP4. All frames of an animation have the same colours, heights and size."""
from __future__ import annotations

import dataclasses
import io
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from .. import output
from ..commands import ANIMATED, FILMS
from ..errors import Error, package
from ..output import Made
from ..result import Load, Result, chosen
from ..text import harmless
from .growth import growth, place_of, release
from .history import bounded
from .perspective import heights_of
from .pictures import draw_accuracy, draw_curves, draw_membrane, title_of
from .sheet import Look, Sheet

DPI = 150
_MOST, _BEATS, _RATE = 60, 24, 25  # frames of growth and loads, of an amplitude, and a second of a film
_Frames = list[tuple[Any, int]]  # images, and how long each is shown [ms]


def _sheet(look: Look, title: str) -> Sheet:
    return Sheet(dataclasses.replace(look, formats=["png"]), title)


def _image(sheet: Sheet, height: float) -> Any:
    image = package("PIL.Image").open(io.BytesIO(sheet.files(height)["png"])).convert("RGB")
    return image.crop((0, 0, image.width // 2 * 2, image.height // 2 * 2))  # films have even sides


def _shared(look: Look, result: Result, loads: Sequence[Load], rest: bool = False) -> Look:
    """The look with the colours and heights of all loads; rest: also of the membrane at rest."""
    values = [part.u[np.isfinite(part.u)] for load in loads for part in load.fields]
    ends = [(0.0, 0.0)] * rest
    u = ends + [(float(of.min()), float(of.max())) for of in values if of.size]
    tall = ends + [heights_of(result, load) for load in loads]
    low, high = min(of[0] for of in u), max(of[1] for of in u)
    if min(-low, high) > 0.05 * max(-low, high) > 0:
        low, high = -max(-low, high), max(-low, high)
    heights = min(of[0] for of in tall), max(of[1] for of in tall)
    return dataclasses.replace(look, limits=look.limits or (low, high) if high > low else None, heights=heights)


def _membrane(look: Look, result: Result, load: Load) -> Any:
    sheet = _sheet(look, title_of(result, load))
    return _image(sheet, draw_membrane(sheet, result, load))


def _scaled(load: Load, factor: float) -> Load:
    """The load with u times a factor, as drawing the membrane needs it."""
    fields, traces = type(load.fields)(load.fields.what), type(load.traces)(load.traces.what)
    for part in load.fields:
        fields.append(dataclasses.replace(part, u=factor * part.u))
        fields[-1].mesh, fields[-1].units = part.mesh, part.units
    for trace in load.traces:
        traces.append(dataclasses.replace(trace, u_minus=factor * trace.u_minus, u_plus=factor * trace.u_plus))
    scaled = dataclasses.replace(load, fields=fields, traces=traces)
    scaled.units, scaled.solver = load.units, load.solver
    return scaled


def _amplitude(look: Look, result: Result, load: Load) -> _Frames:
    shared = _shared(look, result, [load], rest=True)
    factors = (1 - np.cos(2 * np.pi * np.arange(_BEATS // 2 + 1) / _BEATS)) / 2
    images = [_membrane(shared, result, _scaled(load, factor)) for factor in factors]
    return [(image, 80) for image in [*images, *images[-2:0:-1]]]


def _growth(look: Look, result: Result, load: Load) -> _Frames:
    rows = load.growth
    known = np.flatnonzero(np.isfinite(rows["load"]) & (rows["front"] >= 0))
    shown = known[np.unique(np.linspace(0, len(known) - 1, min(len(known), _MOST)).round().astype(int))]
    sheet = _sheet(look, title_of(result, load))
    height = draw_curves(growth, sheet, result, load)
    height += draw_curves(release, sheet, result, load, 0, height)
    return _followed(sheet, height, [(place_of(rows)[shown], rows["load"][shown]),
                                     (rows["position"][shown], rows["G1"][shown])], 120)


def _stages(look: Look, result: Result, load: Load) -> _Frames:
    sheet, at = _sheet(look, title_of(result, load)), bounded(load)
    height = draw_accuracy(sheet, result, load)
    energies = dict(zip(load.stages["triangles"].tolist(), load.stages["energy"].tolist()))
    triangles = at["triangles"]
    return _followed(sheet, height, [(triangles, at["error"]), (triangles, [energies[n] for n in triangles])], 880)


def _followed(sheet: Sheet, height: float, curves: Sequence[tuple[Any, Any]], time: int) -> _Frames:
    """A dot on the curve (x, y) of each panel goes from point to point."""
    dots = [ax.plot([], [], "o", color="#222222", markersize=5, zorder=9, clip_on=False)[0] for ax in sheet.panels]
    frames = []
    for i in range(len(curves[0][0])):
        for dot, (x, y) in zip(dots, curves):
            dot.set_data([x[i]], [y[i]])
        frames.append((_image(sheet, height), time))
    return frames


# Of an animation of each load: what a load needs to have, what to write in the case if none has, and its frames.
_OF_LOADS: dict[str, tuple[Any, str, Any]] = {
    "amplitude": (lambda load: load.fields, "no load has fields: solve with [output] fields = true", _amplitude),
    "stages": (lambda load: len(bounded(load)["triangles"]) > 1,
               "no load has two stages with bounds: write [accuracy] in the case", _stages),
    "growth": (lambda load: load.growth, "no load grows: write [growth] in the case", _growth)}


def _animations(result: Result, what: str, names: Sequence[str], look: Look) -> Iterator[tuple[str, _Frames]]:
    """The animations with their stems. Raises Error if there is nothing to show."""
    if what not in ANIMATED:
        raise Error(f"{harmless(what)} is none of {', '.join(ANIMATED)}")
    has, cure, draw = _OF_LOADS[what if what != "loads" else "amplitude"]
    loads = [load for load in chosen(result, names) if has(load)]
    if not loads:
        raise Error(cure)
    if what == "loads":
        if len(loads) > _MOST:
            raise Error(f"{len(loads)} loads are more than {_MOST}; choose some with --load")
        shared = _shared(look, result, loads)
        yield "loads", [(_membrane(shared, result, load), 1200) for load in loads]
        return
    for load, stem in zip(loads, output.stems((load.name for load in loads), [f"-{what}"])):
        yield f"{stem}-{what}", draw(look, result, load)


def _encoded(frames: _Frames, kind: str) -> bytes:
    images, times = [image for image, _ in frames], [time for _, time in frames]
    if kind == "mp4":
        return _film(frames)
    if kind == "webp" and not package("PIL.features").check("webp_anim"):
        raise Error("this Pillow writes no animated WebP; choose gif")
    content = io.BytesIO()
    if kind == "gif":
        images = _indexed(images)
    images[0].save(content, kind, save_all=True, append_images=images[1:], duration=times, loop=0)
    return content.getvalue()


def _indexed(images: list[Any]) -> list[Any]:
    """The images in colours of one palette, as a palette of each would flicker."""
    every = np.concatenate([np.asarray(image).reshape(-1, 3) for image in images[::max(1, len(images) // 8)]])
    colours = np.unique(every, axis=0)  # each once, as most of the image is white
    palette = package("PIL.Image").fromarray(colours[None]).quantize(255, kmeans=2)
    palette.putpalette([*palette.getpalette()[:765], 255, 255, 255])  # the background
    return [image.quantize(palette=palette, dither=0) for image in images]


def _film(frames: _Frames) -> bytes:
    program = shutil.which("ffmpeg")
    if program is None:
        raise Error("MP4 is written by ffmpeg, which is not installed; install it with 'apt install ffmpeg', or choose "
                    "gif or webp")
    width, height = frames[0][0].size
    raw = b"".join(image.tobytes() * max(1, round(time * _RATE / 1000)) for image, time in frames)
    with tempfile.NamedTemporaryFile(suffix=".mp4") as film:  # a pipe would not do, as its index is written last
        ended = subprocess.run([
            program, "-nostdin", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
            "-s", f"{width}x{height}", "-r", str(_RATE), "-i", "-", "-an",
            "-pix_fmt", "yuv420p", "-movflags", "+faststart", film.name], input=raw, capture_output=True, check=False)
        if ended.returncode != 0:
            raise Error(f"ffmpeg ended with code {ended.returncode}: {ended.stderr.decode(errors='replace')[-300:]}")
        return film.read()


def draw_animations(result: Result, folder: str, what: str, names: Sequence[str], look: Look) -> Made:
    """Writes the animation "loads", or LOAD-amplitude, -stages or -growth of each load, in the look's formats."""
    drawn = Made(folder)
    output.make_folder(folder)
    with look.applied():
        for stem, frames in _animations(result, what, names, look):
            drawn.add(stem, {kind: _encoded(frames, kind) for kind in look.formats})
    return drawn


def animate(result: Result, path: str | os.PathLike[str], what: str = "amplitude", load: str | None = None) -> None:
    """Writes an animation, GIF, WebP or MP4 by the path's end. what: "loads" (one after another), "amplitude" (u of a
    load, by default the first, to its size and back), "stages" or "growth". The first two need fields."""
    kind = os.path.splitext(os.fspath(path))[1][1:].lower()
    if kind not in FILMS:
        raise Error(f"{os.fspath(path)}: its name ends in none of .{', .'.join(FILMS)}")
    names = [load] if load is not None else [] if what == "loads" else list(result.loads)[:1]
    look = Look([kind], DPI)
    with look.applied():
        _, frames = next(_animations(result, what, names, look))
        output.write(path, _encoded(frames, kind))
