# SPDX-License-Identifier: GPL-3.0-or-later
"""Files for ParaView: a .vtu is VTK's XML around raw little-endian arrays, a .pvd lists the .vtu of a result. Written
here, as the VTK library is many times as large as this package."""
from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from . import output
from .arrays import Array
from .errors import Error
from .result import Load, Mesh, Result, chosen, fields_cure, joined
from .text import harmless

_LINE, _TRIANGLE = 3, 5  # VTK's numbers of cells, by their corners below
_HEAD = '<?xml version="1.0"?>\n<VTKFile type="{}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
_TYPES = {"float64": "Float64", "int32": "Int32", "int64": "Int64", "uint8": "UInt8"}
Data = Mapping[str, tuple[Array, str]]  # arrays with their units; "": none


def vtu(points: Array, corners: Array, point_data: Data, cell_data: Data) -> bytes:
    """The bytes of a file. points (n, 2) lie in the plane z = 0; corners (m, 3) of triangles or (m, 2) of lines are
    indices of points; data have an entry for each point or cell."""
    blocks: list[bytes] = []

    def element(name: str, values: Array, unit: str = "", components: int = 1) -> str:
        offset = sum(map(len, blocks))
        raw = values.astype(values.dtype.newbyteorder("<")).tobytes()
        blocks.extend([struct.pack("<Q", len(raw)), raw])
        kind = _TYPES[values.dtype.name]
        return (f'        <DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
                f'format="appended" offset="{offset}">\n' + (
                    '          <InformationKey name="UNITS_LABEL" location="vtkDataArray">'
                    f"{escape(unit)}</InformationKey>\n" if unit else "") + "        </DataArray>\n")

    def data_of(data: Data, count: int) -> str:
        assert all(len(values) == count for values, _ in data.values())
        return "".join(element(name, values, unit) for name, (values, unit) in data.items())

    width = corners.shape[1]
    shape = {2: _LINE, 3: _TRIANGLE}[width]
    parts = {"PointData": data_of(point_data, len(points)), "CellData": data_of(cell_data, len(corners)),
             "Points": element("Points", np.column_stack([points, np.zeros(len(points))]), components=3),
             "Cells": (element("connectivity", corners.astype(np.int64))
                       + element("offsets", width * np.arange(1, len(corners) + 1, dtype=np.int64))
                       + element("types", np.full(len(corners), shape, np.uint8)))}
    sections = "".join(f"      <{name}>\n{text}      </{name}>\n" for name, text in parts.items())
    head = (f'{_HEAD.format("UnstructuredGrid")}  <UnstructuredGrid>\n    <Piece NumberOfPoints="{len(points)}" '
            f'NumberOfCells="{len(corners)}">\n{sections}    </Piece>\n  </UnstructuredGrid>\n'
            '  <AppendedData encoding="raw">\n_')
    return b"".join([head.encode(), *blocks, b"\n  </AppendedData>\n</VTKFile>\n"])


def pvd(members: Sequence[tuple[str, str, int, int]]) -> bytes:
    """The bytes of a file that lists members (name for people, file, step, part); ParaView shows the step as time."""
    lines = [f'    <DataSet timestep="{step}" part="{part}" name={quoteattr(name)} file={quoteattr(file)}/>\n'
             for name, file, step, part in members]
    return f'{_HEAD.format("Collection")}  <Collection>\n{"".join(lines)}  </Collection>\n</VTKFile>\n'.encode()


def of_triangles(mesh: Mesh, values: Array, triangles: Array) -> Array:
    """The values of each triangle, which may have its corners in another order than the mesh has them; NaN for one
    that is not in the mesh."""
    near = np.isin(mesh.triangles, triangles).all(axis=1) if len(triangles) < len(values) else slice(None)
    whole, values = mesh.triangles[near], values[near]
    a, b, c = np.sort(np.concatenate([whole, triangles]), axis=1).astype(np.int64).T
    edge = np.unique(a * len(mesh.nodes) + b, return_inverse=True)[1]
    number = np.unique(edge * len(mesh.nodes) + c, return_inverse=True)[1]  # much faster than rows of three
    known: Array = np.full((len(number), *values.shape[1:]), np.nan)
    known[number[:len(values)]] = values
    found: Array = known[number[len(values):]]
    return found


def _unit(result: Result, dimension: str) -> str:
    return result.units.behind(dimension).strip()


