# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the named arrays that ReadMesh and ReadResult stream as one byte string."""
from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from .arrays import Array
from .errors import ServerError
from .v1 import mesh_pb2

_TYPES = {mesh_pb2.ArrayLayout.TYPE_FLOAT64: "<f8", mesh_pb2.ArrayLayout.TYPE_INT32: "<i4",
          mesh_pb2.ArrayLayout.TYPE_UINT8: "u1"}


def _damaged(what: str) -> ServerError:
    return ServerError("DATA_LOSS", "the data arrived damaged: " + what)


class BlockReceiver:
    """Collects the layout and the chunks of a block, from as many streams as it takes."""

    def __init__(self) -> None:
        self._layout: mesh_pb2.BlockLayout | None = None
        self._arrays: list[Any] = []
        self._bytes = bytearray()

    @property
    def offset(self) -> int:
        """The byte at which the next stream has to begin."""
        return len(self._bytes)

    @property
    def complete(self) -> bool:
        return (self._layout is not None and self.offset == self._layout.size
                and len(self._arrays) >= self._layout.array_count)

    def accept(self, message: Any) -> None:
        """Takes a ReadMeshResponse or ReadResultResponse."""
        if message.HasField("layout"):
            layout = message.layout
            if self._layout is None:
                self._layout = layout
            if (layout.size, layout.sha256) != (self._layout.size, self._layout.sha256):
                raise _damaged("the block changed while it was read; fetch it again")
            if layout.first_array == len(self._arrays):
                self._arrays.extend(layout.arrays)
        elif message.HasField("chunk"):
            if self._layout is None or message.chunk.offset != self.offset:
                raise _damaged(f"a chunk at {message.chunk.offset} where {self.offset} was due")
            self._bytes += message.chunk.data

    def finish(self) -> dict[str, Array]:
        """Returns the arrays by name; all of them share one memory."""
        if self._layout is None or hashlib.sha256(self._bytes).hexdigest() != self._layout.sha256:
            raise _damaged("its sha256 is wrong")
        out = {}
        for array in self._arrays:
            shape = tuple(array.shape)
            out[array.name] = np.frombuffer(self._bytes, _TYPES[array.type], int(np.prod(shape)),
                                            array.offset).reshape(shape)
        return out
