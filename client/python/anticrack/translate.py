# SPDX-License-Identifier: GPL-3.0-or-later
"""A case, as tables, to the messages of the API. Shapes and types are checked here, ranges and meaning by the
server."""
from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .arrays import Array, array_of, is_number
from .errors import package
from .sections import Section
from .text import without_numpy
from .v1 import mesh_pb2, solve_pb2

_PRESETS = ["paper", "uniform", "graded", "coarse"]
_LINES = ["points", "arc", "spline", "center"]  # one of them gives a line
_LINE = [*_LINES, "angle", "length"]
_OUTLINE = ["circle", "points", "spline"]
_SIDES = ["left", "right"]
_UZAWA = ["theta", "epsilon", "p", "max_iterations", "mass", "kkt_tolerance"]
_ACTIVE_SET = ["tolerance", "max_steps"]
_FORCE = ('write a number, an expression in x and y in quotes, {region = number} or {file = "f.h5", dataset = "/f", '
          'per = "triangle"}')


_TENSION = "write a number above 0, an expression in x and y in quotes, or {along = T1, across = T2, angle = degrees}"
_NODES = ('give its values on the nodes of client.mesh_arrays(client.mesh(case))["nodes"], as Load(name, values, '
          'per="node")')


@dataclass
class Requests:
    """msh: the file to upload, its path or its bytes. arrays: (index of the load case, values of its f)."""
    mesh: mesh_pb2.CreateMeshRequest = field(default_factory=mesh_pb2.CreateMeshRequest)
    job: solve_pb2.Job = field(default_factory=solve_pb2.Job)
    msh: Path | bytes | None = None
    arrays: list[tuple[int, Array]] = field(default_factory=list)


def requests_of(tables: Mapping[str, Any], source: str, folder: Path, loads_needed: bool = True) -> Requests:
    """`source` names the case in errors; names of files are relative to `folder`."""
    root = Section(tables, "", ["title", "geometry", "mesh", "solver", "accuracy", "units", "load", "job", "output"],
                   source)
    out = Requests()
    title = root.text("title")
    if title is not None:
        out.mesh.title = out.job.title = title
    _mesh(root, folder, out)
    _solver(root, out.job.solver)
    if loads_needed or "load" in root:
        root.need("load", "write [[load]] with name and f for each load case")
    for section in root.sections("load", ["name", "f", "boundary_value", "traction", "point_forces",
                                          "inclusion_forces", "inclusion_moments"]):
        _load(section, folder, out)
    _accuracy(root, out)
    _job(root, out.job)
    units = root.section("units", ["length", "force"])
    if units is not None:
        out.job.units.SetInParent()
        _set(out.job.units, length=units.text("length"), force=units.text("force"))
    output = root.section("output", ["fields", "bounds"])
    if output is not None and output.boolean("fields"):
        out.job.outputs.append(solve_pb2.OUTPUT_FIELDS)
    if output is not None and output.boolean("bounds") is False:
        out.job.without_bounds = True
        if out.job.HasField("accuracy"):
            raise output.error("bounds", "an [accuracy] needs bounds; leave one of the two out")
    # Fields are drawn with where their errors come from, if there are bounds.
    if out.job.HasField("accuracy") or (out.job.outputs and out.job.solver.HasField("active_set")
                                        and not out.job.without_bounds):
        out.job.outputs.append(solve_pb2.OUTPUT_INDICATORS)
    _warn_of_tension(root, out)
    return out


def _warn_of_tension(root: Section, out: Requests) -> None:
    """Last: of a case with an error the error is told alone."""
    without = [region for region in out.mesh.geometry.regions
               if not (region.HasField("tension") or region.HasField("tension_law"))]
    options, units = out.mesh.options, out.job.units
    if 0 < len(without) < len(out.mesh.geometry.regions):
        others = len(without) - 1
        warnings.warn(str(root.error(f"geometry.region.{without[0].name}", (
            f"it and {others} more give" if others else "it gives") + " no tension, though other regions do, so "
            f"{'their' if others else 'its'} tension is 1; write tension = 1 where that is meant")))
    elif (len(without) == len(out.mesh.geometry.regions) and units.length and units.force
          and not options.tension and not options.tension_laws):
        warnings.warn(str(root.error("units", f"nothing gives a tension, so T is 1 {units.force}/{units.length}; write "
                                              + ("tension in [[geometry.region]]" if out.msh is None
                                                 else "[mesh.tension]"))))


