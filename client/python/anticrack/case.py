# SPDX-License-Identifier: GPL-3.0-or-later
"""A case: a membrane, its mesh, its loads and how to solve them. It is built of the objects below, or read from TOML;
the guide explains the keys and their defaults. Lengths, forces and displacements are in your units. A point is (x, y),
points are a list of such pairs or an array (n, 2). None stands for the default."""
from __future__ import annotations

import os
import pathlib
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from .arrays import Array, is_array
from .errors import CaseError
from .msh import Msh
from .text import listed, short, shown, without_numpy

Point = Sequence[float]
Points = Sequence[Point] | Array
Part = tuple[Point, Point]
Tension = float | str | Mapping[str, float | str]
# Names in Python that differ from the key in TOML.
_KEYS = {"start": "from", "end": "to", "interfaces": "interface", "inclusions": "inclusion", "cracks": "crack",
         "regions": "region", "holes": "hole", "paths": "path"}


def tables_of(value: Any) -> Any:
    """Replaces the objects below by their tables, at any depth of the value."""
    if isinstance(value, (list, tuple)):
        return [tables_of(item) for item in value]
    if isinstance(value, dict):
        return {key: tables_of(item) for key, item in value.items()}
    return value.table() if isinstance(value, _Table) else value


class _Table:
    def table(self, keys: Mapping[str, str] = _KEYS) -> dict[str, Any]:
        """The object as a table of TOML, without values that are None or empty."""
        entries = fields(self)  # type: ignore[arg-type]
        out = {keys.get(entry.name, entry.name): tables_of(getattr(self, entry.name)) for entry in entries}
        return {key: value for key, value in out.items()
                if value is not None and not (isinstance(value, (list, dict)) and not value)}

    def __repr__(self) -> str:
        """Shows the values that are given; long ones are cut."""
        given = {entry.name: without_numpy(getattr(self, entry.name))
                 for entry in fields(self)}  # type: ignore[arg-type]
        told = [f"{name}={short(repr(given[name]))}" for name in sorted(given, key=lambda name: name != "name")
                if given[name] is not None and not (isinstance(given[name], list) and not given[name])]
        return f"{type(self).__name__}({', '.join(told)})"


@dataclass(kw_only=True, repr=False)
class _Line(_Table):
    """A line, given by its points, as an arc (start, through, end), as a spline, or as a straight line by its center,
    its angle [degrees] and its length."""
    points: Points | None = None
    arc: Points | None = None
    spline: Points | None = None
    center: Point | None = None
    angle: float | None = None
    length: float | None = None


@dataclass(kw_only=True, repr=False)
class _Outline(_Table):
    """A closed line: circle = {"center": (x, y), "radius": r}, points as corners of a polygon, or a spline."""
    circle: Mapping[str, Any] | None = None
    points: Points | None = None
    spline: Points | None = None


@dataclass(repr=False)
class Interface(_Table):
    """A line on which cracks and inclusions lie, given by its points, as an arc (start, through, end) or as a spline;
    its plus side is on its left. closed: the points or the spline make a ring."""
    points: Points | None = None
    arc: Points | None = None
    spline: Points | None = None
    name: str | None = None
    closed: bool | None = None


@dataclass(repr=False)
class Inclusion(_Line):
    """A thin rigid inclusion, from start to end on an interface, or on a line of its own: points, arc, spline, or
    center, angle and length. delaminated: True, False, the side "left" or "right", parts [(start, end), ...], or
    stretches [(0.5, 1.0), ...] as fractions of its arc length; side: with a list, the side that comes off, "left" or
    "right". tilt: the inclusion can turn as well; fixed: it is held at this u."""
    name: str
    start: Point | None = None
    end: Point | None = None
    delaminated: bool | str | Sequence[Part] | Sequence[tuple[float, float]] | None = None
    tilt: bool | None = None
    fixed: float | None = None
    side: str | None = None


@dataclass(repr=False)
class Crack(_Line):
    """A crack, placed like an inclusion. contact: True demands [u] >= 0 (the default), False leaves the faces free."""
    name: str
    start: Point | None = None
    end: Point | None = None
    contact: bool | None = None


@dataclass(repr=False)
class Region(_Outline):
    """Names the subdomain around the point `at`, or all that is inside an outline: points, a spline, or circle =
    {"center": (x, y), "radius": r}. Gives it the tension T [force per length]: a number, an expression in x and y, or
    {"along": T1, "across": T2, "angle": degrees}, where T1 acts in the direction of the angle."""
    name: str
    at: Point | None = None
    tension: Tension | None = None


@dataclass(repr=False)
class Side(_Line):
    """A side of the boundary, which begins where the side before it ends; its line is given as for an inclusion."""
    name: str | None = None


