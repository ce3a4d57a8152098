# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers with their arrays, which are the same whether read from a result file or from the server. Lengths, forces
and displacements are in the units of the case; an unknown number is NaN."""
from __future__ import annotations

import copy
import os
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, make_dataclass
from typing import Any, cast

import numpy as np

from . import entries
from .arrays import Array
from .entries import NAN
from .errors import Error, package
from .names import Named, Parts
from .text import counted, harmless, html_table, lines, listed, short_length, suggestion, with_bounds
from .v1 import job_pb2, mesh_pb2, solve_pb2

FORMAT = "anticrack-result/2"
Arrays = dict[str, Array]
KKT = ("equilibrium", "gap", "sign", "complementarity")
GLUE, CRACK, BONDED, DELAMINATED, FREE = range(1, 6)  # kinds of nodes and edges of an interface


@dataclass
class Units:
    """Names of units; an empty name means that the case gives none."""
    length: str = ""
    force: str = ""

    def of(self, dimension: str) -> str:
        """The unit of a dimension in F (force) and L (length): "F/L^2" gives "N/mm^2"; "-" if a unit has no name."""
        names = {"F": self.force, "L": self.length}
        if not dimension or any(letter in dimension and not name for letter, name in names.items()):
            return "-"
        return "".join(names.get(letter, letter) for letter in dimension)

    def of_column(self, name: str) -> str:
        """The unit of a column of sweeps and studies, such as energy_lower or "A of fibre"; "-" if it has none."""
        kind = "L" if name in ("G_x", "G_y") else re.split("[ _]", name, maxsplit=1)[0]
        return self.of({"energy": "F L", "contact": "L", "A": "L", "L": "L", "G": "F"}.get(kind, ""))

    def behind(self, dimension: str) -> str:
        """The unit to write after a number: " N/mm^2"; empty if there is none."""
        unit = self.of(dimension)
        return "" if unit == "-" else f" {unit}"

    def label(self, dimension: str) -> str:
        """The unit to write after the name of an axis: " [N/mm^2]"; empty if there is none."""
        unit = self.behind(dimension).strip()
        return f" [{unit}]" if unit else ""


@dataclass(repr=False)
class Mesh:
    """nodes (n, 2); triangles (m, 3): indices of nodes; boundary (b, 2): indices of nodes of the edges where u is
    prescribed; subdomain (m): index into subdomain_names (d) for each triangle; info: the server's Mesh (mesh.proto)
    without its definition."""
    nodes: Array
    triangles: Array
    subdomain: Array
    boundary: Array
    info: mesh_pb2.Mesh

    @property
    def subdomain_names(self) -> list[str]:
        return [part.name for part in self.info.subdomains]

    @property
    def tension(self) -> Array:
        """(d) tension of each subdomain; the mean if it is a law"""
        return np.array([part.tension for part in self.info.subdomains])

    @property
    def tension_law(self) -> list[str]:
        """(d) texts of the laws, "" where the tension is a number; an empty list if all are numbers"""
        laws = [part.tension_law for part in self.info.subdomains]
        texts = [f"along {law.along}, across {law.across}, angle {law.angle:g}" if law.across else law.along
                 for law in laws]
        return texts if any(texts) else []

    @property
    def inclusions(self) -> list[str]:
        return list(self.info.inclusions)

    def mean_flux(self, through_sides: Array) -> Array:
        """(m, 2) the mean over each triangle of a flux that is linear on it, of what leaves it through the sides
        opposite to its corners (m, 3), as of Load.balanced_flux."""
        corners = self.nodes[self.triangles]
        (ax, ay), (bx, by) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
        arms = (corners.mean(axis=1)[:, None] - corners) / (ax * by - ay * bx)[:, None, None]
        means: Array = np.einsum("ti,tid->td", through_sides, arms)
        return means

    def __repr__(self) -> str:
        return (f"mesh of {counted(len(self.nodes), 'node')} and {counted(len(self.triangles), 'triangle')}; "
                f"subdomains: {listed(self.subdomain_names)}; inclusions: {listed(self.inclusions) or 'none'}")


@dataclass(repr=False)
class Interface:
    """s (k): arc length; x, y (k): coordinates; kind (k) and edge_kind (k-1): 1 glue, 2 crack, 3 bonded inclusion,
    4 delaminated inclusion, 5 free crack; edge_inclusion (k-1): index into Mesh.inclusions, -1 for none."""
    name: str
    s: Array
    x: Array
    y: Array
    kind: Array
    edge_kind: Array
    edge_inclusion: Array
    units = Units()  # here and below: the units of the whole result

    def __repr__(self) -> str:
        length = self.s[-1] if len(self.s) else 0.0
        return f"{harmless(self.name)}: {counted(len(self.s), 'node')}, {length:.6g}{self.units.behind('L')} long"


@dataclass(repr=False)
class Trace:
    """Values on the nodes (k) of an interface: u on its two sides, jump = u_plus - u_minus, the contact pressure, the
    flux -T du/dn through glue and bonded parts, n from the minus to the plus side, the nodal forces of both, contact
    (1 where a crack is closed under pressure). Pressure and flux are singular at tips, forces are not."""
    u_minus: Array
    u_plus: Array
    jump: Array
    pressure: Array
    flux: Array
    force: Array
    contact: Array
    name, units = "", Units()  # name of the interface

    def __repr__(self) -> str:
        return (f"{harmless(self.name or 'interface')}: {counted(len(self.jump), 'node')}, "
                f"{int((self.contact != 0).sum())} in contact, "
                f"[u] up to {self.jump.max(initial=0):.4g}{self.units.behind('L')}")


@dataclass(repr=False)
class Field:
    """u (n) on the nodes of a subdomain. nodes (n): indices of Mesh.nodes, where a node inside a slit occurs twice;
    triangles (m, 3): indices into nodes; tension (m, 3): means of Txx, Txy, Tyy over each. mesh: of the result."""
    subdomain: str
    nodes: Array
    triangles: Array
    tension: Array
    u: Array
    units, mesh = Units(), cast(Mesh, None)

    @property
    def name(self) -> str:
        return self.subdomain

    def _corners(self) -> tuple[Array, Array, Array]:
        """(m, 2) each: differences of the second and third corner to the first in x, y and u."""
        x, y = self.mesh.nodes[self.nodes[self.triangles]].transpose(2, 0, 1)
        return tuple(values[:, 1:] - values[:, :1] for values in (x, y, self.u[self.triangles]))  # type: ignore

    @property
    def areas(self) -> Array:
        """(m) of the triangles"""
        x, y, _ = self._corners()
        return np.asarray(np.abs(x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]) / 2)

    @property
    def slopes(self) -> Array:
        """(m, 2) grad u in each triangle; 0 in one without area"""
        x, y, u = self._corners()
        twice = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            slopes = np.column_stack((u[:, 0] * y[:, 1] - u[:, 1] * y[:, 0],
                                      u[:, 1] * x[:, 0] - u[:, 0] * x[:, 1])) / twice[:, None]
        return np.asarray(np.nan_to_num(slopes, posinf=0, neginf=0))

    @property
    def flux(self) -> Array:
        """(m, 2) T grad u, the mean over each triangle: of the answer, not the one in balance of the bounds"""
        (ux, uy), (xx, xy, yy) = self.slopes.T, self.tension.T
        return np.column_stack((xx * ux + xy * uy, xy * ux + yy * uy))

    @property
    def energy_density(self) -> Array:
        """(m) grad u . T grad u / 2, the mean over each triangle"""
        return np.asarray((self.slopes * self.flux).sum(axis=1) / 2)

    def __repr__(self) -> str:
        return (f"{harmless(self.name)}: {counted(len(self.nodes), 'node')}, "
                f"{counted(len(self.triangles), 'triangle')}, "
                f"u from {self.u.min():.4g} to {self.u.max():.4g}{self.units.behind('L')}")


def joined(parts: Sequence[Field]) -> tuple[Array, Array, Array]:
    """All subdomains together; faces of cracks and slits have nodes of their own. nodes (n): of the mesh; part (n): the
    subdomain of each; triangles (m, 3): indices into nodes."""
    first = np.cumsum([0, *(len(part.nodes) for part in parts)])
    return (np.concatenate([part.nodes for part in parts]), np.repeat(np.arange(len(parts)), np.diff(first)),
            np.concatenate([part.triangles + start for part, start in zip(parts, first)]))


def _walked(message: Any, but: tuple[str, ...], **other: Any) -> Any:
    """Makes a class with the values of a message except `but`; unknown values default to `other` or to "not known"."""
    defaults = {name: value for name, value in {**entries.defaults_of(message), **other}.items() if name not in but}
    return make_dataclass(f"_{message.DESCRIPTOR.name}", [(name, type(value), field(default=value, kw_only=True))
                                                          for name, value in defaults.items()], repr=False)


@dataclass(repr=False)
class Inclusion(_walked(solve_pb2.InclusionAnswer, ("name",), Bx=0.0, By=0.0)):  # type: ignore[misc]
    """The values of InclusionAnswer in solve.proto under shorter names. u = A + Bx (x - x0) + By (y - y0) along the
    inclusion; resultant: the force on it; contact_length; Mx, My: the moment about (x0, y0). The membrane's exact A
    lies between A_lower and A_upper, and A is the middle; A_mesh is that of u on the mesh, and A too where there are no
    bounds. Bx and By likewise."""
    name: str
    units = Units()

    def __repr__(self) -> str:
        told = f"{harmless(self.name)}: A = {with_bounds(self, 'A', self.units.behind('L'))}"
        if self.Bx or self.By:
            told += f", Bx = {with_bounds(self, 'Bx')}, By = {with_bounds(self, 'By')}"
        return told


@dataclass(repr=False)
class BoundaryForce(_walked(solve_pb2.BoundaryAnswer, ())):  # type: ignore[misc]
    """The values of BoundaryAnswer in solve.proto: the force `resultant` on a side or a hole of the boundary, and Mx,
    My about (x, y); free: whether T du/dn is given there, and not u."""
    units = Units()

    def __repr__(self) -> str:
        return f"{harmless(self.name)}: {self.resultant:.6g}{self.units.behind('F')}{', given' * self.free}"


@dataclass(repr=False)
class ProbePoint(_walked(solve_pb2.ProbeAnswer, ())):  # type: ignore[misc]
    """The values of ProbeAnswer in solve.proto: u at a point of the probe `name`."""


@dataclass(repr=False)
class Tip(_walked(solve_pb2.Tip, ())):  # type: ignore[misc]
    """The values of Tip in solve.proto under shorter names: where a crack or an inclusion ends or its condition
    changes, what kind of tip that is, whether it is closed, and intensity, K_III and G with G_spread, NaN where it has
    none."""

    def __repr__(self) -> str:
        told = f"{self.kind.replace('_', ' ')} at ({self.x:.6g}, {self.y:.6g})"
        if self.reason:
            return f"{told}: {harmless(self.reason)}"
        if self.closed:
            return f"{told}: closed"
        return told + ": " + ", ".join(f"{name} = {getattr(self, name):.5g}" for name in ("intensity", "K_III", "G")
                                       if not np.isnan(getattr(self, name)))


@dataclass(repr=False)
class Load(_walked(solve_pb2.LoadCaseAnswer, ("name", "status"))):  # type: ignore[misc]
    """The answer to a load case: the values of LoadCaseAnswer in solve.proto, energy, contact_length, iterations and so
    on, and solve_seconds. status: "converged", "not_converged" (see reason), "failed" (see error) or "cancelled". The
    membrane's exact energy lies between energy_lower and energy_upper, and energy is the middle; energy_mesh is that of
    u on the mesh, and energy too where there are no bounds. solver: the method and its options.

    kkt: relative residuals of the optimality conditions. traces: one for each interface, by its name or index. history:
    arrays (n), one entry an iteration. stages: arrays, one entry a stage; empty without an accuracy.
    boundary: forces on its sides and holes. tips: of cracks and inclusions, in the order of the mesh's. growth: arrays,
    one entry for each position of fronts that grow: front (the one that leaves it), interface, position (arc length),
    x, y, load, displacement, G1, Gc, contact_length, energy, stable, ties, and of final positions G1_final,
    energy_lower, energy_upper, G1_lower, G1_upper, load_lower, load_upper (else NaN); beside a dead load G_dead;
    empty without growth. growth_notes: what happens, in words.
    contact_intervals: (index of the interface, begin, end) in arc length. fields: one for each subdomain, by its name
    or index, where they were asked for. indicator (m): part of each triangle in the square of error_bound, or None.
    balanced_flux (m, 3): of the flux behind the bounds, out of each triangle through the side opposite to each corner;
    a row sums to minus the load on the triangle; or None. Mesh.mean_flux makes vectors of it. membrane_rows, membranes:
    rows of growth whose membranes are kept, and u of each in the nodes of all fields; see grown."""
    name: str
    status: str
    warnings: list[str] = field(default_factory=list)
    inclusions: Named[Inclusion] = field(default_factory=lambda: Named("inclusion"))
    probe_points: list[ProbePoint] = field(default_factory=list)
    boundary: list[BoundaryForce] = field(default_factory=list)
    tips: list[Tip] = field(default_factory=list)
    growth: Arrays = field(default_factory=dict)
    growth_notes: list[str] = field(default_factory=list)
    traces: Parts[Trace] = field(default_factory=lambda: Parts("interface"))
    history: Arrays = field(default_factory=dict)
    stages: Arrays = field(default_factory=dict)
    contact_intervals: list[tuple[int, float, float]] = field(default_factory=list)
    fields: Parts[Field] = field(default_factory=lambda: Parts("subdomain"))
    indicator: Array | None = None
    balanced_flux: Array | None = None
    membrane_rows: Array | None = None
    membranes: Array | None = None
    units, solver = Units(), job_pb2.Solver()  # of the result

    @property
    def converged(self) -> bool:
        return self.status == "converged"

    @property
    def method(self) -> str:
        return "uzawa" if self.solver.HasField("uzawa") else "active-set"

    @property
    def kkt(self) -> dict[str, float]:
        return {name: getattr(self, f"kkt_{name}_relative") for name in KKT}

    @property
    def kkt_absolute(self) -> dict[str, float]:
        return {name: getattr(self, f"kkt_{name}") for name in KKT}

    @property
    def probes(self) -> dict[str, Arrays]:
        """Arrays s, x, y, u_minus, u_plus of each probe of the case, by its name, with an entry each point."""
        points: dict[str, list[ProbePoint]] = {}
        for point in self.probe_points:
            points.setdefault(point.name, []).append(point)
        return {name: {key: np.array([getattr(point, key) for point in all_of])
                       for key in ("s", "x", "y", "u_minus", "u_plus")} for name, all_of in points.items()}

    def grown(self, row: int) -> Load:
        """This load in a row of growth whose membrane is kept: its fields are u under the load of that row. It has
        neither traces nor growth. Raises Error for another row."""
        kept = [] if self.membrane_rows is None else [int(one) for one in self.membrane_rows]
        if row not in kept or self.membranes is None:
            raise Error(f"the membrane of row {row} of growth is not kept; " + (
                f"those of rows {', '.join(map(str, kept))} are" if kept else
                "solve with Case(fields=True), in TOML [output] fields = true"))
        values = self.membranes.reshape(len(kept), -1)[kept.index(row)]
        ends = np.cumsum([len(part.nodes) for part in self.fields])[:-1]
        # Copies keep the units and the mesh, which dataclasses.replace forgets.
        grown = copy.copy(self)
        grown.name, grown.fields = f"{self.name}, row {row}", Parts("subdomain")
        for part, u in zip(self.fields, np.split(values, ends)):
            grown.fields.append(copy.copy(part))
            grown.fields[-1].u = u
        grown.traces, grown.growth, grown.growth_notes = Parts("interface"), {}, []
        grown.membrane_rows = grown.membranes = None
        return grown

    def displacements(self) -> dict[str, float]:
        """A of every inclusion, by its name."""
        return {name: inclusion.A for name, inclusion in self.inclusions.items()}

    def _energy(self) -> str:
        return with_bounds(self, "energy", self.units.behind("F L"))

    def __repr__(self) -> str:
        told = f"{harmless(self.name)}: {self.status.replace('_', ' ')}"
        if self.reason or self.error:
            told += f" ({harmless(self.reason or self.error)})"
        if not np.isnan(self.energy):
            told += (f", energy = {self._energy()}, contact length "
                     f"{short_length(self.contact_length)}{self.units.behind('L')}")
        if self.no_bracket:
            told += f"\nno bounds: {self.no_bracket}"
        if self.growth:
            notes = [f"growth: {counted(len(self.growth['load']), 'row')}", *self.growth_notes]
            told += "\n" + "\n".join(map(harmless, notes))
        if self.inclusions:
            told += "\n" + lines(list(self.inclusions.values()))
        return told.replace("\n", "\n  ")

    def _repr_html_(self) -> str:
        """The HTML that a notebook shows."""
        length, force = self.units.label("L"), self.units.label("F")
        rows = [[part.name, with_bounds(part, "A"), f"{part.resultant:.6g}",
                 short_length(part.contact_length)] for part in self.inclusions.values()]
        return html_table(repr(self).partition("\n")[0], ["inclusion", "A" + length, "resultant" + force,
                                                          "contact length" + length], rows)


SCALARS = list(entries.defaults_of(solve_pb2.LoadCaseAnswer))  # names of a load's values, `name` first


@dataclass(repr=False)
class Sweep:
    """Columns with an entry for each row: status (3 converged, 4 not converged, 5 failed, 6 cancelled), steps, energy,
    contact_length, kkt (largest relative residual), displacement (rows, inclusions): A, slope (rows, inclusions, 2) or
    None, contact (rows, contacts) of the crack nodes contact_nodes (contacts, 2): interface, node. coefficients
    (rows, loads), or None where they are not known. energy_lower, energy_upper, displacement_lower, displacement_upper:
    bounds of the membrane's exact values, NaN if a row has none, or None if not asked for; energy and displacement are
    then the middles, and energy_mesh and displacement_mesh those of u on the mesh, else None. intensity,
    energy_release_rate, energy_release_rate_spread (rows, tips): of each tip of the mesh, NaN if it has none, or None
    if not asked for. kept: rows whose traces are in Result.loads["row-K"]. answer: SweepAnswer in solve.proto."""
    loads: list[str]
    inclusions: list[str]
    status: Array
    steps: Array
    energy: Array
    contact_length: Array
    kkt: Array
    displacement: Array
    contact: Array
    contact_nodes: Array
    slope: Array | None = None
    energy_lower: Array | None = None
    energy_upper: Array | None = None
    energy_mesh: Array | None = None
    displacement_lower: Array | None = None
    displacement_upper: Array | None = None
    displacement_mesh: Array | None = None
    intensity: Array | None = None
    energy_release_rate: Array | None = None
    energy_release_rate_spread: Array | None = None
    coefficients: Array | None = None
    kept: list[int] = field(default_factory=list)
    error: str = ""
    answer: solve_pb2.SweepAnswer = field(default_factory=solve_pb2.SweepAnswer)

    @property
    def solve_seconds(self) -> float:
        return float(entries.values_of(self.answer)["solve_seconds"])

    @property
    def converged(self) -> Array:
        """(rows) whether the row converged"""
        return np.asarray(self.status == solve_pb2.LoadCaseAnswer.STATUS_CONVERGED)

    def columns(self) -> dict[str, Any]:
        """Arrays (rows) by name: coefficients, status, A, its bounds and slopes by name, and numbers of tips."""
        columns: dict[str, Any] = {}
        if self.coefficients is not None:
            columns.update((name, self.coefficients[:, i]) for i, name in enumerate(self.loads))
        columns["status"] = [_status(code) for code in self.status]
        for name in ("steps", "energy", "energy_lower", "energy_upper", "energy_mesh", "contact_length", "kkt"):
            columns[name] = getattr(self, name)
        slopes: Any = (None, None) if self.slope is None else np.moveaxis(self.slope, 2, 0)
        for i, name in enumerate(self.inclusions):
            for what, values in (("A", self.displacement), ("A_lower", self.displacement_lower),
                                 ("A_upper", self.displacement_upper), ("A_mesh", self.displacement_mesh),
                                 ("Bx", slopes[0]), ("By", slopes[1])):
                columns[f"{what} of {name}"] = None if values is None else values[:, i]
        for what, values in (("intensity", self.intensity), ("G", self.energy_release_rate),
                             ("G_spread", self.energy_release_rate_spread)):
            for i in range(0 if values is None else values.shape[1]):
                columns[f"{what} of tip {i}"] = values[:, i]
        return {name: column for name, column in columns.items() if column is not None}

    def frame(self) -> Any:
        """The columns as a pandas.DataFrame; needs pandas."""
        return package("pandas").DataFrame(self.columns()).rename_axis("row")

    def __repr__(self) -> str:
        return (f"sweep of {counted(len(self.status), 'row')}, {int(self.converged.sum())} converged; loads: "
                f"{listed(self.loads)}; inclusions: {listed(self.inclusions) or 'none'}")


@dataclass(repr=False)
class Result:
    """All answers to a job. loads: answers by name, in the order of the case; interfaces: by name or index.
    not_reached: which accuracy was not reached and why."""
    title: str
    job: str
    mesh: Mesh
    interfaces: Parts[Interface]
    loads: Named[Load]
    sweep: Sweep | None = None
    not_reached: str = ""
    case: str = ""
    server_version: str = ""
    total_seconds: float = NAN
    units: Units = field(default_factory=Units)
    solver: job_pb2.Solver = field(default_factory=job_pb2.Solver)  # with defaults, as the server filled them in
    traction: bool | None = None  # whether a load has a traction; None if not known

    @property
    def converged(self) -> bool:
        """Whether all loads or rows converged and the accuracy, if one was asked for, is reached."""
        if self.sweep is not None:
            return bool(self.sweep.converged.all())
        return not self.not_reached and all(load.converged for load in self.loads.values())

    @property
    def mesh_name(self) -> str:
        return str(self.mesh.info.name)

    @property
    def solve_seconds(self) -> float:
        return self.sweep.solve_seconds if self.sweep is not None else float(sum(
            load.solve_seconds for load in self.loads.values()))

    def __getitem__(self, load: str) -> Load:
        return self.loads[load]

    def frame(self) -> Any:
        """The answers as a pandas.DataFrame with a line for each load case, "A of NAME" and its bounds; needs pandas.
        attrs["meanings"] explains the columns of numbers, attrs["units"] gives their units."""
        pandas = package("pandas")
        rows = []
        for load in self.loads.values():
            line = {name: getattr(load, name) for name in [*SCALARS, "method"]}
            for name, inclusion in load.inclusions.items():
                line.update({f"{column} of {name}": getattr(inclusion, column)
                             for column in ("A", "A_lower", "A_upper", "A_mesh", "resultant")})
            rows.append(line)
        frame = pandas.DataFrame(rows).set_index("name") if rows else pandas.DataFrame()
        told = [row for row in entries.meanings(solve_pb2.LoadCaseAnswer.DESCRIPTOR, "loads") if row[0] == "loads"]
        frame.attrs.update(units={name: self.units.of(unit) for _, name, unit, _ in told},
                           meanings={name: meaning for _, name, _, meaning in told})
        return frame

    def _title(self) -> str:
        what = repr(self.sweep) if self.sweep is not None else counted(len(self.loads), "load case")
        return f"{harmless(self.title or 'result')}: {counted(len(self.mesh.triangles), 'triangle')}, {what}"

    def __repr__(self) -> str:
        told = [self._title(), *([repr(self.loads)] if self.loads else [])]
        return "\n".join(told + [f"not reached: {harmless(self.not_reached)}"] * bool(self.not_reached))

    def _repr_html_(self) -> str:
        """The HTML that a notebook shows."""
        most = 8  # columns that are shown
        every = list(next(iter(self.loads.values())).inclusions) if self.loads else []
        rows, names = [], every[:most]
        for load in self.loads.values():
            parts = [load.inclusions.get(name) for name in names]
            rows.append([load.name, load.status.replace("_", " "), load._energy(), *(
                with_bounds(part, "A") if part is not None else "-" for part in parts)])
        head = ["load", "status", "energy", *(f"A of {name}{self.units.label('L')}" for name in names)]
        title = self._title() + (f"; not reached: {self.not_reached}" if self.not_reached else "")
        if len(every) > most:
            title += f"; A of the first {most} of {len(every)} inclusions"
        return html_table(title, head, rows)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Result:
        """Reads a result file of FORMAT."""
        h5py = package("h5py")
        try:
            with h5py.File(path) as file:
                found = str(file.attrs.get("format"))
                if found != FORMAT:
                    wrong = "is no result file of anticrack"
                    if found[:-1] == FORMAT[:-1]:
                        cure = "run the case again" if found < FORMAT else "use a newer one"
                        wrong = f"has format {found}, this package reads {FORMAT}: {cure}"
                    raise Error(f"{os.fspath(path)}: {wrong}")
                return _told(_of_file(file))
        except FileNotFoundError:
            raise Error(f"there is no file {os.fspath(path)}; name a result file, as Result.save or the command's -o "
                        "writes it") from None
        except (OSError, KeyError) as error:
            if str(path).endswith(".toml"):
                raise Error(f"{os.fspath(path)}: this is a case and no result; solve it, as with client.run") from None
            if "truncated" in str(error):
                raise Error(f"{os.fspath(path)}: is truncated or damaged; copy it again from where it was made, or run "
                            "again") from None
            raise Error(f"{os.fspath(path)}: cannot be read as a result file: {error}") from None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a result file, which the command shows, plots and exports too. An existing file is replaced; unless it
        is a result of the same case, it is kept as PATH~, with a warning."""
        package("h5py")
        from .save import save
        if save(self, path):
            warnings.warn(f"kept {os.fspath(path)}~, what {os.path.basename(path)} was before", stacklevel=2)

    @classmethod
    def of_job(cls, job: solve_pb2.Job, mesh: mesh_pb2.Mesh, mesh_arrays: Mapping[str, Array],
               arrays: Mapping[str, Array], case: str = "", server_version: str = "") -> Result:
        """Makes a result of the server's messages and of the arrays that it streams."""
        interfaces = Parts("interface", [Interface(info.name, **_below(arrays, f"interfaces/{i}/"), **{
            name: mesh_arrays[f"interfaces/{i}/{name}"] for name in ("edge_kind", "edge_inclusion")})
            for i, info in enumerate(mesh.interfaces)])
        shape = Mesh(**{name: mesh_arrays[name] for name in ("nodes", "triangles", "subdomain", "boundary")},
                     info=_without_definition(mesh))
        spec, status = job.spec, job.status
        result = cls(spec.title, job.name, shape, interfaces, Named("load"), None, status.not_reached, case,
                     server_version, units=Units(spec.units.length, spec.units.force),
                     solver=spec.solver, traction=any(load.traction for load in spec.load_cases))
        if spec.HasField("sweep"):
            traces = {int(row): _traces(arrays, f"traces/{row}", len(interfaces)) for row in spec.sweep.traces}
            kept = [row for row, found in traces.items() if found]  # the other rows did not end
            result.sweep = _sweep([load.name for load in spec.load_cases], shape.inclusions, _below(arrays, "sweep/"),
                                  kept, status.error.message, status.sweep_answer)
            result.loads.update((f"row-{row}", _row(result.sweep, row, traces[row], interfaces)) for row in kept)
        else:
            result.loads.update((answer.name, _load_of(job, i, arrays, result))
                                for i, answer in enumerate(status.answers))
        return _told(result)


