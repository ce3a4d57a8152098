# SPDX-License-Identifier: GPL-3.0-or-later
"""A case to edit: its errors at their lines, what its keys mean, a drawing of what the server understood, and a run."""
from __future__ import annotations

import asyncio
import itertools
import pathlib
import re
import sys
from typing import Any

from aiohttp import web

from ..arrays import is_number
from ..case import Case
from ..errors import CaseError, Error, ServerError
from ..result import Units
from ..study.rows import rows_in
from ..sweeps import coefficients_of
from ..text import harmless
from ..v1 import case_pb2
from .exports import DRAWING, drawn
from .opened import Opened
from .gate import reply
from .told import Told

_SOURCE = "case"  # what errors call the text in the page
_DRAWN = 4  # drawings that are kept
_TRACES = 100  # rows of a sweep whose traces are kept, the first


def errors_in(error: Exception) -> list[dict[str, Any]]:
    """The lines of an error, each with the line of the case that it names, or 0."""
    found = []
    for line in str(error).splitlines():
        at = re.search(rf"\b{_SOURCE}:(\d+)(?::|,)? *(.*)", line) or re.search(r"\(?at line (\d+)", line)
        found.append({"line": int(at[1]) if at else 0,
                      "message": harmless(at[2] if at and at.re.groups > 1 else line)})
    return found


def gallery() -> dict[str, pathlib.Path]:
    """The examples by their names: those of the package, or of the sources around this file."""
    above = pathlib.Path(__file__).resolve().parents
    folders = [pathlib.Path(sys.prefix) / "share/anticrack/examples", *(each / "client/examples" for each in above)]
    found = next((folder for folder in folders if (folder / "opening.toml").is_file()), None)
    return {path.stem: path for path in sorted(found.glob("*.toml"))} if found else {}


class Editor:
    """path: the case that the command line names; files that a text names are looked for beside it."""

    def __init__(self, session: Told, opened: Opened, path: pathlib.Path | None) -> None:
        self._session, self._opened, self._path = session, opened, path
        self._gallery, self._numbers = gallery(), itertools.count()
        self._drawings: dict[str, bytes] = {}

    def _case(self, asked: Any) -> Case:
        example = self._gallery.get(str(asked.get("example", "")))
        folder = (example or self._path or pathlib.Path("case.toml")).parent
        return Case.parse(str(asked["text"]), _SOURCE, folder)

    async def first(self, _: web.Request) -> web.Response:
        """The case of the command line, and the examples to begin from."""
        text = self._path.read_text(encoding="utf-8") if self._path else ""
        return reply({"text": text, "examples": list(self._gallery)})

    async def example(self, request: web.Request) -> web.Response:
        path = self._gallery.get(request.query["name"])
        if path is None:
            raise Error(f"there is no example {harmless(request.query['name'])}")
        return reply({"text": path.read_text(encoding="utf-8")})

    async def check(self, request: web.Request) -> web.Response:
        asked = await request.json()
        question = case_pb2.ReadCaseRequest(toml=str(asked["text"]).encode("utf-8", "replace"), source=_SOURCE)
        try:
            read = await self._session.call(self._session.transport.cases.ReadCase, question)
        except ServerError as error:
            if error.reason != "CASE_INVALID":
                raise
            return reply({"errors": errors_in(CaseError(error.message)), "notes": []})
        return reply({"errors": [], "notes": [harmless(note) for note in read.notes]})

    async def run(self, request: web.Request) -> web.Response:
        asked = await request.json()
        try:
            return reply({"name": await self.submit(self._case(asked), **_sweep(asked))})
        except (CaseError, ServerError) as error:
            return reply({"errors": errors_in(error)})

    async def submit(self, case: Case, **sweep: Any) -> str:
        """Submits the case, or a sweep of it, and returns the job's name."""
        job, read = await self._session.submit(case, **sweep)
        self._opened.cases[job.name] = read.text
        if sweep:
            self._opened.coefficients[job.name] = coefficients_of(sweep["coefficients"],
                                                                  [load.name for load in job.spec.load_cases])
        return str(job.name)

    async def draw(self, request: web.Request) -> web.Response:
        """Meshes the case and draws the mesh; the page then asks for the drawing by its number."""
        case = self._case(await request.json())
        try:
            mesh = await self._session.mesh_of(case)
        except (CaseError, ServerError) as error:
            return reply({"errors": errors_in(error)})
        arrays = await self._session.mesh_arrays(mesh.name)
        units = case.tables.get("units", {})
        number = str(next(self._numbers))
        async with DRAWING:
            self._drawings[number] = await asyncio.to_thread(_drawn, mesh, arrays, Units(str(units.get("length", ""))))
        for old in list(self._drawings)[:-_DRAWN]:
            del self._drawings[old]
        return reply({"number": number, "triangles": mesh.triangle_count, "nodes": mesh.node_count,
                      "warnings": list(mesh.warnings)})

    async def drawing(self, request: web.Request) -> web.Response:
        return web.Response(body=self._drawings[request.query["number"]], content_type="image/svg+xml")

    async def keys(self, _: web.Request) -> web.Response:
        answer = await self._session.call(self._session.transport.cases.ListCaseKeys, case_pb2.ListCaseKeysRequest())
        return reply([{"names": list(key.names), "form": key.form, "default": key.if_absent, "unit": key.unit,
                       "meaning": key.meaning} for key in answer.keys])


def _sweep(asked: Any) -> dict[str, Any]:
    """What the page asks of a sweep, as Session.submit takes it; empty if it asks for none."""
    if "sweep" not in asked:
        return {}
    rows = rows_in(str(asked["sweep"]), "the sweep")
    if not all(is_number(value) for row in rows for value in row.values()):
        raise CaseError("the sweep: below the names of loads there are numbers only")
    columns = {name: [row[name] for row in rows] for name in rows[0]}
    return {"coefficients": columns, "traces": range(min(len(rows), _TRACES)), "bounds": asked["bounds"] is True,
            "tips": asked["tips"] is True}


def _drawn(mesh: Any, arrays: Any, units: Units) -> bytes:
    from ..draw.files import draw_mesh
    from ..draw.meshes import Plan
    from ..draw.sheet import Look
    return drawn(lambda folder: draw_mesh(Plan(mesh, arrays, units), folder, Look(["svg"], 150)))


def add_routes(app: web.Application, editor: Editor) -> None:
    app.add_routes([web.get("/api/case", editor.first), web.get("/api/example", editor.example),
                    web.get("/api/keys", editor.keys), web.get("/api/drawing", editor.drawing),
                    web.post("/api/check", editor.check), web.post("/api/draw", editor.draw),
                    web.post("/api/run", editor.run)])
