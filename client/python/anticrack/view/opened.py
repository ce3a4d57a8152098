# SPDX-License-Identifier: GPL-3.0-or-later
"""The results that the page looks at: that of a file, and those of jobs."""
from __future__ import annotations

import asyncio
import pathlib
from typing import Any

from ..result import Result
from ..session import Session

FILE = "file"  # the name of the result of the file; others are "jobs/ID"
_KEPT = 2  # results in memory; a million triangles take some 200 MB


class Opened:
    def __init__(self, session: Session) -> None:
        self._session = session
        self._results: dict[str, asyncio.Task[Result]] = {}
        self.path: pathlib.Path | None = None
        self.cases: dict[str, str] = {}  # texts of the cases of jobs that were submitted here

    async def open_file(self, path: pathlib.Path) -> None:
        """Reads a result file. Raises Error if it is none."""
        self.path = path
        await self.result(FILE)

    async def result(self, name: str) -> Result:
        if name not in self._results:
            self._results[name] = asyncio.create_task(self._read(name))
            jobs = [each for each in self._results if each != FILE]
            for old in jobs[:-_KEPT]:
                del self._results[old]
        self._results[name] = self._results.pop(name)  # the last one that was asked for stays longest
        try:
            return await asyncio.shield(self._results[name])
        except BaseException:
            if name in self._results and self._results[name].done():
                del self._results[name]
            raise

    async def _read(self, name: str) -> Result:
        if name == FILE and self.path is not None:
            return await asyncio.to_thread(Result.read, self.path)
        return await self._session.result(name, self.cases.get(name, ""))

    def forget(self, name: str) -> None:
        self._results.pop(name, None)


async def load_of(opened: Opened, query: Any) -> tuple[Result, Any]:
    """The result and the load case that a request names."""
    result = await opened.result(query["of"])
    loads = list(result.loads.values())
    index = int(query.get("load", 0))
    if not 0 <= index < len(loads):
        raise IndexError(f"there is no load {index}")
    return result, loads[index]
