# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns a mesh of your own into a .msh file that the server reads."""
from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, cast

from .arrays import Array, array_of
from .errors import CaseError
from .text import counted

_TYPES = {"line": (1, 1, 2), "triangle": (2, 2, 3)}  # type of the cell in MSH, dimension, nodes


@dataclass(repr=False)
class Msh:
    """A mesh. points (n, 2) or (n, 3); cells: "triangle" (m, 3) and "line" (l, 2), indices of points from 0.

    groups: for each kind of cell a name for every cell, or "". A triangle's name is its subdomain, a line's says what
    the line is: "dirichlet", "neumann:NAME", "crack:NAME", "delaminated:NAME" and so on (see the guide on .msh files).
    Forces on the boundary have the names of its lines."""
    points: Array
    cells: Mapping[str, Array]
    groups: Mapping[str, Any] = field(default_factory=dict)

    def __repr__(self) -> str:
        cells = ", ".join(counted(len(array), kind) for kind, array in self.cells.items())
        return f"<Msh of {counted(len(self.points), 'point')}, {cells}>"

    @classmethod
    def of_meshio(cls, mesh: Any) -> Msh:
        """Takes the lines, triangles and physical groups of a meshio.Mesh."""
        names = {(int(tag), int(dimension)): name for name, (tag, dimension) in mesh.field_data.items()}
        tags = mesh.cell_data_dict.get("gmsh:physical", {})
        cells = {kind: array for kind, array in mesh.cells_dict.items() if kind in _TYPES}
        groups = {kind: [names.get((int(tag), _TYPES[kind][1]), "") for tag in tags[kind]]
                  for kind in cells if kind in tags}
        return cls(mesh.points, cells, groups)

    def to_bytes(self) -> bytes:
        """The file in MSH 2.2 ascii; every number reads back exactly."""
        points = _points(self.points)
        tags: dict[tuple[int, str], int] = {}
        elements: list[str] = []
        for kind, array in self.cells.items():
            if kind not in _TYPES:
                raise CaseError(f"cells of kind '{kind}' are no part of a membrane; known are line, triangle")
            code, dimension, corners = _TYPES[kind]
            if hasattr(array, "__len__") and not len(array):
                continue
            nodes = array_of(array, ("n", corners), lambda problem: CaseError(f"cells '{kind}': {problem}"), whole=True)
            if not 0 <= int(nodes.min()) <= int(nodes.max()) < len(points):
                raise CaseError(f"cells '{kind}' name points that are not there; they count from 0")
            names = _names(list(self.groups.get(kind, [""] * len(nodes))), kind)
            if len(names) != len(nodes):
                raise CaseError(f"groups of '{kind}' are {len(names)} names for {len(nodes)} cells")
            rows = cast(list[list[int]], nodes.tolist())
            for name, cell in zip(names, rows):
                tag = tags.setdefault((dimension, name), len(tags) + 1) if name else 0
                entity = tag or 10**6 + dimension
                elements.append(f"{len(elements) + 1} {code} 2 {tag} {entity} " + " ".join(str(i + 1) for i in cell))
        groups = [f'{dimension} {tag} "{name}"' for (dimension, name), tag in tags.items()]
        nodes_of = [f"{i} {x!r} {y!r} 0" for i, (x, y, *_) in enumerate(points.tolist(), 1)]
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
        for what, entries in (("PhysicalNames", groups), ("Nodes", nodes_of), ("Elements", elements)):
            if entries or what != "PhysicalNames":
                lines += [f"${what}", str(len(entries)), *entries, f"$End{what}"]
        return "\n".join([*lines, ""]).encode()


def _points(values: Any) -> Array:
    """Checks points (n, 2) or (n, 3), which must all have the same z."""
    def fail(problem: str) -> CaseError:
        return CaseError(f"points: {problem}")
    points = array_of(values, ("n", "2 or 3"), fail)
    if points.shape[1] not in (2, 3):
        raise fail(f"an array of shape {points.shape} is not (n, 2) or (n, 3)")
    low, high = points.min(axis=0), points.max(axis=0)
    if points.shape[1] == 3 and high[2] - low[2] > 1e-9 * (high - low).max():
        raise fail(f"z goes from {low[2]:g} to {high[2]:g}; a sheet is flat, so give points (n, 2)")
    return points


def _names(values: Any, kind: str) -> list[str]:
    """Checks the names of one kind of cells; "" is a cell without a group."""
    for i, name in enumerate(values):
        if not isinstance(name, str):
            raise CaseError(f"groups of '{kind}': {name!r} at [{i}] is not text; write a name, or '' for none")
    return [str(name) for name in values]
