# SPDX-License-Identifier: GPL-3.0-or-later
"""`anticrack view [RESULT.h5 | jobs/ID | CASE.toml]`."""
from __future__ import annotations

import argparse
import asyncio
import pathlib
import signal
import webbrowser
from collections.abc import Sequence

from aiohttp import web

from ..aio import AsyncTransport
from ..case import Case
from ..command_line import Parser, add_server, code_of, complain, credentials, number
from ..credentials import Credentials, address_of
from ..errors import Error
from ..private_server import Server
from ..retry import Backoff
from . import cases, exports, jobs, scene, tables
from .gate import Gate, add_headers, reply
from .opened import FILE, Opened
from .pages import Pages as Files
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


def _session(given: argparse.Namespace) -> Told:
    server = Server() if given.local else None
    address = server.address if server else address_of(given.server)
    secrets = Credentials() if server else credentials(given)
    return Told(AsyncTransport(address, secrets, server), address, Backoff(300.0, 3.0))


async def _serve(given: argparse.Namespace) -> None:
    stop, loop = asyncio.Event(), asyncio.get_running_loop()
    for sign in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(sign, stop.set)
    session = _session(given)
    try:
        opened, gate, pages = Opened(session), Gate(), Pages(session)
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
        files = Files()
        app.router.add_get("/", files.file)
        app.router.add_get("/{name}", files.file)
        runner = web.AppRunner(app, access_log=None)
        await runner.setup()
        try:
            await _listen(runner, gate, given, stop if not given.until_closed else pages.left, stop)
        finally:
            await runner.cleanup()
    finally:
        await session.transport.close()


async def _listen(runner: web.AppRunner, gate: Gate, given: argparse.Namespace, left: asyncio.Event,
                  stop: asyncio.Event) -> None:
    site = web.TCPSite(runner, "127.0.0.1", given.port, shutdown_timeout=0.5)
    try:
        await site.start()
    except OSError as error:
        raise Error(f"--port {given.port}: {error.strerror}; name another, or leave it out for a free one") from None
    gate.host = "127.0.0.1:%d" % runner.addresses[0][1]
    address = f"http://{gate.host}/?token={gate.token}"
    print(f"the page is at {address}\nCtrl-C ends it", flush=True)
    if not given.no_browser:
        await asyncio.to_thread(webbrowser.open, address)
    waiting = [asyncio.create_task(event.wait()) for event in {left, stop}]
    await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
    for task in waiting:
        task.cancel()


def main(words: Sequence[str]) -> int:
    """Runs a command line and returns the exit code: 0, 2, or 4 if the server cannot be reached."""
    try:
        asyncio.run(_serve(_parser().parse_args(words)))
    except Error as error:
        complain(error)
        return code_of(error)
    return 0
