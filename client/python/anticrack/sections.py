# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of a case, read by key; errors name the file, the key and the cure."""
from __future__ import annotations

import math
import numbers
import re
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from google.protobuf.duration_pb2 import Duration

from .arrays import as_float, is_number, plain
from .errors import CaseError
from .text import short, suggestion, without_numpy

_SECONDS = {"": 1, "s": 1, "ms": 1e-3, "min": 60, "h": 3600, "d": 86400}


def shown(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if callable(value):
        return f"the Python function {getattr(value, '__name__', value)}"
    return short(f"'{value}'" if isinstance(value, str) else str(without_numpy(value)))


def name_or_index(table: Any, index: int) -> str:
    """What tells an entry of a list in a key, as the command has it."""
    name = table.get("name") if isinstance(table, Mapping) else None
    return name if isinstance(name, str) and 0 < len(name) <= 64 else str(index)


class Section:
    """`path`: of the table, "geometry.crack.0". Refuses keys that are not known."""

    def __init__(self, table: Any, path: str, known: Iterable[str], source: str) -> None:
        self.path, self.source = path, source
        if not isinstance(table, Mapping):
            raise self.error("", f"{shown(table)} is not a table; write [{path}]")
        self.table = table
        known = list(known)
        for key in table:
            if key not in known:
                raise self.error(str(key), "unknown key; " + suggestion(str(key), known))

    def __contains__(self, key: str) -> bool:
        return key in self.table

    def get(self, key: str) -> Any:
        """None where the key is absent. Arrays of numpy are lists."""
        return self.plain(self.table.get(key), key)

    def plain(self, value: Any, key: str) -> Any:
        """Of an array lists, of a single number that one."""
        return plain(value, lambda problem: self.error(key, problem))

    def error(self, key: str, problem: str) -> CaseError:
        place = ".".join(part for part in (self.path, key) if part)
        return CaseError(": ".join(part for part in (self.source, place, problem) if part))

    def refuse(self, keys: Iterable[str], why: str) -> None:
        for key in keys:
            if key in self:
                raise self.error(key, why)

    def need(self, key: str, cure: str) -> Any:
        if key not in self:
            raise self.error(key, f"missing; {cure}")
        return self.get(key)

    def number_of(self, value: Any, key: str, cure: str = "write one, such as 0.5") -> float:
        value = self.plain(value, key)
        if not is_number(value) or not math.isfinite(as_float(value)):
            text = value if isinstance(value, str) else ""
            unit = re.fullmatch(r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?) *[A-Za-z].*", text)
            if unit:
                raise self.error(key, f"{shown(value)} is a number with a unit; write {unit[1]}: the units of all "
                                      "numbers are those of [units]")
            raise self.error(key, f"{shown(value)} is not a finite number; {cure}")
        return float(value)

    def numbers_of(self, value: Any, key: str, count: int, what: str, cure: str) -> list[float]:
        value = self.plain(value, key)
        if not isinstance(value, (list, tuple)) or len(value) != count:
            raise self.error(key, f"{shown(value)} is not {what}; {cure}")
        return [self.number_of(number, key, cure) for number in value]

    def point_of(self, value: Any, key: str) -> dict[str, float]:
        x, y = self.numbers_of(value, key, 2, "a point", "write [x, y]")
        return {"x": x, "y": y}

    def list_of(self, value: Any, key: str, what: str, cure: str) -> list[Any]:
        value = self.plain(value, key)
        if not isinstance(value, (list, tuple)):
            raise self.error(key, f"{shown(value)} is not {what}; {cure}")
        return list(value)

    def points_of(self, value: Any, key: str) -> list[dict[str, float]]:
        points = self.list_of(value, key, "a list of points", "write [[x, y], [x, y], ...]")
        return [self.point_of(point, f"{key}.{i}") for i, point in enumerate(points)]

    def part_of(self, value: Any, key: str) -> dict[str, dict[str, float]]:
        """[from, to]"""
        value = self.plain(value, key)
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            raise self.error(key, f"{shown(value)} is not a part; write [from, to] with points from and to")
        return {"from": self.point_of(value[0], f"{key}.0"), "to": self.point_of(value[1], f"{key}.1")}

    def number(self, key: str) -> float | None:
        return self.number_of(self.get(key), key) if key in self else None

    def positive(self, key: str, has_default: bool = True) -> float | None:
        value = self.number(key)
        if value is not None and value <= 0:
            raise self.error(key, f"{shown(value)} is not above 0; write a number above 0"
                                  + (", or leave the key out for its default" if has_default else ""))
        return value

    def count(self, key: str) -> int | None:
        value = self.get(key)
        if key in self and (not is_number(value) or not isinstance(value, numbers.Integral)
                            or not 1 <= int(value) < 2**31):
            raise self.error(key, f"{shown(value)} is not a count; write a whole number from 1 to {2**31 - 1}")
        return None if value is None else int(value)

    def boolean(self, key: str) -> bool | None:
        value = self.get(key)
        if key in self and not isinstance(value, (bool, np.bool_)):
            raise self.error(key, f"{shown(value)} is neither true nor false")
        return None if value is None else bool(value)

    def text(self, key: str) -> str | None:
        value = self.get(key)
        if key in self and not isinstance(value, str):
            cure = "write it in quotes" if self.source else "give a str"
            raise self.error(key, f"{shown(value)} is not text; {cure}")
        return None if value is None else str(value)

    def expression(self, key: str) -> str:
        """In x and y; of a number its shortest text."""
        value = self.get(key)
        if value is None or isinstance(value, str):
            return value or ""
        number = self.number_of(value, key, "write a number, or an expression in x and y in quotes")
        return repr(number).removesuffix(".0")

    def choice(self, key: str, choices: list[str]) -> int | None:
        """Its index."""
        value = self.text(key)
        if value is not None and value not in choices:
            raise self.error(key, f"{shown(value)} is not possible; {suggestion(value, choices)}")
        return None if value is None else choices.index(value)

    def time(self, key: str) -> Duration | None:
        value = self.get(key)
        if key not in self:
            return None
        found = re.fullmatch(r"([0-9.eE+-]+) *([a-z]*)", str(value))
        try:
            milliseconds = round(float(found[1]) * _SECONDS[found[2]] * 1000) if found else 0
        except (ValueError, KeyError, OverflowError):
            milliseconds = 0
        if isinstance(value, bool) or not 1 <= milliseconds <= 366 * 86_400_000:
            raise self.error(key, f"{shown(value)} is not a time above 0; write seconds, or \"90s\", \"10min\", "
                                  "\"2h\", \"1d\"")
        return Duration(seconds=milliseconds // 1000, nanos=milliseconds % 1000 * 1_000_000)

    def section(self, key: str, known: Iterable[str]) -> Section | None:
        return Section(self.table[key], self._below(key), known, self.source) if key in self else None

    def sections(self, key: str, known: Iterable[str]) -> list[Section]:
        """Of [[path.key]]."""
        if key not in self:
            return []
        cure = f"write [[{self._below(key)}]] above each of them"
        tables = self.list_of(self.get(key), key, "a list of tables", cure)
        return [Section(table, f"{self._below(key)}.{name_or_index(table, i)}", known, self.source)
                for i, table in enumerate(tables)]

    def entries(self, key: str, cure: str) -> list[tuple[str, Any]]:
        """Of {name = value, ...}."""
        value = self.table.get(key, {})
        if not isinstance(value, Mapping):
            raise self.error(key, f"{shown(value)} is not a table; {cure}")
        return [(str(name), entry) for name, entry in value.items()]

    def numbers(self, key: str, cure: str) -> dict[str, float]:
        return {name: self.number_of(entry, f"{key}.{name}", cure) for name, entry in self.entries(key, cure)}

    def _below(self, key: str) -> str:
        return f"{self.path}.{key}" if self.path else key
