# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of the page: its own, which lie beside this one, and libraries of Debian's packages."""
from __future__ import annotations

import functools
import pathlib

from aiohttp import web

from ..errors import Error

_SHARED = pathlib.Path("/usr/share/javascript")
# three.js and its OrbitControls (MIT, libjs-three), Chart.js (MIT, libjs-chart.js).
_LIBRARIES = {"lib-three.js": _SHARED / "three/three.min.js",
              "lib-orbit.js": _SHARED / "three/examples/js/controls/OrbitControls.js",
              "lib-chart.js": _SHARED / "chart.js/chart.min.js"}


async def _send(path: pathlib.Path, _: web.Request) -> web.FileResponse:
    return web.FileResponse(path)


def add_routes(app: web.Application) -> None:
    """Every file has a route of its own, so that no path leads elsewhere."""
    missing = [path for path in _LIBRARIES.values() if not path.is_file()]
    if missing:
        raise Error(f"there is no {missing[0]}; install libjs-three and libjs-chart.js")
    own = {path.name: path for path in (pathlib.Path(__file__).parent / "page").glob("[!.]*")}
    for name, path in {"": own["index.html"], **own, **_LIBRARIES}.items():
        app.router.add_get(f"/{name}", functools.partial(_send, path))