def _without_definition(mesh: mesh_pb2.Mesh) -> mesh_pb2.Mesh:
    """A copy of the mesh as a file has it."""
    info = mesh_pb2.Mesh()
    info.CopyFrom(mesh)
    if info.HasField("geometry"):
        info.ClearField("geometry")
    info.ClearField("options")
    for line in info.interfaces:
        line.ClearField("segments")
    return info


def _told(result: Result) -> Result:
    """Tells the parts of a result their units, and traces their interfaces."""
    parts: list[Any] = [*result.interfaces, *result.loads.values()]
    for load in result.loads.values():
        parts += [*load.inclusions.values(), *load.boundary, *load.traces, *load.fields]
        for line, trace in zip(result.interfaces, load.traces):
            trace.name = line.name
        for part in load.fields:
            part.mesh = result.mesh
    for part in parts:
        part.units = result.units
    for load in result.loads.values():
        load.solver = result.solver
    return result


def _below(arrays: Mapping[str, Array], prefix: str) -> Arrays:
    """The arrays directly under a name, by the rest of their names."""
    return {name[len(prefix):]: array for name, array in arrays.items()
            if name.startswith(prefix) and "/" not in name[len(prefix):]}


def _traces(arrays: Mapping[str, Array], prefix: str, count: int) -> Parts[Trace]:
    found = [_below(arrays, f"{prefix}/{i}/") for i in range(count)]
    return Parts("interface", [Trace(**trace) for trace in found if trace])


