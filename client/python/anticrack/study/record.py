# SPDX-License-Identifier: GPL-3.0-or-later
"""A study's rows with their answers, and its file. The file is replaced as a whole, so that it never has half a row."""
from __future__ import annotations

import io
import json
import os
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

from .. import output
from ..arrays import Array, is_number
from ..entries import status_name, values_of
from ..errors import Error, UnknownName, package
from ..names import unknown
from ..result import Units
from ..text import between, counted, harmless, html_table, short, short_length, shown
from ..v1 import solve_pb2
from .rows import tidy

FORMAT = "anticrack-study/1"
SOLVED = ("succeeded", "not_converged")  # rows that have numbers
ENDED = (*SOLVED, "failed", "refused")  # rows that are not solved again
_TEXTS = ("identity", "status", "error", "job")
_NAN = float("nan")


@dataclass
class Row:
    """A row: the values of its keys, and what has come of it. status: "" (not solved yet), "succeeded", "not_converged"
    (error says which accuracy was not reached, or why), "failed", "cancelled" or "refused" (error says why). answers:
    numbers of each load case by name: energy, contact_length, "A of NAME", their bounds as energy_lower and "A_lower of
    NAME", and G, the largest of all tips, with its G_spread and place G_x, G_y; NaN where it has none."""
    values: dict[str, Any]
    identity: str = ""
    status: str = ""
    error: str = ""
    job: str = ""
    answers: dict[str, dict[str, float]] = field(default_factory=dict)

    def take(self, job: solve_pb2.Job) -> None:
        """Takes what has come of a job that has ended."""
        status = job.status
        self.job = job.name
        self.status = status_name(status.state, solve_pb2.JobStatus.State.DESCRIPTOR)
        self.error = status.not_reached or status.error.message
        for answer in status.answers:
            if answer.status not in (answer.STATUS_CONVERGED, answer.STATUS_NOT_CONVERGED):
                self.error = self.error or answer.error.message
                continue
            self.error = self.error or answer.reason
            told = values_of(answer)
            numbers = {name: told[name] for name in ("energy", "energy_lower", "energy_upper", "contact_length")}
            for part in map(values_of, answer.inclusions):
                numbers.update({f"{name} of {part['name']}": part[name] for name in ("A", "A_lower", "A_upper")})
            tips = [tip for tip in map(values_of, answer.tips) if np.isfinite(tip["G"])]
            if tips:
                worst = max(tips, key=lambda tip: float(tip["G"]))
                numbers.update({"G": worst["G"], "G_spread": worst["G_spread"], "G_x": worst["x"], "G_y": worst["y"]})
            self.answers[answer.name] = numbers