def membrane(result: Result, load: Load) -> bytes:
    """The .vtu of the membrane. Subdomains share no points, which keeps both faces of cracks and slits. Points have u
    and node, cells tension, subdomain, T grad u as flux_x, flux_y and its size flux, energy_density and, where the
    load has it, error_indicator and the means of the balanced flux as balanced_flux_x, balanced_flux_y."""
    parts = list(load.fields)
    node, _, corners = joined(parts)
    subdomain = np.repeat(np.arange(len(parts), dtype=np.int32), [len(part.triangles) for part in parts])
    flux = np.concatenate([part.flux for part in parts])
    cells = {"tension": (result.mesh.tension[subdomain], _unit(result, "F/L")), "subdomain": (subdomain, ""),
             "flux_x": (flux[:, 0], _unit(result, "F/L")), "flux_y": (flux[:, 1], _unit(result, "F/L")),
             "flux": (np.hypot(*flux.T), _unit(result, "F/L")),
             "energy_density": (np.concatenate([part.energy_density for part in parts]), _unit(result, "F/L"))}
    if load.indicator is not None:
        cells["error_indicator"] = (of_triangles(result.mesh, load.indicator, node[corners]), _unit(result, "F L"))
    if load.balanced_flux is not None:
        means = of_triangles(result.mesh, result.mesh.mean_flux(load.balanced_flux), node[corners])
        for name, values in zip(("balanced_flux_x", "balanced_flux_y"), means.T):
            cells[name] = (values, _unit(result, "F/L"))
    points = {"u": (np.concatenate([part.u for part in parts]), _unit(result, "L")), "node": (node, "")}
    return vtu(result.mesh.nodes[node], corners, points, cells)


def interfaces(result: Result, load: Load) -> bytes:
    """The .vtu of the interfaces as lines. Points have u_minus, u_plus, jump, pressure, flux, force, s (arc length),
    kind and contact, cells the index of their interface, and that of their inclusion or -1."""
    lines, length = list(result.interfaces), _unit(result, "L")
    counts = [len(line.s) for line in lines]
    first = np.cumsum([0, *counts])
    starts = np.concatenate([start + np.arange(count - 1) for start, count in zip(first, counts)])
    points = {name: (np.concatenate([getattr(trace, name) for trace in load.traces]), unit) for name, unit in
              (("u_minus", length), ("u_plus", length), ("jump", length), ("pressure", _unit(result, "F/L")),
               ("flux", _unit(result, "F/L")), ("force", _unit(result, "F")))}
    points["s"] = np.concatenate([line.s for line in lines]), length
    points["kind"] = np.concatenate([line.kind for line in lines]), ""
    points["contact"] = np.concatenate([trace.contact for trace in load.traces]), ""
    cells = {"interface": (np.repeat(np.arange(len(lines), dtype=np.int32), [count - 1 for count in counts]), ""),
             "inclusion": (np.concatenate([line.edge_inclusion for line in lines]), "")}
    return vtu(np.concatenate([np.column_stack([line.x, line.y]) for line in lines]),
               np.column_stack([starts, starts + 1]), points, cells)


def probes(load: Load) -> bytes:
    """The .csv of the points of all probes."""
    names = ("s", "x", "y", "u_minus", "u_plus")
    rows = [[point.name, *(f"{getattr(point, name):.17g}" for name in names)] for point in load.probe_points]
    return "".join(",".join(row) + "\n" for row in [["name", *names], *rows]).encode()


def export(result: Result, source: str, folder: str, names: Sequence[str] = ()) -> output.Made:
    """Writes LOAD.vtu, the membrane, LOAD-interfaces.vtu and, of a case with probes, LOAD-probes.csv for every load
    with an answer, or those of these names, and result.pvd, which shows load i at time i. Makes the folder. A sweep has
    no fields, so only the interfaces of kept rows are written. source: the name of the result in messages."""
    made = output.Made(folder)
    answered = []
    loads = chosen(result, names)
    endings = ["-interfaces", "-probes"]
    for step, (load, stem) in enumerate(zip(loads, output.stems((load.name for load in loads), endings))):
        if load.traces or load.fields:
            answered.append((step, load, stem))
        else:
            made.notes.append(f'load "{harmless(load.name)}" has no answer ({load.status.replace("_", " ")}): nothing '
                              "to export")
        if load.traces and not load.fields and result.sweep is None:
            raise Error(f'{source}: load "{harmless(load.name)}": the result has no fields: u is known only along the '
                        f"interfaces; {fields_cure(result)}")
    if not answered:
        cure = "keep the traces of some rows, with --traces" if result.sweep is not None else "solve the case first"
        raise Error(f"{source}: no load has an answer to export; {cure}")
    output.make_folder(folder)
    members = []
    for step, load, stem in answered:
        if load.fields:
            made.add(stem, {"vtu": membrane(result, load)})
            members.append((load.name, f"{stem}.vtu", step, 0))
        if load.traces:
            made.add(f"{stem}-interfaces", {"vtu": interfaces(result, load)})
            members.append((f"{load.name}, interfaces", f"{stem}-interfaces.vtu", step, 1))
        if load.probe_points:
            made.add(f"{stem}-probes", {"csv": probes(load)})
    made.add("result", {"pvd": pvd(members)})
    return made