def _set(message: Any, **values: Any) -> None:
    """Those that are not None."""
    for name, value in values.items():
        if value is not None:
            setattr(message, name, value)


def _mesh(root: Section, folder: Path, out: Requests) -> None:
    geometry = root.section("geometry", ["boundary", "hole", "interface", "inclusion", "crack", "neumann", "region"])
    mesh = root.section("mesh", ["preset", "size", "tip_size", "grading", "chord_angle", "align", "file", "groups",
                                 "tension", "inclusions"])
    out.mesh.options.preset = mesh_pb2.MESH_PRESET_GRADED
    if mesh is not None:
        _options(mesh, out.mesh.options)
    if mesh is not None and "file" in mesh:
        if geometry is not None:
            raise geometry.error("", "there is a mesh.file too; remove one of the two")
        data = mesh.table["file"]
        out.msh = data if isinstance(data, bytes) else folder / (mesh.text("file") or "")
        return
    root.need("geometry", 'write [geometry] with boundary and interface, or mesh.file = "x.msh"')
    assert geometry is not None
    _geometry(geometry, out.mesh.geometry)
    if "accuracy" in root and not (mesh is not None and "preset" in mesh):
        out.mesh.options.preset = mesh_pb2.MESH_PRESET_COARSE


def _options(section: Section, options: mesh_pb2.MeshOptions) -> None:
    preset = section.choice("preset", _PRESETS)
    name = "graded" if preset is None else _PRESETS[preset]
    _set(options, preset=None if preset is None else mesh_pb2.MESH_PRESET_PAPER + preset)
    idle = {"paper": ["size", "tip_size", "grading", "align"], "uniform": ["tip_size", "grading"]}.get(name, [])
    section.refuse(idle, f'means nothing with preset "{name}"; remove it, or write preset = "graded"')
    if "file" in section:
        section.refuse(["align", "chord_angle"], "means nothing with mesh.file; remove one of the two")
    else:
        section.refuse(["groups"], 'belongs to mesh.file; write file = "x.msh" beside it')
        section.refuse(["tension"], "belongs to mesh.file; for a geometry write [[geometry.region]] with name, at and "
                                    "tension")
        section.refuse(["inclusions"], "belongs to mesh.file; for a geometry write tilt or fixed in its "
                                       "[[geometry.inclusion]]")
    _set(options, size=section.positive("size"), tip_size=section.positive("tip_size"),
         grading=section.positive("grading"), chord_angle=section.positive("chord_angle"))
    if "align" in section:
        lines = section.list_of(section.get("align"), "align", "a list of lines", "write [[[x, y], [x, y], ...], ...]")
        for i, line in enumerate(lines):
            options.align.add(points=section.points_of(line, f"align.{i}"))
    groups = section.section("groups", ["curve", "surface"])
    if groups is not None:
        _groups(groups, "curve", options.curve_groups)
        _groups(groups, "surface", options.surface_groups)
    names = [name for name, _ in section.entries("tension", "write subdomain = tension for each")]
    tensions = section.section("tension", names)
    for name in names:
        assert tensions is not None
        given = _tension(tensions, name)
        if isinstance(given, mesh_pb2.Tension):
            options.tension_laws[name].CopyFrom(given)
        elif given is not None:
            options.tension[name] = given
    cure = "write NAME = { tilt = true } or NAME = { fixed = 0.1 } for each of them"
    for name, entry in section.entries("inclusions", cure):
        motion = options.inclusion_motions[name]
        _motion(Section(entry, f"mesh.inclusions.{name}", ["tilt", "fixed"], section.source), motion)


def _groups(section: Section, key: str, groups: Any) -> None:
    cure = ('write the tag of a physical group and its meaning in quotes, for example curve.7 = "crack" or '
            'surface.1 = "top"')
    for tag, meaning in section.entries(key, cure):
        if not tag.isdecimal() or not 1 <= int(tag) < 2**31:
            raise section.error(f"{key}.{tag}", f"'{tag}' is not a tag; {cure}")
        if not isinstance(meaning, str) or not meaning:
            raise section.error(f"{key}.{tag}", f"{without_numpy(meaning)!r} is not a meaning of a group; {cure}")
        groups[int(tag)] = meaning


