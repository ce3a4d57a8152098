# SPDX-License-Identifier: GPL-3.0-or-later
"""Many combinations of a case's loads in one job."""
from __future__ import annotations

import operator
import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from .errors import CaseError
from .sections import shown
from .v1 import solve_pb2


def sweep_of(job: solve_pb2.Job, coefficients: Any, nodal_forces: Any, traces: Sequence[int],
             bounds: bool) -> bytes | None:
    """Makes a job a sweep; the matrix to upload, none where neither is given.

    coefficients (rows, loads) in the order of the case's loads, or a DataFrame with their names as columns;
    nodal_forces (rows, nodes): f on the nodes of the mesh. traces: rows whose traces are kept. bounds: of every row."""
    if coefficients is None and nodal_forces is None:
        if traces or bounds:
            raise CaseError("traces and bounds are of a sweep; give coefficients or nodal_forces"
                            + (" (load cases have bounds anyway)" if bounds else ""))
        return None
    if coefficients is not None and nodal_forces is not None:
        raise CaseError("give coefficients or nodal_forces, not both")
    for key, values in (("coefficients", coefficients), ("nodal_forces", nodal_forces)):
        if isinstance(values, (str, os.PathLike)):
            raise CaseError(f"{key}: {shown(values)} is no array; give an array (rows, "
                            + ("nodes)" if key == "nodal_forces" else
                               "loads) or a DataFrame, of a CSV file pandas.read_csv(...)"))
    names = [load.name for load in job.load_cases]
    if coefficients is not None and hasattr(coefficients, "columns"):
        if sorted(map(str, coefficients.columns)) != sorted(names):
            raise CaseError(f"columns {list(coefficients.columns)} are not the loads {names}")
        coefficients = coefficients[names].to_numpy()
    try:
        matrix = np.asarray(coefficients if coefficients is not None else nodal_forces)
    except ValueError:
        raise CaseError("coefficients or nodal_forces: the rows are not all of one length") from None
    columns = len(names) if coefficients is not None else None
    if matrix.ndim != 2 or not matrix.size or (columns is not None and matrix.shape[1] != columns):
        wanted = "nodes" if columns is None else columns
        raise CaseError(f"an array of shape {matrix.shape} is not (rows, {wanted})")
    if matrix.dtype.kind not in "fiu" or not np.isfinite(matrix).all():
        raise CaseError("coefficients and forces are finite numbers")
    del job.outputs[:]
    job.sweep.bounds = bounds
    try:
        job.sweep.traces.extend(sorted({operator.index(row) for row in traces}))
    except TypeError:
        raise CaseError(f"traces: {shown(traces)} is not a list of rows; write [0, 2]") from None
    if nodal_forces is not None:
        del job.load_cases[:]
    return matrix.astype("<f8").tobytes()
