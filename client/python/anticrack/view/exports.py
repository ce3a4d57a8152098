# SPDX-License-Identifier: GPL-3.0-or-later
"""Files to take along: figures by the package's drawing code, VTU, the result, the case."""
from __future__ import annotations

import asyncio
import functools
import pathlib
import tempfile
from collections.abc import Callable
from typing import Any

from aiohttp import web

from .. import vtk
from ..commands import FIGURES
from ..errors import Error, package
from ..output import Made, stems
from ..result import Load, Result, fields_cure
from ..study.record import Study
from .opened import FILE, Opened, load_of

DRAWING = asyncio.Lock()  # matplotlib draws one figure at a time
_TYPES = {"png": "image/png", "svg": "image/svg+xml", "vtu": "application/xml", "h5": "application/x-hdf5",
          "toml": "application/toml"}


def drawn(draw: Callable[[str], Made]) -> bytes:
    """The first of the files that are drawn into a folder."""
    with tempfile.TemporaryDirectory() as folder:
        made = draw(folder)
        if not made.files:
            raise Error("; ".join(made.notes) or "there is nothing to draw")
        return pathlib.Path(made.files[0]).read_bytes()


def _figure(of: Result | Study, load: Load | None, kind: str, query: Any) -> bytes:
    package("matplotlib").use("Agg")
    from ..draw import files, studies
    from ..draw.sheet import Look
    figure, look = query.get("figure", "membrane"), Look([kind])
    if isinstance(of, Study):
        return studies.picture(of, look, query.get("among", ""), query.get("column", ""))
    if load is None:
        raise Error("there is no load to draw")
    if figure not in FIGURES:
        raise Error(f"{figure} is none of {', '.join(FIGURES)}")
    if query.get("amplify"):
        look.amplify = float(query["amplify"])
    if query.get("limits"):
        low, high = map(float, query["limits"].split(","))
        look.limits = low, high
    wanted = files.Wanted([figure], query.get("interface", ""), [load.name])
    return drawn(functools.partial(files.draw_figures, of, wanted=wanted, look=look))


def _content(of: Result | Study, load: Load | None, kind: str, query: Any) -> bytes:
    if kind == "h5":
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "result.h5"
            of.save(path)
            return path.read_bytes()
    if kind != "vtu":
        return _figure(of, load, kind, query)
    if not isinstance(of, Result) or load is None or not load.fields:
        raise Error(f"it has no fields; {fields_cure(of)}" if isinstance(of, Result) else "a study has no fields")
    return vtk.membrane(of, load)


def add_routes(app: web.Application, opened: Opened) -> None:
    async def export(request: web.Request) -> web.Response:
        query, kind, name = request.query, request.query["kind"], request.query["of"]
        if kind not in _TYPES:
            raise Error(f"{kind} is none of {', '.join(_TYPES)}")
        of = (opened.study if name == FILE else None) or await opened.result(name)
        load = (await load_of(opened, query))[1] if isinstance(of, Result) and of.loads else None
        if kind == "toml":
            content = (opened.cases.get(name) or of.case).encode()
        elif kind == "h5" and name == FILE and opened.path is not None:
            content = await asyncio.to_thread(opened.path.read_bytes)
        else:
            async with DRAWING:
                content = await asyncio.to_thread(_content, of, load, kind, query)
        named = load.name if load is not None and kind not in ("h5", "toml") else of.title or "result"
        return web.Response(body=content, content_type=_TYPES[kind], headers={
            "Content-Disposition": f'attachment; filename="{stems([named[:80]], [])[0]}.{kind}"'})
    app.router.add_get("/api/export", export)