def _motion(section: Section, message: Any) -> None:
    _set(message, tilt=section.boolean("tilt"), fixed=section.number("fixed"))
    if message.tilt and "fixed" in section:
        raise section.error("fixed", "the inclusion has tilt = true too, but one that is held does not tilt; remove "
                                     "one of the two")


def _geometry(section: Section, geometry: mesh_pb2.Geometry) -> None:
    _boundary(section, geometry)
    for hole in section.sections("hole", ["name", *_OUTLINE]):
        _outline(hole, "the hole", geometry.holes.add(name=hole.text("name") or "").outline)
    _interfaces(section, geometry)
    for part in section.sections("inclusion", ["name", "from", "to", *_LINE, "delaminated", "side", "tilt", "fixed",
                                               "contact"]):
        part.refuse(["contact"], "belongs to [[geometry.crack]]; an inclusion has delaminated = true or false")
        inclusion = geometry.inclusions.add(name=_name(part, "inclusion"))
        _place(part, "the inclusion", inclusion)
        _delamination(part, inclusion)
        _motion(part, inclusion)
    for part in section.sections("crack", ["name", "from", "to", *_LINE, "contact", "side", "tilt", "fixed"]):
        part.refuse(["tilt", "fixed"], "belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so remove "
                                       "it")
        part.refuse(["side"], "belongs to [[geometry.inclusion]]; the plus side of a crack is on its left, so write "
                              "it the other way round")
        crack = geometry.cracks.add(name=_name(part, "crack"))
        _place(part, "the crack", crack)
        _set(crack, contact=part.boolean("contact"))
    _neumann(section, geometry)
    for part in section.sections("region", ["name", "at", *_OUTLINE, "tension"]):
        region = geometry.regions.add(name=_name(part, "region"))
        if _shape(part, ["at", *_OUTLINE], "the region") in ("at", ""):
            at = part.need("at", "write [x, y], a point inside the region, or its outline: circle, points or spline")
            region.at.CopyFrom(mesh_pb2.Point(**part.point_of(at, "at")))
        else:
            _outline(part, "the region", region.outline)
        given = _tension(part, "tension")
        if isinstance(given, mesh_pb2.Tension):
            region.tension_law.CopyFrom(given)
        else:
            _set(region, tension=given)


def _tension(section: Section, key: str) -> float | mesh_pb2.Tension | None:
    """A number, or a law: an expression, or {along, across, angle}."""
    value = section.get(key)
    if isinstance(value, str):
        return mesh_pb2.Tension(along=value)
    if not isinstance(value, Mapping):
        if key in section:
            section.number_of(value, key, _TENSION)
        return section.positive(key)
    table = section.section(key, ["along", "across", "angle"])
    assert table is not None
    table.need("along", "write the tension in the direction of angle, a number or an expression")
    return mesh_pb2.Tension(along=table.expression("along"), across=table.expression("across"),
                            angle=table.number("angle") or 0)


def _name(section: Section, what: str) -> str:
    section.need("name", f"give the {what} a name")
    return section.text("name") or ""


def _shape(section: Section, keys: list[str], what: str) -> str:
    """The one of these keys that there is, or none."""
    given = [key for key in keys if key in section]
    if len(given) > 1:
        raise section.error(given[1], f"{what} has {given[0]} too; remove one of the two")
    return given[0] if given else ""


def _curve(section: Section, shape: str, curve: Any) -> None:
    """Points, arc or spline into an InterfaceCurve or a Line."""
    points = section.points_of(section.get(shape), shape)
    if shape == "arc":
        if len(points) != 3:
            raise section.error("arc", f"{points!r} is not an arc; write [from, through, to], three points with the "
                                       "second between the others")
        curve.arc.CopyFrom(mesh_pb2.Arc(**dict(zip(("from", "through", "to"), points))))
    else:
        line = curve.polyline if shape == "points" else curve.spline
        line.points.extend(mesh_pb2.Point(**point) for point in points)
        line.SetInParent()


def _line(section: Section, shape: str, line: mesh_pb2.Line) -> None:
    if shape != "center":
        _curve(section, shape, line)
        return
    section.need("length", "write its length, beside its center")
    line.segment.CopyFrom(mesh_pb2.Segment(center=section.point_of(section.get("center"), "center"),
                                           angle=section.number("angle"),
                                           length=section.positive("length", has_default=False)))