@dataclass(repr=False)
class Hole(_Outline):
    """A hole in the membrane; its outline is given as for a region."""
    name: str | None = None


@dataclass(repr=False)
class Geometry(_Table):
    """boundary: a polygon or sides. u = g_D on the boundary and the holes, except where `neumann` says: names of sides
    (side-1, ... of a polygon) and holes, stretches (start, end) walked counterclockwise, or "all"."""
    boundary: Points | Sequence[Side]
    interfaces: list[Interface] = field(default_factory=list)
    inclusions: list[Inclusion] = field(default_factory=list)
    cracks: list[Crack] = field(default_factory=list)
    regions: list[Region] = field(default_factory=list)
    neumann: Sequence[Part | str] | str | None = None
    holes: list[Hole] = field(default_factory=list)


@dataclass(repr=False)
class Mesh(_Table):
    """How fine the mesh is: preset "graded" (default), "uniform", "paper" or "coarse"; sizes are lengths,
    chord_angle is in degrees.

    file: a .msh, or an Msh of arrays, instead of a geometry. Only a file takes curves and surfaces (physical tag ->
    what it is), tension (by subdomain, as for a Region) and inclusions (by name: {"tilt": True} or {"fixed": u})."""
    preset: str | None = None
    size: float | None = None
    tip_size: float | None = None
    grading: float | None = None
    chord_angle: float | None = None
    align: Sequence[Points] | None = None
    file: str | os.PathLike[str] | Msh | None = None
    curves: Mapping[int, str] | None = None
    surfaces: Mapping[int, str] | None = None
    tension: Mapping[str, Tension] | None = None
    inclusions: Mapping[str, Mapping[str, Any]] | None = None

    def table(self, keys: Mapping[str, str] = _KEYS) -> dict[str, Any]:
        out = super().table({})
        groups = {toml: out.pop(name) for name, toml in (("curves", "curve"), ("surfaces", "surface")) if name in out}
        if groups:
            out["groups"] = groups
        if isinstance(self.file, Msh):
            out["file"] = self.file.to_bytes()
        return out


@dataclass(repr=False)
class Load(_Table):
    """f [force per area]: a number, an expression in x and y, {subdomain: number}, or with per = "node" or "triangle"
    an array with a value for each of them in the mesh, but no Python function. boundary_value, traction: numbers or
    expressions. point_forces: [((x, y), force), ...]. inclusion_forces: {name: force}; inclusion_moments: {name: (Mx,
    My)}."""
    name: str
    f: float | str | Mapping[str, float] | Array | None = None
    per: str | None = None
    boundary_value: float | str | None = None
    traction: float | str | None = None
    point_forces: Sequence[tuple[Point, float]] | None = None
    inclusion_forces: Mapping[str, float] | None = None
    inclusion_moments: Mapping[str, Point] | None = None

    def table(self, keys: Mapping[str, str] = _KEYS) -> dict[str, Any]:
        out = super().table(keys)
        per = out.pop("per", None)
        if per is not None or is_array(self.f):
            out["f"] = {"values": self.f, "per": per}
        try:
            if self.point_forces is not None:
                out["point_forces"] = [{"at": at, "value": value} for at, value in self.point_forces]
        except (TypeError, ValueError):
            raise CaseError(f"load {self.name}: point_forces: {shown(self.point_forces)} is not a list of points and "
                            "forces; write [((x, y), force), ...]") from None
        return out


@dataclass(repr=False)
class ActiveSet(_Table):
    """The active-set method, which is exact and the default."""
    tolerance: float | None = None
    max_steps: int | None = None

    def table(self, keys: Mapping[str, str] = _KEYS) -> dict[str, Any]:
        return {"method": "active-set", **super().table(keys)}


@dataclass(repr=False)
class Uzawa(_Table):
    """The Uzawa method, Algorithm 2 of the paper. theta: a number or "auto"; mass: "lumped" or "consistent"."""
    theta: float | str | None = None
    epsilon: float | None = None
    p: float | None = None
    max_iterations: int | None = None
    mass: str | None = None
    kkt_tolerance: float | None = None

    def table(self, keys: Mapping[str, str] = _KEYS) -> dict[str, Any]:
        return {"method": "uzawa", **super().table(keys)}


@dataclass(kw_only=True, repr=False)
class Accuracy(_Table):
    """Relative errors of the energy and of the displacements A that the job has to reach, proved by bounds.
    A_estimated: the same of A by an estimate, which is no proof. time: seconds, or "10min"."""
    energy: float | None = None
    A: float | None = None
    largest: bool | None = None
    max_triangles: int | None = None
    time: float | str | None = None
    keep_stages: bool | None = None
    A_estimated: float | None = None