def _status(code: int) -> str:
    return entries.status_name(code, solve_pb2.LoadCaseAnswer.Status.DESCRIPTOR)


def _sweep(loads: list[str], inclusions: list[str], columns: Arrays, kept: list[int], error: str,
           answer: solve_pb2.SweepAnswer) -> Sweep:
    rows = len(columns["status"])
    every: Arrays = {"displacement": np.empty((rows, 0)), "contact": np.empty((rows, 0), np.uint8),
                     "contact_nodes": np.empty((0, 2), np.int32), **columns}
    return Sweep(loads, inclusions, **every, kept=kept, error=error, answer=answer)


def _row(sweep: Sweep, row: int, traces: Parts[Trace], interfaces: list[Interface]) -> Load:
    """Makes the answer to a row whose traces were kept."""
    load = Load(f"row-{row}", _status(sweep.status[row]), iterations=int(sweep.steps[row]),
                traces=traces)
    energies = {"energy": sweep.energy, "energy_lower": sweep.energy_lower, "energy_upper": sweep.energy_upper,
                "energy_mesh": sweep.energy if sweep.energy_mesh is None else sweep.energy_mesh,
                "contact_length": sweep.contact_length}
    for key, values in energies.items():
        if values is not None:
            setattr(load, key, float(values[row]))
    columns = {"A": sweep.displacement, "A_lower": sweep.displacement_lower, "A_upper": sweep.displacement_upper,
               "A_mesh": sweep.displacement if sweep.displacement_mesh is None else sweep.displacement_mesh}
    slopes = np.zeros((*sweep.displacement.shape, 2)) if sweep.slope is None else sweep.slope
    for part, name in enumerate(("Bx", "By")):
        columns.update({name: slopes[:, :, part], name + "_mesh": slopes[:, :, part]})
    for i, name in enumerate(sweep.inclusions):
        load.inclusions[name] = Inclusion(name, **{  # type: ignore[arg-type]
            key: float(column[row, i]) for key, column in columns.items() if column is not None})
    for i, (line, trace) in enumerate(zip(interfaces, traces)):
        load.contact_intervals += [(i, float(line.s[first]), float(line.s[last - 1]))
                                   for first, last in runs(trace.contact) if trace.contact[first]]
    return load