def _outline(section: Section, what: str, outline: mesh_pb2.Outline) -> None:
    shape = _shape(section, _OUTLINE, what)
    if not shape:
        raise section.error("", f"{what} without a shape; write circle = {{ center = [x, y], radius = r }}, points = "
                                "[[x, y], ...] or spline = [[x, y], ...]")
    if shape == "circle":
        circle = section.section("circle", ["center", "radius"])
        assert circle is not None
        center = circle.point_of(circle.need("center", "write [x, y]"), "center")
        circle.need("radius", "write its radius")
        outline.circle.CopyFrom(mesh_pb2.Circle(center=center, radius=circle.positive("radius", has_default=False)))
        return
    line = outline.polygon if shape == "points" else outline.spline
    line.points.extend(mesh_pb2.Point(**point) for point in section.points_of(section.get(shape), shape))
    line.SetInParent()


def _boundary(section: Section, geometry: mesh_pb2.Geometry) -> None:
    boundary = section.need("boundary", "write [[x, y], [x, y], ...], or [[geometry.boundary]] for each side")
    if not _tables(boundary):
        geometry.boundary.extend(mesh_pb2.Point(**point) for point in section.points_of(boundary, "boundary"))
        return
    for part in section.sections("boundary", ["name", *_LINE]):
        shape = _shape(part, _LINES, "the side")
        if not shape:
            raise part.error("", "a side without a shape; write points = [[x, y], ...], arc = [from, through, to] or "
                                 "spline = [[x, y], ...]")
        _line(part, shape, geometry.sides.add(name=part.text("name") or "").line)


def _tables(value: Any) -> bool:
    return isinstance(value, Mapping) or (isinstance(value, (list, tuple)) and bool(value)
                                          and isinstance(value[0], Mapping))


def _place(section: Section, what: str, owner: Any) -> None:
    """Of an inclusion or a crack: from and to on an interface, or a line of its own."""
    shape = _shape(section, _LINES, what)
    if shape != "center":
        section.refuse(["angle", "length"], "belongs to center; write center = [x, y], angle in degrees and length")
    if shape:
        section.refuse(["from", "to"], f"belongs to a part of an interface, but {what} has {shape}, a line of its "
                                       "own; remove one of the two")
        _line(section, shape, owner.line)
        return
    cure = ("write [x, y], a point of an interface, or a line of its own: points, arc, spline, or center, angle and "
            "length")
    owner.part.CopyFrom(mesh_pb2.InterfacePart(
        **{key: section.point_of(section.need(key, cure), key) for key in ("from", "to")}))


def _delamination(section: Section, inclusion: mesh_pb2.Inclusion) -> None:
    side = section.choice("side", _SIDES)
    if side is not None:
        inclusion.delaminated_side = _side(side)
    if "delaminated" not in section:
        return
    value = section.get("delaminated")
    if isinstance(value, (list, tuple)):
        parts = inclusion.delaminated_parts
        parts.SetInParent()
        for i, given in enumerate(value):
            key = f"delaminated.{i}"
            pair = section.plain(given, key)
            if isinstance(pair, (list, tuple)) and pair and is_number(pair[0]):
                start, end = section.numbers_of(pair, key, 2, "a stretch",
                                                "write [0.5, 1.0], by arc length over the whole length")
                parts.stretches.add(**{"from": start, "to": end})
            else:
                parts.parts.add(**section.part_of(pair, key))
    elif isinstance(value, bool):
        if not value:
            section.refuse(["side"], "nothing comes off on it, as delaminated = false; remove one of the two")
        inclusion.delaminated = value
    elif value in _SIDES:
        section.refuse(["side"], "delaminated names a side too; remove one of the two")
        inclusion.delaminated = True
        inclusion.delaminated_side = _side(_SIDES.index(value))
    else:
        raise section.error("delaminated", f"{value!r} is not possible; write true, false, \"left\", \"right\", "
                                           "[[from, to], ...] or [[0.5, 1.0], ...], stretches of its length")


def _side(index: int) -> mesh_pb2.LineSide:
    return mesh_pb2.LINE_SIDE_RIGHT if index else mesh_pb2.LINE_SIDE_LEFT


