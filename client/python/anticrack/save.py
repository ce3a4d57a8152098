# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the result file that client/RESULT.md describes."""
from __future__ import annotations

import io
import os
from collections.abc import Iterable, Mapping
from dataclasses import asdict, fields
from typing import Any

import h5py
import numpy as np

from . import entries, output
from .names import Parts
from .result import FORMAT, KKT, Interface, Load, Result, Sweep, Units
from .v1 import job_pb2, mesh_pb2, solve_pb2

_TEXT = h5py.string_dtype()
_HISTORY = np.dtype([("iteration", "i4"), ("criterion", "f8"), ("energy", "f8"), ("contact_count", "i4"),
                     *((f"kkt_{name}", "f8") for name in KKT)])

_MEANINGS = [*entries.meanings(job_pb2.Solver.DESCRIPTOR, "solver"),
             *entries.meanings(mesh_pb2.Mesh.DESCRIPTOR, "mesh"),
             *entries.meanings(solve_pb2.LoadCaseAnswer.DESCRIPTOR, "loads"),
             *entries.meanings(solve_pb2.Stage.DESCRIPTOR, "stages"),
             *entries.meanings(solve_pb2.SweepAnswer.DESCRIPTOR, "sweep")]

# Dimensions of datasets, as Units.of takes them; a name means the same in every group.
_DIMENSIONS = {
    **dict.fromkeys(["nodes", "s", "x", "y", "u_minus", "u_plus", "jump", "u", "displacement", "displacement_lower",
                     "displacement_upper", "displacement_mesh", "membranes"], "L"),
    **{name: unit for where, name, unit, _ in _MEANINGS if where != "loads"}, "pressure": "F/L",
    "flux": "F/L", "force": "F", "indicator": "F L", "balanced_flux": "F", "tension": "F/L"}


def save(result: Result, path: str | os.PathLike[str]) -> bool:
    """Writes the file whole or not at all. Returns whether the old file is kept as PATH~, as it is no result of the
    same case."""
    target, stream = output.target_of(path)
    image = io.BytesIO()  # HDF5 crashes if the disk is full while it closes a file
    with h5py.File(image, "w") as file:
        _put_result(file, result)
    former = not stream and os.path.isfile(target) and not _holds_the_same(target, result)
    output.write(path, image.getbuffer(), keep=former)
    return former


def _holds_the_same(path: str | os.PathLike[str], result: Result) -> bool:
    """Whether the existing file is a result of the same job or case, so that replacing it loses nothing. A case does
    not suffice for a sweep, as it lacks the coefficients."""
    try:
        with h5py.File(path) as file:
            job, case = file.attrs["job"], file.attrs["case"]
            return bool(job == result.job or case and case == result.case and result.sweep is None
                        and "sweep" not in file)
    except (OSError, KeyError):
        return False


def _put(group: Any, name: str, values: Any) -> None:
    texts = isinstance(values, list) or values.dtype.kind == "U"
    array = np.array(values, dtype=_TEXT if texts else None)
    group.create_dataset(name, data=array, **({"compression": "gzip", "shuffle": True} if array.size > 1000 else {}))
    units = Units(**group.file["units"].attrs)

    def unit(of: str, dtype: Any) -> str:
        return units.of("" if dtype.kind == "i" else _DIMENSIONS.get(of, ""))  # "" of indices
    group[name].attrs["units"] = unit(name, array.dtype) if array.dtype.names is None else [
        unit(of, array.dtype[of]) for of in array.dtype.names]


def _put_record(group: Any, record: Any, *but: str) -> None:
    """Writes a record's texts and numbers as attributes, its arrays and lists of texts as datasets, without the fields
    `but` and a sweep's arrays without columns."""
    for field in fields(record):
        value = getattr(record, field.name)
        if field.name in but or isinstance(value, bool):
            continue
        if isinstance(value, (str, int, float)):
            group.attrs[field.name] = np.int32(value) if isinstance(value, int) else value
        elif isinstance(value, np.ndarray) and (value.size or value.ndim == 1 or not isinstance(record, Sweep)) or (
                str(field.type) == "list[str]"):
            _put(group, field.name, value)