def runs(values: Array) -> list[tuple[int, int]]:
    """The runs of equal entries, each as (first, last + 1)."""
    cuts = [int(last) + 1 for last in np.flatnonzero(np.diff(values))]
    return list(zip([0, *cuts], [*cuts, len(values)])) if len(values) else []


def _load_of_answer(answer: solve_pb2.LoadCaseAnswer, lines_in: list[str]) -> Load:
    """Makes a load of its answer, without the arrays; lines_in: names of the interfaces."""
    values = entries.values_of(answer)
    solved = values["status"] in ("converged", "not_converged")
    load = Load(**{name: value for name, value in values.items()
                   if solved or not isinstance(value, float) or name == "solve_seconds"})
    if solved:
        load.warnings = list(answer.warnings)
        load.inclusions.update((part.name, Inclusion(**entries.values_of(part))) for part in answer.inclusions)
        load.probe_points = [ProbePoint(**entries.values_of(part)) for part in answer.probes]
        load.boundary = [BoundaryForce(**entries.values_of(part)) for part in answer.boundary]
        load.tips = [Tip(**entries.values_of(part)) for part in answer.tips]
        rows = [entries.values_of(row) for row in answer.growth]
        load.growth = {name: np.array([row[name] for row in rows]) for name in (rows[0] if rows else ())}
        load.growth_notes = list(answer.growth_notes)
        load.contact_intervals = [(lines_in.index(part.interface), part.begin, part.end)
                                  for part in answer.contact_intervals]
    return load


