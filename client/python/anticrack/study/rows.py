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
from ..text import counted, harmless, shown, without_numpy

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
    key, _, values = (part.strip() for part in text.partition("="))
    if not key or not values:
        raise CaseError(f"{shown(text)} varies nothing; write KEY=FIRST:LAST:COUNT, as load.opening.f=1:2:11, or "
                        "KEY=VALUE,VALUE")
    try:
        found = _values(values)
        toml_of(found)
    except CaseError as error:
        raise CaseError(f"{shown(text)}: {error}") from None
    return key, found


def _values(text: str) -> list[Any]:
    if ":" in text and not re.search("[?\"'{[]", text):  # which are of expressions, texts, tables and lists
        first, last, count, *more = *text.split(":"), ""
        if len(more) != 1:
            raise CaseError("it is not FIRST:LAST:COUNT, as 0:90:19; a text needs quotes")
        ends = [value_of(word) for word in (first, last)]
        for name, word, end in zip(("FIRST", "LAST"), (first, last), ends):
            if not is_number(end) or not math.isfinite(end):
                raise CaseError(f"{name} is {shown(word)}; write a finite number with a point, as 0.5")
        if not re.fullmatch("0*[0-9]{1,6}", count) or not 2 <= int(count) <= MOST_ROWS:
            raise CaseError(f"COUNT is {shown(count)}; write a whole number from 2 to {MOST_ROWS}, as in 0:90:19")
        return [float(f"{value:.15g}") for value in np.linspace(ends[0], ends[1], int(count))]
    try:
        return list(tomllib.loads(f"values = [{text}]")["values"])
    except tomllib.TOMLDecodeError:
        if ";" in text:
            raise CaseError("values are parted by commas, as in 1, 2; a text with a semicolon needs quotes") from None
        if not all(words := [word.strip() for word in text.split(",")]):
            raise CaseError("a value is missing beside a comma") from None
        return list(map(value_of, words))


def value_of(word: str, comma: bool = False) -> Any:
    """A word as a value of TOML, or else as text. comma: numbers may have a decimal comma."""
    word = word.strip()
    if comma and re.fullmatch(r"[-+]?[0-9]+,[0-9]+([eE][-+]?[0-9]+)?", word):
        word = word.replace(",", ".")
    try:
        return float(word) if re.fullmatch(r"[-+.0-9][-+.0-9eE]*", word) else tomllib.loads(f"v = {word}")["v"]
    except (ValueError, KeyError):  # TOML's error is a ValueError
        if word[:1] in ("[", "{", '"', "'"):
            raise CaseError(f"{shown(word)} is no value; close its quotes and brackets, as in TOML") from None
        return word


def csv_rows(path: str) -> list[Values]:
    """The rows of comma-separated text, or of text with semicolons, whose first line names the keys."""
    try:
        return rows_in(pathlib.Path(path).read_text("utf-8-sig"), path)
    except (OSError, UnicodeDecodeError) as error:
        why = getattr(error, "strerror", "it is no text in UTF-8; save it as CSV in UTF-8")
        raise CaseError(f"{path}: cannot be read: {why}") from None


def rows_in(text: str, path: str) -> list[Values]:
    """The rows of such a text; `path` is what errors call it. Numbers between semicolons may have decimal commas."""
    mark = next((mark for mark in ";\t" if mark in text.partition("\n")[0]), ",")
    reader = csv.reader(io.StringIO(text), delimiter=mark, skipinitialspace=True, strict=True)
    try:
        lines = [(reader.line_num, line) for line in reader if line]
    except csv.Error as error:
        raise CaseError(f"{path}: line {reader.line_num}: {harmless(error)}; close its quotes") from None
    keys = [key.strip() for key in lines[0][1]] if lines else []
    wrong = ("it is empty" if not keys else "a key has no name" if not all(keys) else "no row follows the keys"
             if len(lines) < 2 else next((f"{shown(key)} stands twice" for key in keys if keys.count(key) > 1), ""))
    if wrong:
        raise CaseError(f"{path}: {wrong}; write a line of keys, each once, and then a line of values for each row")
    _check(len(lines) - 1)
    rows = []
    for number, line in lines[1:]:
        found = [word for word in line if word.strip()]
        if not len(found) == len(line) == len(keys):
            raise CaseError(f"{path}: line {number} has {counted(len(found), 'value')} for {len(keys)} keys: "
                            "write one for each, a list in quotes, and decimal commas between semicolons")
        try:
            rows.append({key: tidy(value_of(word, mark != ",")) for key, word in zip(keys, line)})
            overrides_of(rows[-1])
        except CaseError as error:
            raise CaseError(f"{path}: line {number}: {error}") from None
    return rows


def product(rows: Sequence[Values], more: Sequence[Values]) -> list[Values]:
    """Every row with every one of the others."""
    _check(len(rows) * len(more))
    for key in rows[0].keys() & more[0].keys():
        raise CaseError(f"{key} is varied twice; leave one out")
    return [{**row, **other} for row in rows for other in more]