def _put_message(group: Any, message: Any) -> None:
    """Writes values as attributes, lists as datasets, of texts or of records."""
    for name, place in entries.entries_of(message.DESCRIPTOR).items():
        group.attrs[name] = _typed(place[1], entries.value_of(message, *place))
    for field in entries.lists_of(message.DESCRIPTOR):
        items = getattr(message, field.name)
        if field.message_type is None:
            _put(group, field.name, list(items))
        else:
            _put_records(group, field.name, _records_of(field.message_type), map(entries.values_of, items))


def _records_of(*descriptors: Any) -> np.dtype[Any]:
    """The type of records with a member for each value of the messages."""
    fields = {name: field for of in descriptors for name, (_, field) in entries.entries_of(of).items()}
    kinds = {name: np.array(_typed(field, entries.none_of(field))).dtype for name, field in fields.items()}
    return np.dtype([(name, _TEXT if kind.kind == "U" else kind) for name, kind in kinds.items()])


def _put_records(group: Any, name: str, records: np.dtype[Any], rows: Iterable[Mapping[str, Any]]) -> None:
    _put(group, name, np.array([tuple(row[of] for of in records.names or ()) for row in rows], records))


def _rows(columns: Mapping[str, Any]) -> list[dict[str, Any]]:
    return [dict(zip(columns, row)) for row in zip(*columns.values())]


def _typed(field: Any, value: Any) -> Any:
    if isinstance(value, int):
        return np.int64(value) if field.cpp_type == field.CPPTYPE_UINT64 else np.int32(value)
    return value


def _put_result(file: Any, result: Result) -> None:
    from . import __version__
    file.attrs.update({"format": FORMAT, "client_version": __version__})
    file.create_group("units").attrs.update(asdict(result.units))
    _put_record(file, result)
    _put(file, "meanings", [(*row[:2], result.units.of(row[2]), row[3]) for row in _MEANINGS])
    _put_message(file.create_group("solver"), result.solver)
    _put_message(file.create_group("mesh"), result.mesh.info)
    _put_record(file["mesh"], result.mesh)
    file.create_group("interfaces")
    for i, interface in enumerate(result.interfaces):
        _put_record(file.create_group(f"interfaces/{i}"), interface, "name")
    file.create_group("loads")
    for i, load in enumerate(result.loads.values()):
        group = file.create_group(f"loads/{load.name}")
        group.attrs["index"] = np.int32(i)
        _put_load(group, load, result.interfaces)
    if result.sweep is not None:
        _put_sweep(file.create_group("sweep"), result.sweep)


def _put_load(group: Any, load: Load, interfaces: Parts[Interface]) -> None:
    _put_record(group, load)
    lists = {"inclusions": map(vars, load.inclusions.values()), "probes": map(vars, load.probe_points),
             "boundary": map(vars, load.boundary), "tips": map(vars, load.tips), "growth": _rows(load.growth),
             "contact_intervals": [{"interface": interfaces[place].name, "begin": begin, "end": end}
                                   for place, begin, end in load.contact_intervals]}
    for field in entries.lists_of(solve_pb2.LoadCaseAnswer.DESCRIPTOR):
        if field.message_type is not None:
            _put_records(group, field.name, _records_of(field.message_type), lists[field.name])
    group.create_group("traces")
    for i, trace in enumerate(load.traces):
        _put_record(group.create_group(f"traces/{i}"), trace)
    _put_records(group, "history", _HISTORY, _rows(load.history))
    if load.stages:
        _put_records(group, "stages", _records_of(solve_pb2.Stage.DESCRIPTOR, solve_pb2.StageAnswer.DESCRIPTOR),
                     _rows(load.stages))
    for i, part in enumerate(load.fields):
        _put_record(group.create_group(f"fields/{i}"), part, "subdomain")


def _put_sweep(group: Any, sweep: Sweep) -> None:
    _put_record(group, sweep, "loads", "inclusions")
    for name in ("loads", "inclusions"):
        group.attrs[name] = np.array(getattr(sweep, name), dtype=_TEXT)
    group.attrs.update({"description": "row k of every dataset belongs to load case k", "source": ""})
    _put_message(group, sweep.answer)
    _put(group, "kept", np.array(sweep.kept, dtype=np.int32))
