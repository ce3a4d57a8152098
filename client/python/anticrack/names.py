# SPDX-License-Identifier: GPL-3.0-or-later
"""Containers whose items are found by name; the error for an unknown name lists the known ones."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any, SupportsIndex, TypeVar, overload

from .errors import UnknownIndex, UnknownName
from .text import counted, lines, suggestion

T = TypeVar("T")


def unknown(what: str, name: object, known: Iterable[str]) -> UnknownName:
    return UnknownName(f"there is no {what} {name!r}; {suggestion(str(name), known)}")


def place(what: str, name: str, known: list[str]) -> int:
    """The index of a name in `known`; raises UnknownName."""
    if name not in known:
        raise unknown(what, name, known)
    return known.index(name)


class Named(dict[str, T]):
    """Items by name. what: the word for an item in errors, as "load"."""

    def __init__(self, what: str, items: Iterable[tuple[str, T]] = ()) -> None:
        super().__init__(items)
        self.what = what

    def __missing__(self, name: str) -> T:
        raise unknown(self.what, name, self)

    def __repr__(self) -> str:
        return lines(list(self.values()))


class Parts(list[T]):
    """Items in their order, found by index or by name."""

    def __init__(self, what: str, items: Iterable[T] = ()) -> None:
        super().__init__(items)
        self.what = what

    @overload
    def __getitem__(self, key: SupportsIndex | str) -> T: ...

    @overload
    def __getitem__(self, key: slice) -> list[T]: ...

    def __getitem__(self, key: Any) -> Any:
        try:
            return super().__getitem__(self.place(key) if isinstance(key, str) else key)
        except IndexError:
            raise UnknownIndex(f"there is no {self.what} {key}; there {'is' if len(self) == 1 else 'are'} "
                               f"{counted(len(self), self.what)}, counted from 0") from None

    def place(self, name: str) -> int:
        """The index of the item of this name."""
        return place(self.what, name, [str(getattr(item, "name")) for item in self])

    def __repr__(self) -> str:
        return lines(self)