@dataclass(repr=False, kw_only=True)
class Probe(_Table):
    """Where answers tell u: at a point, or at `points` points of the line from start to end."""
    name: str | None = None
    at: Point | None = None
    start: Point | None = None
    end: Point | None = None
    points: int | None = None


@dataclass(repr=False)
class Path(_Table):
    """A stretch of an interface, from start to end, that holds at first and along which fronts grow. Gc: what growth
    costs per length, a number or an expression in x and y."""
    interface: str
    start: Point
    end: Point
    Gc: float | str


@dataclass(repr=False)
class Growth(_Table):
    """Delaminations and cracks grow under each load, which is scaled. inclusion: its displacement is increased, in
    place of the load. positions: about so many on all paths together. final: so many of them are solved again on
    meshes of their own, with bounds of G1 between them to final_error of it."""
    paths: list[Path]
    inclusion: str | None = None
    positions: int | None = None
    final: int | None = None
    final_error: float | None = None


@dataclass(repr=False)
class Units(_Table):
    """Names of units to show; no number is converted. "mm" and "N" give T in N/mm, f in N/mm^2, energies in N mm."""
    length: str | None = None
    force: str | None = None


class Case:
    """tables: the case as tomllib reads it; you may change them before you submit the case. Geometry, loads and the
    other objects are read when the case is built, so changing these later has no effect."""

    def __init__(self, geometry: Geometry | None = None, loads: Sequence[Load] = (), mesh: Mesh | None = None,
                 solver: ActiveSet | Uzawa | None = None, accuracy: Accuracy | None = None, title: str = "",
                 units: Units | None = None, fields: bool = False, bounds: bool = True, priority: str | None = None,
                 queue_timeout: float | str | None = None, run_timeout: float | str | None = None,
                 probes: Sequence[Probe] = (), growth: Growth | None = None, balanced_flux: bool = False) -> None:
        """fields: keep u on every node, which drawing the membrane needs. bounds: bound the error of each answer.
        balanced_flux: keep the flux behind the bounds (Load.balanced_flux).
        Timeouts are seconds, or text such as "2h"."""
        job = {"priority": priority, "queue_timeout": queue_timeout, "run_timeout": run_timeout}
        tables: dict[str, Any] = {
            "title": title or None, "geometry": geometry, "mesh": mesh, "solver": solver, "accuracy": accuracy,
            "growth": growth, "units": units, "load": loads if isinstance(loads, _Table) else list(loads) or None,
            "output": ({"fields": fields, "bounds": bounds} if fields or not bounds else {})
            | ({"balanced_flux": True} if balanced_flux else {}) | ({"probe": list(probes)} if probes else {}) or None,
            "job": {key: value for key, value in job.items() if value is not None} or None}
        self.tables = tables_of({key: value for key, value in tables.items() if value is not None})
        self.text, self.source, self.folder = "", "", pathlib.Path()

    @classmethod
    def parse(cls, text: str, source: str = "case", folder: str | os.PathLike[str] = ".") -> Case:
        """Reads a case from TOML text; file names in it are relative to `folder`, and errors call the text `source`."""
        case = cls()
        try:
            case.tables = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            of_value = str(error).startswith(("Invalid value", "Expected newline or end of document"))
            cure = ("; a value is a number as 3.5, true, false, a text in quotes or a list; units are named in [units]"
                    if of_value else "")
            raise CaseError(f"{source}: this is not TOML: {error}{cure}") from None
        case.text, case.source, case.folder = text, source, pathlib.Path(folder)
        return case

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Case:
        """Reads a case from a TOML file."""
        path = pathlib.Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except OSError as error:
            raise CaseError(f"{path}: cannot be read: {error.strerror}; name a case, a TOML file") from None
        except UnicodeDecodeError:
            raise CaseError(f"{path}: this is not text; name a case, a TOML file") from None
        return cls.parse(text, str(path), path.parent)

    def __repr__(self) -> str:
        return f"<Case {self.tables.get('title', '')!r} with {listed(self.tables)}>"

    if not TYPE_CHECKING:  # type checkers know the attributes and report others themselves
        def __setattr__(self, name: str, value: Any) -> None:
            if name not in ("tables", "text", "source", "folder"):
                raise AttributeError(f"case.{name} cannot be set: the case is built; change case.tables, which has "
                                     f"{listed(self.tables)}, or build another Case", name=name, obj=self)
            super().__setattr__(name, value)


def as_case(case: Case | str | os.PathLike[str]) -> Case:
    """Returns a case as it is, and reads the file of a path."""
    if not isinstance(case, (Case, str, os.PathLike)):
        raise CaseError(f"case: {shown(case)} is no case; give a Case, or the path of a TOML file")
    return case if isinstance(case, Case) else Case.read(case)
