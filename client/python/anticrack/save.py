# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the result file that client/RESULT.md describes."""
from __future__ import annotations

import io
import os
from collections.abc import Iterable
from dataclasses import asdict, fields
from typing import Any

import h5py
import numpy as np

from . import entries, output
from .names import Parts
from .result import FORMAT, KKT, Interface, Load, Result, Sweep, Units
from .v1 import job_pb2, mesh_pb2, solve_pb2

_TEXT = h5py.string_dtype()
_HISTORY = {"iteration": "i4", "contact_count": "i4", "criterion": "f8", "energy": "f8",
            **{f"kkt_{name}": "f8" for name in KKT}}

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
    dimension = "" if array.dtype.kind == "i" else _DIMENSIONS.get(name.rpartition("/")[2], "")  # "" of indices
    group[name].attrs["units"] = units.of(dimension)


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
    """Writes values as attributes, lists of texts as datasets, lists of messages as groups of columns."""
    for name, place in entries.entries_of(message.DESCRIPTOR).items():
        group.attrs[name] = _typed(place[1], entries.value_of(message, *place))
    for field in entries.lists_of(message.DESCRIPTOR):
        items = getattr(message, field.name)
        if field.message_type is None:
            _put(group, field.name, list(items))
            continue
        columns = group.create_group(field.name)
        for name, place in entries.entries_of(field.message_type).items():
            values = [_typed(place[1], entries.value_of(item, *place)) for item in items]
            kind = type(_typed(place[1], entries.none_of(place[1])))
            _put(columns, name, values if kind is str else np.array(values, kind))


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


def _put_parts(group: Any, descriptor: Any, parts: Iterable[Any]) -> None:
    """Writes objects with the values of a message as columns."""
    for name, (_, field) in entries.entries_of(descriptor).items():
        column = [_typed(field, getattr(part, name)) for part in parts]
        kind = type(_typed(field, entries.none_of(field)))
        _put(group, name, column if kind is str else np.array(column, kind))


def _put_load(group: Any, load: Load, interfaces: Parts[Interface]) -> None:
    _put_record(group, load)
    _put_parts(group.create_group("inclusions"), solve_pb2.InclusionAnswer.DESCRIPTOR, load.inclusions.values())
    _put_parts(group.create_group("probes"), solve_pb2.ProbeAnswer.DESCRIPTOR, load.probe_points)
    _put_parts(group.create_group("boundary"), solve_pb2.BoundaryAnswer.DESCRIPTOR, load.boundary)
    _put_parts(group.create_group("tips"), solve_pb2.Tip.DESCRIPTOR, load.tips)
    growth = group.create_group("growth")
    for name, (_, item) in entries.entries_of(solve_pb2.GrowthRow.DESCRIPTOR).items():
        values = load.growth.get(name, np.empty(0))
        text = isinstance(entries.none_of(item), str)
        _put(growth, name, list(values) if text else values.astype(type(_typed(item, entries.none_of(item)))))
    contact = group.create_group("contact_intervals")
    _put(contact, "interface", [interfaces[place].name for place, _, _ in load.contact_intervals])
    for i, name in enumerate(("begin", "end"), 1):
        _put(contact, name, np.array([part[i] for part in load.contact_intervals], float))
    group.create_group("traces")
    for i, trace in enumerate(load.traces):
        _put_record(group.create_group(f"traces/{i}"), trace)
    history = {name: load.history.get(name, np.empty(0, dtype)) for name, dtype in _HISTORY.items()}
    for name, values in {**{f"history/{name}": values for name, values in history.items()},
                         **{f"stages/{name}": values for name, values in load.stages.items()}}.items():
        _put(group, name, values)
    for i, part in enumerate(load.fields):
        _put_record(group.create_group(f"fields/{i}"), part, "subdomain")


def _put_sweep(group: Any, sweep: Sweep) -> None:
    _put_record(group, sweep, "loads", "inclusions")
    for name in ("loads", "inclusions"):
        group.attrs[name] = np.array(getattr(sweep, name), dtype=_TEXT)
    group.attrs.update({"description": "row k of every dataset belongs to load case k", "source": ""})
    _put_message(group, sweep.answer)
    _put(group, "kept", np.array(sweep.kept, dtype=np.int32))