def _load_of(job: solve_pb2.Job, index: int, arrays: Mapping[str, Array], result: Result) -> Load:
    load = _load_of_answer(job.status.answers[index], [line.name for line in result.interfaces])
    prefix = f"loads/{index}/"
    load.traces = _traces(arrays, prefix + "traces", len(result.interfaces))
    load.history, load.indicator = _below(arrays, prefix + "history/"), arrays.get(prefix + "indicator")
    load.balanced_flux = arrays.get(prefix + "balanced_flux")
    load.membrane_rows, load.membranes = (arrays.get(prefix + name) for name in ("membrane_rows", "membranes"))
    load.fields += [Field(name, u=arrays[f"{prefix}fields/{k}"], **_below(arrays, f"fields/{k}/"))
                    for k, name in enumerate(result.mesh.subdomain_names) if f"{prefix}fields/{k}" in arrays]
    stages = [stage for stage in job.status.stages if index < len(stage.answers)]
    if stages:
        rows = [entries.values_of(stage) | entries.values_of(stage.answers[index]) for stage in stages]
        load.stages = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return load


def chosen(result: Result, names: Sequence[str]) -> list[Load]:
    """The loads of these names, or all. Raises Error if one does not exist."""
    for name in names:
        if name not in result.loads:
            cure = suggestion(name, result.loads) if result.loads else (
                "it keeps traces of no row; run the sweep with --traces")
            raise Error(f"there is no load {harmless(name)}; {cure}")
    return [result.loads[name] for name in names] or list(result.loads.values())


