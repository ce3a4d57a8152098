# SPDX-License-Identifier: GPL-3.0-or-later
"""Many combinations of a case's loads in one job."""
from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, cast

from .arrays import Array, array_of, is_array
from .errors import CaseError
from .text import shown
from .v1 import job_pb2


def sweep_of(spec: job_pb2.JobSpec, coefficients: Any, nodal_forces: Any, traces: Sequence[int],
             bounds: bool, tips: bool) -> bytes | None:
    """Makes a job a sweep; returns the matrix to upload, or None if neither coefficients nor nodal_forces are given.

    coefficients (rows, loads) in the order of the case's loads, or a DataFrame or a dict with their names as columns;
    nodal_forces (rows, nodes): f on the nodes of the mesh. traces: rows whose traces are kept. bounds: bound every
    row. tips: numbers of every tip in each row."""
    if coefficients is None and nodal_forces is None:
        if traces or bounds or tips:
            raise CaseError("traces, bounds and tips are of a sweep; give coefficients or nodal_forces"
                            + (f" (load cases have {'bounds' if bounds else 'tips'} anyway)" if bounds or tips else ""))
        return None
    if coefficients is not None and nodal_forces is not None:
        raise CaseError("give coefficients or nodal_forces, not both")
    for key, values in (("coefficients", coefficients), ("nodal_forces", nodal_forces)):
        if isinstance(values, (str, os.PathLike)):
            raise CaseError(f"{key}: {shown(values)} is no array; give an array (rows, "
                            + ("nodes)" if key == "nodal_forces" else
                               "loads) or a DataFrame, of a CSV file pandas.read_csv(...)"))
    if coefficients is not None:
        matrix = coefficients_of(coefficients, [load.name for load in spec.load_cases])
    else:
        matrix = array_of(nodal_forces, ("rows", "nodes"), lambda problem: CaseError(f"nodal_forces: {problem}"),
                          in_order=True)
        del spec.load_cases[:]
    del spec.outputs[:]
    spec.sweep.bounds, spec.sweep.tips = bounds, tips
    spec.sweep.traces.extend(_kept(traces, len(matrix)))
    return matrix.tobytes()


def coefficients_of(values: Any, loads: Sequence[str]) -> Array:
    """The coefficients as an array (rows, loads); columns of a DataFrame or a dict are found by name, in any order."""
    def fail(problem: str) -> CaseError:
        return CaseError(f"coefficients: {problem}")
    if isinstance(values, Mapping) or hasattr(values, "columns"):
        columns = [str(name) for name in getattr(values, "columns", values)]
        if isinstance(values, Mapping):
            values = list(zip(*values.values(), strict=True))
        if sorted(columns) != sorted(loads):
            raise fail(f"columns {columns} are not the loads {list(loads)}")
        return array_of(values, ("rows", len(loads)), fail)[:, [columns.index(name) for name in loads]].copy()
    return array_of(values, ("rows", len(loads)), fail)


def _kept(traces: Any, rows: int) -> list[int]:
    """The rows whose traces are kept, ascending and each once."""
    def fail(problem: str) -> CaseError:
        return CaseError(f"traces: {problem}; write rows, as [0, 2]")
    if not is_array(traces) and (isinstance(traces, (str, bytes)) or not isinstance(traces, Iterable)):
        raise fail(f"{shown(traces)} is not a list of rows")
    values = traces if is_array(traces) else list(traces)
    if hasattr(values, "__len__") and not len(values):
        return []
    kept = sorted(set(cast(list[int], array_of(values, ("rows",), fail, whole=True).tolist())))
    if kept and not 0 <= kept[0] <= kept[-1] < rows:
        raise fail(f"{kept[0] if kept[0] < 0 else kept[-1]} is no row; there are {rows}, counted from 0")
    return kept
