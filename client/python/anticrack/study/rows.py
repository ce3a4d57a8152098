# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of a study: grids of values of keys, and rows of CSV files. A value becomes an override of the case, which
the server applies as it does for --set."""
from __future__ import annotations

import csv
import io
import itertools
import json
import math
import os
import pathlib
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ..arrays import is_number, plain
from ..errors import CaseError
from ..text import harmless, shown, without_numpy

MOST_ROWS = 100_000
Values = dict[str, Any]  # of one row, by key


def toml_of(value: Any) -> str:
    """Writes a value as in TOML; whole numbers without a point, as keys that count take no others."""
    if isinstance(value, (bool, np.bool_)):
        return str(bool(value)).lower()
    if is_number(value):
        if not math.isfinite(value):
            raise CaseError(f"{value} is not a finite number; write one, such as 0.5")
        return str(int(value)) if value == int(value) and abs(value) < 2**53 else repr(float(value))
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml_of, value))}]"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {toml_of(entry)}" for key, entry in value.items()) + " }"
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    raise CaseError(f"{shown(value)} ({type(value).__name__}) is no value of a key; give a number, a text, true or "
                    "false, or a list or table of them")


def tidy(value: Any) -> Any:
    """The same value; a whole number as int, as it is shown, and as a file that has floats gives it back."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def overrides_of(values: Values) -> list[str]:
    return [f"{key}={toml_of(value)}" for key, value in values.items()]


def grid(vary: Mapping[str, Any]) -> list[Values]:
    """All combinations of the values of each key, the last key fastest."""
    columns = []
    for key, values in vary.items():
        listed = plain(values, lambda problem, key=key: CaseError(f"{key}: {problem}"))  # type: ignore[misc]
        columns.append([without_numpy(value) for value in listed] if isinstance(listed, (list, tuple)) else [listed])
        if not columns[-1]:
            raise CaseError(f"{key}: there are no values; give at least one")
    _check(math.prod(map(len, columns)))
    return [dict(zip(vary, map(tidy, row))) for row in itertools.product(*columns)]


def rows_of(vary: Any) -> list[Values]:
    """The rows of a mapping from keys to their values, a grid; or as they are, of a DataFrame or a list of mappings."""
    if hasattr(vary, "columns"):
        vary = vary.to_dict("records")
    if isinstance(vary, Mapping):
        return grid(vary)
    if isinstance(vary, (str, bytes)) or not isinstance(vary, Iterable):
        raise CaseError(f"{shown(vary)} says no values of keys; write {{'load.opening.f': [1, 2]}}")
    rows = [dict(row) for row in vary]
    _check(len(rows))
    for index, row in enumerate(rows):
        if list(row) != list(rows[0]):
            raise CaseError(f"row {index} has the keys {shown(list(row))}, row 0 {shown(list(rows[0]))}; give all rows "
                            "the same keys in the same order")
    return [{str(key): tidy(without_numpy(plain(value, CaseError))) for key, value in row.items()} for row in rows]


def _check(count: int) -> None:
    if not 0 < count <= MOST_ROWS:
        raise CaseError(f"{count} rows are not possible; a study has 1 to {MOST_ROWS}")


def varied(text: str) -> tuple[str, list[Any]]:
    """The key and the values of KEY=FIRST:LAST:COUNT, evenly spaced, or of KEY=VALUE,... with values as in TOML."""
    key, equals, values = text.partition("=")
    if not equals or not key.strip() or not values.strip():
        raise CaseError(f"{shown(text)} varies nothing; write KEY=FIRST:LAST:COUNT, as load.opening.f=1:2:11, or "
                        "KEY=VALUE,VALUE")
    spaced = re.fullmatch(r"\s*([^:\[\"']+):([^:]+):\s*([0-9]+)\s*", values)
    if spaced:
        try:
            first, last, count = float(spaced[1]), float(spaced[2]), int(spaced[3])
        except ValueError:
            raise CaseError(f"{shown(text)}: {shown(values)} is not FIRST:LAST:COUNT, as 0:90:19") from None
        if not 2 <= count <= MOST_ROWS or not math.isfinite(first) or not math.isfinite(last):
            raise CaseError(f"{shown(text)}: write finite numbers and a count from 2 to {MOST_ROWS}, as 0:90:19")
        return key.strip(), [float(f"{value:.15g}") for value in np.linspace(first, last, count)]
    try:
        return key.strip(), list(tomllib.loads(f"values = [{values}]")["values"])
    except tomllib.TOMLDecodeError:
        return key.strip(), [value_of(word) for word in values.split(",")]


def value_of(word: str, comma: bool = False) -> Any:
    """A word as a value of TOML, or else as text. comma: numbers may have a decimal comma."""
    word = word.strip()
    if comma and re.fullmatch(r"[-+]?[0-9]+,[0-9]+([eE][-+]?[0-9]+)?", word):
        word = word.replace(",", ".")
    try:
        return float(word) if re.fullmatch(r"[-+.0-9][-+.0-9eE]*", word) else tomllib.loads(f"v = {word}")["v"]
    except (ValueError, KeyError):  # TOML's error is a ValueError
        return word


def csv_rows(path: str) -> list[Values]:
    """The rows of comma-separated text, or of text with semicolons, whose first line names the keys."""
    try:
        return rows_in(pathlib.Path(path).read_text("utf-8-sig"), path)
    except OSError as error:
        raise CaseError(f"{path}: cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise CaseError(f"{path}: this is no text with commas: {harmless(error)}") from None


def rows_in(text: str, path: str) -> list[Values]:
    """The rows of such a text; `path` is what errors call it. Numbers between semicolons may have decimal commas."""
    mark = next((mark for mark in ";\t" if mark in text.partition("\n")[0]), ",")
    lines = [line for line in csv.reader(io.StringIO(text), delimiter=mark, skipinitialspace=True) if line]
    keys = [key.strip() for key in lines[0]] if lines else []
    if not all(keys) or len(set(keys)) < len(keys) or len(lines) < 2:
        raise CaseError(f"{path}: write a line of keys, each once, and then a line of values for each row")
    _check(len(lines) - 1)
    for number, line in enumerate(lines[1:], 2):
        if len(line) != len(keys) or not all(word.strip() for word in line):
            raise CaseError(f"{path}: line {number} has {len([word for word in line if word.strip()])} values for "
                            f"{len(keys)} keys; write one for each, a list in quotes")
    return [{key: tidy(value_of(word, mark != ",")) for key, word in zip(keys, line)} for line in lines[1:]]


def product(rows: Sequence[Values], more: Sequence[Values]) -> list[Values]:
    """Every row with every one of the others."""
    _check(len(rows) * len(more))
    for key in rows[0].keys() & more[0].keys():
        raise CaseError(f"{key} is varied twice; leave one out")
    return [{**row, **other} for row in rows for other in more]
