# SPDX-License-Identifier: GPL-3.0-or-later
"""The results that the page looks at: that of a file, and those of jobs; and meshes of stages."""
from __future__ import annotations

import asyncio
import pathlib
from collections.abc import Coroutine
from typing import Any, TypeVar

from ..arrays import Array
from ..errors import Error
from ..result import Load, Result
from ..session import Session
from ..study.record import Study, is_study

FILE = "file"  # the name of the result of the file; others are "jobs/ID"
_KEPT = 2  # results, and meshes, in memory; a million triangles take some 200 MB
T = TypeVar("T")


class Opened:
    def __init__(self, session: Session) -> None:
        self._session = session
        self._kept: dict[str, asyncio.Task[Any]] = {}
        self.path: pathlib.Path | None = None
        self.study: Study | None = None
        # Of jobs that were submitted here: texts of their cases, and coefficients, which the server does not give back.
        self.cases, self.coefficients = dict[str, str](), dict[str, Array | None]()

    async def open_file(self, path: pathlib.Path) -> None:
        """Reads a file of a result or a study. Raises Error if it is neither."""
        self.path = path
        if is_study(path):
            self.study = Study.read(path)
        else:
            await self.result(FILE)

    async def _once(self, name: str, read: Coroutine[Any, Any, T]) -> T:
        """What was read under this name, or what is read now; the last few are kept, and the file's."""
        if name in self._kept:
            read.close()
        else:
            self._kept[name] = asyncio.create_task(read)
        task = self._kept[name] = self._kept.pop(name)  # the last one that was asked for stays longest
        kind = name.partition("/")[0]
        for old in [each for each in self._kept if each != FILE and each.partition("/")[0] == kind][:-_KEPT]:
            del self._kept[old]
        try:
            return await asyncio.shield(task)  # type: ignore[no-any-return]
        except BaseException:
            if task.done():
                self.forget(name)
            raise

    async def result(self, name: str) -> Result:
        if name == FILE and self.study is not None:
            raise Error("this is a study; choose the job of a row")
        return await self._once(name, self._read(name))

    async def mesh(self, name: str) -> dict[str, Array]:
        """The arrays of a mesh of the server, "meshes/ID"."""
        return await self._once(name, self._session.mesh_arrays(name))

    async def _read(self, name: str) -> Result:
        if name == FILE and self.path is not None:
            return await asyncio.to_thread(Result.read, self.path)
        result = await self._session.result(name, self.cases.get(name, ""))
        if result.sweep is not None:
            result.sweep.coefficients = self.coefficients.get(name)
        return result

    def again(self, name: str, other: str) -> None:
        self.cases[other], self.coefficients[other] = self.cases.get(name, ""), self.coefficients.get(name)

    def forget(self, name: str) -> None:
        self._kept.pop(name, None)


async def load_of(opened: Opened, query: Any) -> tuple[Result, Load]:
    """The result and the load case that a request names."""
    result = await opened.result(query["of"])
    loads = list(result.loads.values())
    index = int(query.get("load", 0))
    if not 0 <= index < len(loads):
        raise IndexError(f"there is no load {index}")
    return result, loads[index]
