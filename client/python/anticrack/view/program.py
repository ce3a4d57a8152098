# SPDX-License-Identifier: GPL-3.0-or-later
"""`anticrack view [RESULT.h5 | jobs/ID | CASE.toml]`."""
from __future__ import annotations

import argparse
import asyncio
import os
import pathlib
import socket
import webbrowser
from collections.abc import Sequence

from aiohttp import web

from .. import aio
from ..case import Case
from ..command_line import Parser, add_server, client_of, code_of, complain, number
from ..errors import Error
from . import cases, exports, jobs, pages as files, scene, tables
from .gate import Gate, add_headers, reply
from .opened import FILE, Opened
from .told import Pages, Told

_MESSAGE = 16 << 20  # bytes of the longest request: the text of a case


def _parser() -> Parser:
    parser = Parser("anticrack view", allow_abbrev=False, description="Shows jobs as they run and results in a "
                    "browser. Only this machine is served, and only the browser that opens the printed address.",
                    epilog="Example: anticrack view opening.h5")
    parser.add_argument("what", nargs="?", default="", metavar="RESULT.h5 | STUDY.h5 | jobs/ID | CASE.toml",
                        help="a file of a result or a study; a job of the server; or a case, which is run and shown")
    parser.add_argument("--port", type=number(0, 65535, int), default=0, help="of this machine, default: a free one")
    parser.add_argument("--no-browser", action="store_true", help="print the address and open nothing")
    parser.add_argument("--until-closed", action="store_true", help="end when the last page has been closed")
    add_server(parser)
    return parser


async def _serve(given: argparse.Namespace, own: socket.socket) -> None:
    """Opens what is to be shown, and serves the page until a signal, or the last page, raises GracefulExit."""
    plain, gate = client_of(aio, given)._session, Gate("127.0.0.1:%d" % own.getsockname()[1])
    session = Told(plain.transport, plain.address, plain.backoff)
    try:
        opened, pages = Opened(session), Pages(session, given.until_closed)
        first, path = given.what, pathlib.Path(given.what)
        is_case = first.endswith(".toml")
        editor = cases.Editor(session, opened, path if is_case else None)
        if is_case:
            first = await editor.submit(Case.read(path))
        elif first and not first.startswith("jobs/"):
            await opened.open_file(path)
            first = FILE
        app = web.Application(middlewares=[gate.check], client_max_size=_MESSAGE)
        app.on_response_prepare.append(add_headers)

        async def begin(_: web.Request) -> web.Response:
            return reply({"of": first, "server": session.address, "file": path.name if first == FILE else ""})
        app.router.add_get("/api/begin", begin)
        for add in (scene, tables, exports):
            add.add_routes(app, opened)
        jobs.add_routes(app, session, pages, opened)
        cases.add_routes(app, editor)
        files.add_routes(app)
        runner = web.AppRunner(app, access_log=None, handle_signals=True)
        await runner.setup()
        try:
            await web.SockSite(runner, own, shutdown_timeout=0.5).start()
            address = f"http://{gate.host}/?token={gate.token}"
            print(f"the page is at {address}\nCtrl-C ends it", flush=True)
            if not given.no_browser:
                await asyncio.to_thread(webbrowser.open, address)
            await asyncio.Event().wait()
        finally:
            await runner.cleanup()
    finally:
        await session.transport.close()


def _listen(port: int) -> socket.socket:
    try:
        return socket.create_server(("127.0.0.1", port))
    except OSError as error:
        raise Error(f"--port {port}: {os.strerror(error.errno or 0)}; name another, or leave it out for a free one"
                    ) from None


def main(words: Sequence[str]) -> int:
    """Runs a command line and returns the exit code: 0, 2, or 4 if the server cannot be reached."""
    try:
        given = _parser().parse_args(words)
        with _listen(given.port) as own:
            asyncio.run(_serve(given, own))
    except (web.GracefulExit, KeyboardInterrupt):
        pass
    except Error as error:
        complain(error)
        return code_of(error)
    return 0