def fields_cure(result: Result) -> str:
    """Says how to get the missing fields of a result."""
    anew = "run the case again with [output] fields = true"
    return (f"to have them: anticrack job fetch {harmless(result.job)} --fields -o fields.h5, while the server keeps "
            f"the job; else {anew}" if result.job else anew)


def _arrays(group: Any, *but: str) -> Arrays:
    return {name: item[()] for name, item in group.items()
            if hasattr(item, "shape") and item.dtype.names is None and name not in but}


def _texts(dataset: Any) -> list[str]:
    return [str(text) for text in dataset.asstr()[()]]


def _columns(dataset: Any) -> Arrays:
    """The members of a dataset of records."""
    if getattr(getattr(dataset, "dtype", None), "names", None) is None:
        raise KeyError(f"{dataset.name} is no dataset of records; run the case again")
    records = dataset[()]
    return {name: np.array([text.decode() for text in records[name]]) if records.dtype[name] == object else
            records[name].copy() for name in records.dtype.names}


def _message_in(group: Any, message: Any) -> Any:
    """Fills in a message with the values that a group has; the opposite of save's _put_message."""
    for name, place in entries.entries_of(message.DESCRIPTOR).items():
        value = group.attrs[name]
        entries.set_value(message, *place, value if isinstance(value, str) else value.item())
    for part in entries.lists_of(message.DESCRIPTOR):
        items = getattr(message, part.name)
        if part.message_type is None:
            items.extend(_texts(group[part.name]))
            continue
        columns = {name: values.tolist() for name, values in _columns(group[part.name]).items()}
        for row in zip(*columns.values()):
            item, values = items.add(), dict(zip(columns, row))
            for name, place in entries.entries_of(part.message_type).items():
                entries.set_value(item, *place, values[name])
    return message


