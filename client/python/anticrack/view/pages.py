# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of the page: its own, which lie beside this one, and libraries of Debian's packages."""
from __future__ import annotations

import pathlib

from aiohttp import web

from ..errors import Error

_SHARED = pathlib.Path("/usr/share/javascript")
# three.js and its OrbitControls (MIT, libjs-three), Chart.js (MIT, libjs-chart.js).
_LIBRARIES = {"three.js": _SHARED / "three/three.min.js",
              "orbit.js": _SHARED / "three/examples/js/controls/OrbitControls.js",
              "chart.js": _SHARED / "chart.js/chart.min.js"}
_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".svg": "image/svg+xml"}


class Pages:
    """Every file is known by name before the first request, so that no path leads elsewhere."""

    def __init__(self) -> None:
        missing = [path for path in _LIBRARIES.values() if not path.is_file()]
        if missing:
            raise Error(f"there is no {missing[0]}; install libjs-three and libjs-chart.js")
        own = sorted((pathlib.Path(__file__).parent / "page").iterdir())
        self._files = {path.name: path for path in own if path.suffix in _TYPES} | {
            f"lib-{name}": path for name, path in _LIBRARIES.items()}

    async def file(self, request: web.Request) -> web.Response:
        name = request.match_info.get("name", "index.html")
        if name not in self._files:
            raise web.HTTPNotFound(text="there is no such file")
        path = self._files[name]
        return web.Response(body=path.read_bytes(), content_type=_TYPES[path.suffix], charset="utf-8")