def _neumann(section: Section, geometry: mesh_pb2.Geometry) -> None:
    parts = section.get("neumann")
    if isinstance(parts, str) and parts == "all":
        for owners, other in ((geometry.sides, "side"), (geometry.holes, "hole")):
            geometry.neumann_sides.extend(owner.name or f"{other}-{i + 1}" for i, owner in enumerate(owners))
        if geometry.boundary:  # a part from a point to itself is the whole polygon
            geometry.neumann.add(**{"from": geometry.boundary[0], "to": geometry.boundary[0]})
    elif isinstance(parts, (list, tuple)):
        for i, part in enumerate(parts):
            if isinstance(part, str):
                geometry.neumann_sides.append(part)
            else:
                geometry.neumann.add(**section.part_of(part, f"neumann.{i}"))
    elif "neumann" in section:
        raise section.error("neumann", f"{parts!r} is not possible; write a list of names of sides and holes, or of "
                                       '[from, to], parts of the boundary walked counterclockwise, or "all"')


def _interfaces(section: Section, geometry: mesh_pb2.Geometry) -> None:
    value = section.get("interface")
    if isinstance(value, (list, tuple)) and not _tables(value):
        geometry.interfaces.add().polyline.points.extend(
            mesh_pb2.Point(**point) for point in section.points_of(value, "interface"))
        return
    for part in section.sections("interface", ["name", "points", "arc", "spline", "closed"]):
        shape = _shape(part, ["points", "arc", "spline"], "the interface")
        if not shape:
            raise part.error("", "an interface without a shape; write points = [[x, y], ...], arc = [from, through, "
                                 "to] or spline = [[x, y], ...]")
        curve = geometry.interfaces.add(name=part.text("name") or "", closed=part.boolean("closed") or False)
        _curve(part, shape, curve)
        if shape == "arc":
            part.refuse(["closed"], "an arc has two ends; remove the key, or write a spline through the points")


def _solver(root: Section, solver: solve_pb2.Solver) -> None:
    section = root.section("solver", ["method", *_UZAWA, *_ACTIVE_SET])
    if section is None or not section.choice("method", ["active-set", "uzawa"]):
        solver.active_set.SetInParent()
        if section is not None:
            section.refuse(_UZAWA, 'belongs to method "uzawa"; remove it, or write method = "uzawa"')
            _set(solver.active_set, tolerance=section.number("tolerance"), max_steps=section.count("max_steps"))
        return
    section.refuse(_ACTIVE_SET, 'belongs to method "active-set"; remove it, or write method = "active-set"')
    solver.uzawa.SetInParent()
    if section.get("theta") == "auto":
        solver.uzawa.theta_auto = True
    elif "theta" in section:
        solver.uzawa.theta = section.number_of(section.get("theta"), "theta", 'write a number above 0, or "auto"')
    mass = section.choice("mass", ["lumped", "consistent"])
    _set(solver.uzawa, epsilon=section.number("epsilon"), p=section.number("p"),
         max_iterations=section.count("max_iterations"), kkt_tolerance=section.number("kkt_tolerance"),
         mass=None if mass is None else solve_pb2.MASS_LUMPED + mass)


def _load(section: Section, folder: Path, out: Requests) -> None:
    load = out.job.load_cases.add(name=_name(section, "load case"),
                                  boundary_value=section.expression("boundary_value"),
                                  traction=section.expression("traction"))
    for force in section.sections("point_forces", ["at", "value"]):
        at = force.point_of(force.need("at", "write [x, y], where the force acts"), "at")
        force.need("value", "write the force, a number")
        load.point_forces.add(at=at, value=force.number("value"))
    load.inclusion_forces.update(section.numbers("inclusion_forces", "write inclusion = number for each of them"))
    held = [part.name for part in out.mesh.geometry.inclusions if part.HasField("fixed")]
    held += [name for name, motion in out.mesh.options.inclusion_motions.items() if motion.HasField("fixed")]
    for name in held:
        if name in load.inclusion_forces:
            raise section.error(f"inclusion_forces.{name}", "the inclusion is held by its key fixed, so a force on it "
                                                            "moves nothing; leave one of the two out")
    cure = "write inclusion = [Mx, My] for each of them"
    for name, entry in section.entries("inclusion_moments", cure):
        moment = load.inclusion_moments[name]
        moment.x, moment.y = section.numbers_of(entry, f"inclusion_moments.{name}", 2, "a moment", cure)
    # Without any other load, a missing f is most likely forgotten.
    if "f" in section or not (load.boundary_value or load.traction or load.point_forces or load.inclusion_forces
                              or load.inclusion_moments):
        section.need("f", _FORCE)
        load.force.SetInParent()
        _force(section, folder, load.force, out)


