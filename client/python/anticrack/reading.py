# SPDX-License-Identifier: GPL-3.0-or-later
"""Sends a case to the server, which reads it, and holds what the server makes of it. Arrays and meshes in memory stay
here: the server gets a name for each, as if it were a file."""
from __future__ import annotations

import contextlib
import hashlib
import json
import math
import numbers
import os
import tomllib
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .arrays import Array, array_of, is_number, plain
from .case import Case, tables_of
from .errors import CaseError, ServerError, package
from .text import harmless, shown
from .v1 import case_pb2, job_pb2, mesh_pb2

Places = Mapping[str, case_pb2.CasePlace]


class Question:
    """The request to read a case. memory: the contents that the names stand for."""

    def __init__(self, case: Case, loads_optional: bool, overrides: Sequence[str] = ()) -> None:
        """overrides: as of --set. Raises CaseError for values that a case cannot have, such as functions."""
        self.case = case
        self.memory: dict[str, Any] = {}
        self.request = case_pb2.ReadCaseRequest(source=harmless(case.source), loads_optional=loads_optional, overrides=[
            text.encode("utf-8", "replace") for text in overrides])
        if case.text and repr(case.tables) == repr(tomllib.loads(case.text)):  # repr also compares types
            self.request.toml = case.text.encode("utf-8", "replace")  # errors then name lines
        else:
            try:
                tables = self._sent(tables_of(case.tables), "")
            except RecursionError:
                raise self._error("", "a list or table in it holds itself; write what it holds") from None
            self.request.json = json.dumps(tables, separators=(",", ":")).encode()

    def _error(self, key: str, problem: str) -> CaseError:
        return CaseError(": ".join(part for part in (self.case.source, key, problem) if part))

    def _sent(self, given: Any, key: str) -> Any:
        """The value as JSON, with names in place of arrays and meshes."""
        value = plain(given, lambda problem: self._error(key, problem))
        if isinstance(value, Mapping):
            if key.startswith("load.") and key.endswith(".f") and "values" in value:
                value = self._array(value, key)
            return {str(name): self._sent(entry, f"{key}.{name}" if key else str(name))
                    for name, entry in value.items() if entry is not None}
        if isinstance(value, (list, tuple)):
            return [self._sent(entry, f"{key}.{_name_or_index(entry, i)}") for i, entry in enumerate(value)]
        if isinstance(value, bytes) and key == "mesh.file":
            return self._kept(value, value)
        if isinstance(value, (bool, np.bool_)):
            return bool(value)
        if isinstance(value, (str, os.PathLike)):
            return os.fspath(value)
        if is_number(value):
            return self._number(value, key)
        if not callable(value):
            raise self._error(key, f"{shown(value)} ({type(value).__name__}) is not possible; give a number, a text, "
                                   "true, false, or a list or table of them")
        raise self._error(key, f"{shown(value)} is not possible; write an expression in x and y in quotes" + (
            ', or give its values on the nodes of client.mesh_arrays(client.mesh(case))["nodes"], as Load(name, '
            'values, per="node")' if key.endswith(".f") else ""))

    def _number(self, value: Any, key: str) -> int | float:
        whole = isinstance(value, numbers.Integral) and abs(int(value)) < 2**63
        with contextlib.suppress(OverflowError):
            if math.isfinite(float(value)):
                return int(value) if whole else float(value)
        raise self._error(key, f"{shown(value)} is not a finite number; write one, such as 0.5")

    def _array(self, table: Mapping[str, Any], key: str) -> dict[str, Any]:
        for name in table.keys() - {"values", "per"}:
            raise self._error(f"{key}.{name}", "unknown key; known are values, per")
        of = {"node": "nodes", "triangle": "triangles"}.get(str(table.get("per")), "values")
        values = array_of(table["values"], (of,), lambda problem: self._error(f"{key}.values", problem), in_order=True)
        return {"file": self._kept(values, values.tobytes()), "dataset": "values", "per": table.get("per")}

    def _kept(self, value: Any, content: bytes) -> str:
        """Keeps a content and returns its name, which depends on it: cases that differ in values differ in text."""
        name = f"in memory, sha256 {hashlib.sha256(content).hexdigest()[:16]}"
        self.memory[name] = value
        return name


