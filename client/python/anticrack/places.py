# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of a request that the server refuses, as keys of the case."""
from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from .errors import ServerError
from .sections import name_or_index

# In order; the indices of lists are already ".0".
_KEYS = [(r"^(job|mesh)\.", ""), (r"^load_cases\b", "load"), (r"^(load\.\d+)\.force\b.*", r"\1.f"),
         (r"^geometry\.interfaces\b", "geometry.interface"), (r"^geometry\.inclusions\b", "geometry.inclusion"),
         (r"^geometry\.cracks\b", "geometry.crack"), (r"^geometry\.regions\b", "geometry.region"),
         (r"^geometry\.holes\b", "geometry.hole"), (r"^geometry\.sides\b", "geometry.boundary"),
         (r"^geometry\.neumann_sides\b", "geometry.neumann"),
         (r"\.polyline\b(\.points)?", ".points"), (r"\.spline\.points\b", ".spline"), (r"\.part\.(from|to)\b", r".\1"),
         (r"\.delaminated_parts\.parts\b", ".delaminated"), (r"^solver\.(uzawa|active_set)\b", "solver"),
         (r"^options\.(curve|surface)_groups\b", r"mesh.groups.\1"),
         (r"^options\.inclusion_motions\b", "mesh.inclusions"), (r"^options\b", "mesh"),
         (r"^accuracy\.displacement\b", "accuracy.A"), (r"^(upload|header|chunk)\b.*", "mesh.file"),
         (r"^(priority|queue_timeout|run_timeout)\b", r"job.\1")]


def key_of(field: str, tables: Mapping[str, Any]) -> str:
    """"job.load_cases[0].force.expression" is "load.opening.f" where the first load of the case is called so."""
    key = re.sub(r"\[([^\]]*)\]", r".\1", field)
    for pattern, replacement in _KEYS:
        key = re.sub(pattern, replacement, key)
    if found := re.match(r"((geometry\.)?(\w+))\.(\d+)(?!\w)", key):
        entries, index = (tables.get("geometry", {}) if found[2] else tables).get(found[3]), int(found[4])
        if isinstance(entries, list) and index < len(entries):
            key = f"{found[1]}.{name_or_index(entries[index], index)}{key[found.end():]}"
    return key


def in_terms_of(source: str, tables: Mapping[str, Any], error: ServerError) -> ServerError:
    """With the keys of the case in its message: `source` is its file, if any."""
    if not error.fields:
        return error
    fields = tuple((f"{source}: " * bool(source) + key_of(field, tables), what) for field, what in error.fields)
    return ServerError(error.code, str(error), error.reason, fields, error.metadata, error.retry_delay)