def _force(section: Section, folder: Path, force: solve_pb2.Force, out: Requests) -> None:
    value = section.get("f")
    if isinstance(value, str):
        force.expression = value
    elif not isinstance(value, Mapping):
        force.constant = section.number_of(value, "f", f"{_FORCE}; or {_NODES}" if callable(value) else _FORCE)
    elif any(key in value for key in ("values", "dataset", "per")) or isinstance(value.get("file"), str):
        known = ["values", "per"] if "values" in value else ["file", "dataset", "per"]
        array = Section(value, f"{section.path}.f", known, section.source)
        array.need("per", 'write per = "triangle" or per = "node"')
        force.array.per_triangle = array.choice("per", ["triangle", "node"]) == 0
        out.arrays.append((len(out.job.load_cases) - 1, _values(array, folder)))
    else:
        force.per_region.SetInParent()
        force.per_region.values.update(section.numbers("f", "write one number for each region"))


def _values(section: Section, folder: Path) -> Array:
    key = "values"
    if key in section:
        values = section.table[key]
    else:
        h5py = package("h5py")
        section.need("file", "name an HDF5 file")
        section.need("dataset", 'name the dataset in the file, as "/f"')
        path, key = folder / (section.text("file") or ""), "dataset"
        try:
            with h5py.File(path) as file:
                found = file[section.text("dataset")]
                if not isinstance(found, h5py.Dataset):
                    kind = "group" if isinstance(found, h5py.Group) else "named type"
                    raise section.error("dataset", f"{section.text('dataset')} is a {kind}, not a dataset"
                                        + (f"; it has {', '.join(found)}" if kind == "group" and len(found) else ""))
                values = found[()]
        except (OSError, KeyError) as error:
            raise section.error("file", f"{path}: {error}") from None
    of = f"{section.text('per')}s"
    return array_of(values, (of,), lambda problem: section.error(key, problem), in_order=True)


def _accuracy(root: Section, out: Requests) -> None:
    section = root.section("accuracy", ["energy", "A", "each_inclusion", "max_triangles", "time", "keep_stages"])
    if section is None:
        return
    for key, name in (("energy", "energy"), ("A", "displacement")):
        error = section.number(key)
        if error is not None and not 1e-6 <= error <= 1:
            raise section.error(key, f"{error:g} is out of range; write a relative error from 1e-6 to 1, as 1e-3")
        _set(out.job.accuracy, **{name: error})
    if "energy" not in section and "A" not in section:
        raise section.error("", "no accuracy; write energy = 1e-3, A = 1e-3, or both")
    if "each_inclusion" in section and "A" not in section:
        raise section.error("each_inclusion", "is about A; write A = 1e-2 with it")
    _set(out.job.accuracy, max_triangles=section.count("max_triangles"), keep_stages=section.boolean("keep_stages"),
         each_inclusion=section.boolean("each_inclusion"))
    time = section.time("time")
    if time is not None:
        out.job.accuracy.time.CopyFrom(time)
    if out.job.solver.HasField("uzawa"):
        raise root.error("solver.method", 'the answers of "uzawa" have no bounds; with [accuracy] write method = '
                                          '"active-set"')
    for index, _ in out.arrays:
        raise root.error(f"load.{index}.f", "values in a file belong to one mesh, and [accuracy] refines it; write f "
                                            "as an expression")


def _job(root: Section, job: solve_pb2.Job) -> None:
    section = root.section("job", ["priority", "queue_timeout", "run_timeout"])
    if section is None:
        return
    priority = section.choice("priority", ["interactive", "normal", "bulk"])
    _set(job, priority=None if priority is None else solve_pb2.Job.PRIORITY_INTERACTIVE + priority)
    for key in ("queue_timeout", "run_timeout"):
        time = section.time(key)
        if time is not None:
            getattr(job, key).CopyFrom(time)