class ReadCase:
    """The server's reading of a case: `mesh` and `spec` are the requests to send, `text` is the case in TOML."""

    def __init__(self, question: Question, answer: case_pb2.ReadCaseResponse) -> None:
        self._case, self._memory, self._answer = question.case, question.memory, answer
        self.mesh, self.spec, self.places = answer.mesh, answer.spec, answer.places
        self.text = answer.toml or question.case.text

    @property
    def mesh_file(self) -> str:
        """mesh.file as the case names it; empty if it has none"""
        return str(self._answer.mesh_file)

    def msh(self) -> bytes | None:
        """The content of mesh.file, or None."""
        name = self.mesh_file
        if not name or name in self._memory:
            return self._memory.get(name)
        path = self._case.folder / name
        try:
            return path.read_bytes()
        except OSError as error:
            raise CaseError(f"{self._where('upload')}: {path}: {error.strerror}; name a .msh file") from None

    def arrays(self) -> list[tuple[int, Array]]:
        """Pairs of a load case's index and the values of its f, for each f given as an array."""
        return [(array.load_case, self._memory[array.file] if array.file in self._memory else self._values(array))
                for array in self._answer.arrays]

    def _where(self, field: str) -> str:
        return _written(_nearest(self.places, field)) or field

    def _values(self, array: case_pb2.CaseArray) -> Array:
        field = f"load_cases[{array.load_case}].force"
        h5py, path, name = package("h5py"), self._case.folder / array.file, array.dataset

        def error(key: str, problem: object) -> CaseError:
            return CaseError(f"{self._where(field)}.{key}: {problem}")
        try:
            with h5py.File(path) as file:
                found = file[name]
                if not isinstance(found, h5py.Dataset):
                    kind = "group" if isinstance(found, h5py.Group) else "named type"
                    raise error("dataset", f"{name} is a {kind}, not a dataset"
                                + (f"; it has {', '.join(found)}" if kind == "group" and len(found) else ""))
                values = found[()]
        except (OSError, KeyError) as problem:
            raise error("file", f"{path}: {problem}") from None
        of = "triangles" if self.spec.load_cases[array.load_case].force.array.per_triangle else "nodes"
        return array_of(values, (of,), lambda problem: error("dataset", problem))

    def leave_out_accuracy(self) -> None:
        """Drops the accuracy, which a sweep does not have, and the coarse mesh on which only an accuracy begins."""
        if self.spec.HasField("accuracy"):
            warnings.warn("[accuracy] is not used: a sweep has one mesh, of mesh.size; bounds=True tells how far each "
                          "row is from the membrane. For closer bounds take a smaller mesh.size, or make few rows "
                          "loads of a case")
            self.spec.ClearField("accuracy")
            if "options.preset" not in self.places:
                self.mesh.options.preset = mesh_pb2.MESH_PRESET_GRADED

    @property
    def notes(self) -> list[str]:
        """The server's warnings."""
        return [harmless(note) for note in self._answer.notes]

    def warn(self) -> None:
        """Issues the server's warnings. Call it when nothing was refused, as an error should be told alone."""
        for note in self.notes:
            warnings.warn(note)


def _name_or_index(table: Any, index: int) -> str:
    """Names an entry of a list in a key as the server does: by its name, else by its index."""
    name = table.get("name") if isinstance(table, Mapping) else None
    return name if isinstance(name, str) and 0 < len(name) <= 64 else str(index)


def _written(place: case_pb2.CasePlace | None) -> str:
    return ": ".join(part for part in (place.where, place.key) if part) if place else ""


def _nearest(places: Places, field: str) -> case_pb2.CasePlace | None:
    """The place in the case where a field, or the nearest one around it, was written."""
    field = field.removeprefix("spec.").removeprefix("mesh.")
    while field and field not in places:
        field = field[:max(field.rfind("."), field.rfind("["), 0)]
    return places[field] if field else None


def places_of(spec: job_pb2.JobSpec) -> Places:
    """The places that can be known from a job without its case."""
    return {f"load_cases[{i}]{field}": case_pb2.CasePlace(key=f"load.{load.name}{key}")
            for i, load in enumerate(spec.load_cases) for field, key in (("", ""), (".force", ".f"))}


def in_terms_of(places: Places, error: ServerError) -> ServerError:
    """Returns the error with the case's keys in its message."""
    if not error.fields:
        return error
    fields: list[tuple[str, str]] = []
    told_of = told = ""
    for field, what in error.fields:
        place = _nearest(places, field)
        if place and what == told and told_of.startswith(place.key + "."):
            continue  # two keys cause it together, and the case lacks this one
        told_of, told = place.key if place else "", what
        fields.append((_written(place) or field, what))
    return ServerError(error.code, error.message, error.reason, tuple(fields), error.metadata, error.retry_delay)