def _of_file(file: Any) -> Result:
    told = file.attrs
    mesh = Mesh(**_arrays(file["mesh"], "inclusions", "warnings"), info=_message_in(file["mesh"], mesh_pb2.Mesh()))
    lines_in = [file[f"interfaces/{i}"] for i in range(len(file["interfaces"]))]
    names = [line.name for line in mesh.info.interfaces]
    groups = sorted(file["loads"].items(), key=lambda item: int(item[1].attrs.get("index", 0)))
    result = Result(told["title"], told["job"], mesh,
                    Parts("interface", [Interface(name, **_arrays(line)) for name, line in zip(names, lines_in)]),
                    Named("load", ((name, _load_in(item, names, mesh)) for name, item in groups)), None,
                    told["not_reached"], told["case"], told["server_version"], float(told["total_seconds"]),
                    Units(**file["units"].attrs), _message_in(file["solver"], job_pb2.Solver()))
    if result.case:
        result.traction = re.search("""traction[ \\t"']*=""", result.case) is not None
    if "sweep" in file:
        sweep = file["sweep"]
        arrays = _arrays(sweep, "warnings")
        kept = [int(row) for row in arrays.pop("kept", [])]
        loads, inclusions = ([str(name) for name in sweep.attrs[key]] for key in ("loads", "inclusions"))
        result.sweep = _sweep(loads, inclusions, arrays, kept, sweep.attrs["error"],
                              _message_in(sweep, solve_pb2.SweepAnswer()))
    return result


def _load_in(group: Any, lines_in: list[str], mesh: Mesh) -> Load:
    load = _load_of_answer(_message_in(group, solve_pb2.LoadCaseAnswer()), lines_in)

    def numbered(part: str) -> list[Any]:
        return [group[part][str(i)] for i in range(len(group[part]))] if part in group else []
    load.traces += [Trace(**_arrays(part)) for part in numbered("traces")]
    if group["history"].size:
        load.history = _columns(group["history"])
    if "stages" in group:
        load.stages = _columns(group["stages"])
    load.fields += [Field(name, **_arrays(part)) for name, part in zip(mesh.subdomain_names, numbered("fields"))]
    load.indicator = group["indicator"][()] if "indicator" in group else None
    load.balanced_flux = group["balanced_flux"][()] if "balanced_flux" in group else None
    load.membrane_rows, load.membranes = (group[name][()] if name in group else None
                                          for name in ("membrane_rows", "membranes"))
    return load