@dataclass(repr=False)
class Study:
    """A case solved for many values of its keys. rows: in the order of the grid. case: the case as TOML, without the
    values of the rows, if it came as text. study["energy"], study["A of NAME"] and so on are arrays (rows), and so is
    study["geometry.inclusion.fibre.angle"] of a key with numbers."""
    rows: list[Row]
    title: str = ""
    case: str = ""
    units: Units = field(default_factory=Units)

    @property
    def keys(self) -> list[str]:
        return list(self.rows[0].values) if self.rows else []

    @property
    def loads(self) -> list[str]:
        return list(dict.fromkeys(name for row in self.rows for name in row.answers))

    @property
    def columns(self) -> list[str]:
        """The names of the numbers that rows have."""
        return list(dict.fromkeys(name for row in self.rows for of in row.answers.values() for name in of))

    @property
    def inclusions(self) -> list[str]:
        return [name.removeprefix("A of ") for name in self.columns if name.startswith("A of ")]

    @property
    def converged(self) -> Array:
        """(rows) whether the row has all answers, and the accuracy if one was asked for"""
        return np.array([row.status == "succeeded" for row in self.rows])

    def column(self, name: str, load: str | None = None) -> Array:
        """(rows) a number of each row's answer to a load, by default the first; NaN where there is none."""
        loads = self.loads
        load = load if load is not None else (loads or [""])[0]
        if loads and load not in loads:
            raise unknown("load", load, loads)
        if name not in self.columns:
            raise unknown("number or key with numbers", name, [*self.columns, *self.keys])
        return np.array([row.answers.get(load, {}).get(name, _NAN) for row in self.rows])

    def __getitem__(self, name: str) -> Array:
        if name in self.keys:
            values = [row.values[name] for row in self.rows]
            if not _numbers(values):
                raise UnknownName(f"{harmless(name)} has no numbers; study.rows have its values")
            return np.array(values, float)
        return self.column(name)

    def varying(self) -> list[str]:
        """The keys with numbers that are not the same in all rows."""
        return [key for key in self.keys if _numbers([row.values[key] for row in self.rows])
                and any(row.values[key] != self.rows[0].values[key] for row in self.rows)]

    def table(self) -> tuple[list[str], list[list[str]]]:
        """The head and the lines of a table, one for each row and load, with A as its middle and the distance of its
        bounds."""
        loads, names = self.loads, self.inclusions[:4]
        with_g = "G" in self.columns
        head = ["row", *map(_end, self.keys), *["load"] * (len(loads) > 1), "status",
                *(f"A of {name}{self.units.label('L')}" for name in names), "energy" + self.units.label("F L"),
                "contact length" + self.units.label("L"), *["largest G" + self.units.label("F")] * with_g]
        lines = []
        for index, row in enumerate(self.rows):
            for load in list(row.answers) or [""]:
                of = row.answers.get(load, {})
                told = [_interval(of, "A", f" of {name}") for name in names] + [
                    _interval(of, "energy", ""), short_length(of["contact_length"]) if of else "-"]
                lines.append([str(index), *(shown(row.values[key]) for key in self.keys), *[load] * (len(loads) > 1),
                              row.status.replace("_", " ") + (f": {short(row.error)}" if row.error else ""), *told,
                              *[f"{of['G']:.5g}" if np.isfinite(of.get("G", _NAN)) else "-"] * with_g])
        return head, lines

    def _title(self) -> str:
        told = [f"{sum(row.status == status for row in self.rows)} {word}" for status, word in (
            ("succeeded", "converged"), ("not_converged", "not converged"), ("failed", "failed"),
            ("refused", "refused"), ("cancelled", "cancelled"), ("", "not solved yet"))
            if any(row.status == status for row in self.rows)]
        return f"{harmless(self.title or 'study')}: {counted(len(self.rows), 'row')}, {', '.join(told)}"

    def text(self, most: int = 50) -> str:
        """The table as text; of many rows it shows the first."""
        head, lines = self.table()
        cells = [[harmless(cell) for cell in line] for line in [head, *lines[:most]]]
        widths = [max(map(len, column)) for column in zip(*cells)]
        texts = ["  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() for line in cells]
        more = [f"and {len(lines) - most} more"] if len(lines) > most else []
        return "\n".join([self._title(), *texts, *more])

    def __repr__(self) -> str:
        return self.text(10)

    def _repr_html_(self) -> str:
        """The HTML that a notebook shows."""
        return html_table(self._title(), *self.table())

    def lines(self) -> list[dict[str, Any]]:
        """A line for each row and load: the row's index, its values by key, how it ended, its numbers."""
        numbers: dict[str, Any] = dict.fromkeys(self.columns, _NAN)
        return [{"row": index, **row.values, "load case": load, "status": row.status, "error": row.error,
                 "job": row.job, **numbers, **(row.answers.get(load) or {})}
                for index, row in enumerate(self.rows) for load in list(row.answers) or [""]]

    def frame(self) -> Any:
        """The lines as a pandas.DataFrame; needs pandas."""
        return package("pandas").DataFrame(self.lines())

    def save(self, path: str | os.PathLike[str], keep: bool = False) -> None:
        """Writes the file as a whole or not at all. keep: an existing file becomes PATH~."""
        h5py, image = package("h5py"), io.BytesIO()
        with h5py.File(image, "w") as file:
            file.attrs.update({"format": FORMAT, "title": self.title, "case": self.case,
                               "solved": np.int64(sum(row.status != "" for row in self.rows))})
            file.create_group("units").attrs.update(asdict(self.units))
            text = h5py.string_dtype()

            def put(name: str, values: list[Any]) -> None:
                file.create_dataset(name, data=np.array(values, dtype=float if _numbers(values) else text))
            put("keys", self.keys)
            for i, key in enumerate(self.keys):
                values = [row.values[key] for row in self.rows]
                put(f"values/{i}", values if _numbers(values) else [json.dumps(value) for value in values])
            for name in _TEXTS:
                put(name, [getattr(row, name) for row in self.rows])
            columns = self.columns
            put("columns", columns)
            put("loads/names", self.loads)
            for i, load in enumerate(self.loads):
                for name in columns:
                    put(f"loads/{i}/{name}", [row.answers.get(load, {}).get(name, _NAN) for row in self.rows])
                    file[f"loads/{i}/{name}"].attrs["units"] = self.units.of_column(name)
        output.write(path, image.getbuffer(), keep=keep)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Study:
        """Reads a file of FORMAT."""
        try:
            with package("h5py").File(path) as file:
                found = str(file.attrs.get("format"))
                if found != FORMAT:
                    raise Error(f"{os.fspath(path)}: is no study of anticrack, which has the format {FORMAT}; a result "
                                "is read by anticrack.read")
                return cls(_rows_in(file), str(file.attrs["title"]), str(file.attrs["case"]),
                           Units(**file["units"].attrs))
        except FileNotFoundError:
            raise Error(f"there is no file {os.fspath(path)}; name a study, as anticrack study -o writes it") from None
        except (OSError, KeyError, ValueError) as error:
            raise Error(f"{os.fspath(path)}: cannot be read as a study: {error}") from None


def is_study(path: str | os.PathLike[str]) -> bool:
    """Whether there is a file that says it is a study."""
    try:
        with package("h5py").File(path) as file:
            return str(file.attrs.get("format")).startswith(FORMAT.partition("/")[0] + "/")
    except OSError:
        return False


def _numbers(values: list[Any]) -> bool:
    return bool(values) and all(map(is_number, values))


def _end(key: str) -> str:
    """The last two parts of a key, without indices between."""
    return ".".join(key.split(".")[-2:])


def _interval(of: dict[str, float], name: str, behind: str) -> str:
    value, lower, upper = (of.get(name + part + behind, _NAN) for part in ("", "_lower", "_upper"))
    return between(value, lower, upper) if np.isfinite(value) else "-"


def _rows_in(file: Any) -> list[Row]:
    def texts(name: str) -> list[str]:
        return [str(text) for text in file[name].asstr()[()]] if file[name].size else []
    columns = []
    for i in range(len(keys := texts("keys"))):
        values = file[f"values/{i}"]
        columns.append([tidy(value) for value in values[()].tolist()] if values.dtype.kind == "f" else
                       [json.loads(text) for text in texts(f"values/{i}")])
    rows = [Row(dict(zip(keys, values)), *told) for *values, told in zip(*columns, zip(*map(texts, _TEXTS)))]
    names = texts("columns")
    for i, load in enumerate(texts("loads/names")):
        table = np.array([file[f"loads/{i}/{name}"][()] for name in names])
        for row, numbers in zip(rows, table.T.tolist()):
            if not np.isnan(numbers).all():
                row.answers[load] = dict(zip(names, numbers))
    return rows
