# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever kind of array there is: taken as what it means, or refused in words, wherever an array is taken."""
import array
import collections
import decimal
import fractions
import pathlib
import unittest
import warnings

import h5py
import numpy
import numpy.ma.mrecords
import pandas

import anticrack
from anticrack import Case, Geometry, Inclusion, Interface, Load, Mesh, Msh, Region
from anticrack.sweeps import sweep_of
from anticrack.v1 import job_pb2
from cases import read
from processes import FolderTest

SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
ROWS = numpy.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])  # as coefficients, forces, points and, flat, as values


class Lazy:
    """As of jax or torch: no array of numpy, but makes one."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        if isinstance(self.values, Exception):
            raise self.values
        return numpy.asarray(self.values, dtype)


class Quantity(numpy.ndarray):
    """As of astropy."""
    unit = "mm"


class Magnitude:
    """As of pint."""

    def __init__(self, magnitude):
        self.magnitude = magnitude

    units = property(lambda self: "mm")

    def __array__(self, dtype=None, copy=None):
        return numpy.asarray(self.magnitude, dtype)


class Rows(collections.abc.Sequence):
    def __init__(self, rows):
        self.rows = rows

    def __len__(self):
        return len(self.rows)

    def __getitem__(self, at):
        return self.rows[at]


def strided(values):
    wide = numpy.zeros([2 * size for size in values.shape])
    wide[tuple(slice(None, None, 2) for _ in values.shape)] = values
    return wide[tuple(slice(None, None, 2) for _ in values.shape)]


def broadcast(values):
    return numpy.lib.stride_tricks.as_strided(values.copy(), values.shape, values.strides, writeable=False)


def masked(values, where=None):
    mask = numpy.zeros(values.shape, bool)
    if where is not None:
        mask.flat[where] = True
    return numpy.ma.array(values, mask=mask)


def objects(values, entry=...):
    out = values.astype(object)
    if entry is not ...:
        out.flat[2] = entry
    return out


def with_entry(values, entry):
    out = values.copy()
    out.flat[2] = entry
    return out


def records(values):
    return numpy.rec.fromarrays([values.ravel(), values.ravel()], names="a,b")


# The same numbers.
RIGHT = {
    "big-endian": lambda v: v.astype(">f8"), "big-endian integers": lambda v: v.astype(">i2"),
    "every second": strided, "Fortran": numpy.asfortranarray, "backwards": lambda v: v[::-1].copy()[::-1],
    "mirrored twice": lambda v: numpy.flip(numpy.flip(v).copy()), "unaligned": lambda v: numpy.frombuffer(
        b"x" + v.tobytes(), offset=1).reshape(v.shape),
    "float16": lambda v: v.astype("f2"), "float32": lambda v: v.astype("f4"),
    "longdouble": lambda v: v.astype(numpy.longdouble), "int8": lambda v: v.astype("i1"),
    "uint64": lambda v: v.astype("u8"), "objects": objects, "read-only": broadcast, "lists": lambda v: v.tolist(),
    "tuples": lambda v: tuple(v.tolist()), "scalars of numpy": lambda v: [
        [*map(numpy.float32, row)] for row in v] if v.ndim == 2 else [*map(numpy.float32, v)],
    "fractions": lambda v: objects(v, fractions.Fraction(3)), "large whole numbers": lambda v: objects(v, 3),
    "nothing masked": masked, "lazy": Lazy, "lazy rows": lambda v: [Lazy(row) for row in v],
    "matrix": lambda v: numpy.matrix(v) if v.ndim == 2 else numpy.asarray(numpy.matrix(v))[0],
    "subclass": lambda v: v.view(type("Own", (numpy.ndarray,), {})),
    "buffer": lambda v: memoryview(v), "array of Python": lambda v: array.array("d", v) if v.ndim == 1 else v,
    "pandas": lambda v: pandas.DataFrame(v) if v.ndim == 2 else pandas.Series(v),
    "pandas, float32": lambda v: pandas.DataFrame(v.astype("f4")) if v.ndim == 2 else pandas.Series(v.astype("f4")),
    "pandas with nullable numbers": lambda v: (pandas.DataFrame(v).astype("Float64") if v.ndim == 2 else
                                               pandas.Series(v, dtype="Float64")),
    "pandas with names": lambda v: (pandas.DataFrame(v, index=list("pqr")) if v.ndim == 2 else
                                    pandas.Series(v, index=list("pqrstu"))),
}

# What the error says.
WRONG = {
    "complex": (lambda v: v + 0j, "complex128 holds complex numbers; write .real"),
    "true and false": (lambda v: v > 2, "bool holds true and false; give numbers"),
    "text": (lambda v: v.astype(str), "<U32 holds text; give numbers"),
    "bytes": (lambda v: v.astype("S"), "holds bytes"),
    "a text": (lambda v: bytearray(v.tobytes()), r"a bytearray is no array|is not a finite number"),
    "times": (lambda v: v.astype("datetime64[s]"), "holds times; give numbers"),
    "spans of time": (lambda v: v.astype("timedelta64[s]"), "holds times"),
    "spans one by one": (lambda v: objects(v, numpy.timedelta64(1, "s")), "is not a number"),
    "records": (lambda v: records(v), "holds records of a structured array"),
    "masked records": (lambda v: records(v).view(numpy.ma.mrecords.mrecarray), "holds records"),
    "masked": (lambda v: masked(v, 2), "1 of 6 entries are masked; give values for them, as .filled"),
    "masked rows": (lambda v: [*masked(v, 2)], "are masked"),
    "masked by hand": (lambda v: [numpy.ma.masked, *v.ravel()], "are masked"),
    "NaN": (lambda v: with_entry(v, numpy.nan), r"nan at \[(2|1, 0)\] is not a finite number"),
    "infinite": (lambda v: with_entry(v, -numpy.inf), r"-inf at "),
    "NaN as float16": (lambda v: with_entry(v, numpy.nan).astype("f2"), r"nan at "),
    "too large": (lambda v: with_entry(v.astype(numpy.longdouble), numpy.longdouble("1e400")), r"(1e\+400|inf) at "),
    "far too large": (lambda v: objects(v, 10**400), "larger than any of float64"),
    "None": (lambda v: objects(v, None), r"None at \[(2|1, 0)\] \(NoneType\)"),
    "missing": (lambda v: pandas.DataFrame(masked(v, 2)).astype("Float64") if v.ndim == 2 else
                pandas.Series(objects(v, None), dtype="Float64"), r"(<NA>|nan) at "),
    "decimals": (lambda v: objects(v, decimal.Decimal(1)), r"Decimal\('1'\) at "),
    "a truth in it": (lambda v: objects(v, True), r"True at "),
    "lists of several lengths": (lambda v: [[1, 2], [3]], "not all of one length"),
    "no dimension": (lambda v: numpy.array(3.0), r"shape \(\) is not|is not a finite number|array"),
    "too many dimensions": (lambda v: v[..., None, None], r"of shape \(.*\) is not \("),
    "empty": (lambda v: v[:0], "it is empty"),
    "a generator": (lambda v: (x for x in v), "a generator gives its values only once; write list"),
    "a set": (lambda v: set(v.ravel()), "a set has no order"),
    "values of a dict": (lambda v: dict(enumerate(v)).values(), "a dict_values is no array of numbers"),
    "a unit": (lambda v: v.view(Quantity), "a Quantity has the unit mm; convert it"),
    "a unit outside": (Magnitude, "a Magnitude has the unit mm"),
    "rows with a unit": (lambda v: [row.view(Quantity) if v.ndim == 2 else Magnitude(row) for row in v], "the unit mm"),
    "one that fails": (lambda v: Lazy(RuntimeError("on a device")), "a Lazy cannot be read as an array: on a device"),
}


def value_of(kind):
    return {"per node": ROWS.ravel(), "per triangle": ROWS.ravel()}.get(kind, ROWS)


def load_of(per):
    def taken(values):
        case = Case(Geometry(SQUARE), [Load("a", 0), Load("b", {"values": values, "per": per})])
        ((index, found),) = read(case).arrays()
        return index, found
    return taken


def spec_of(*names):
    return job_pb2.JobSpec(load_cases=[job_pb2.LoadCase(name=name) for name in names])


def sweep(**arrays):
    matrix = sweep_of(spec_of("0", "1"), arrays.get("coefficients"), arrays.get("nodal_forces"), (), False, False)
    return numpy.frombuffer(matrix).reshape(-1, 2)


def points_of_msh(values):
    text = Msh(values, {"triangle": [(0, 1, 2)]}).to_bytes().decode()
    lines = text.split("$Nodes\n")[1].split("$EndNodes")[0].splitlines()[1:]
    return numpy.array([[float(x) for x in line.split()[1:3]] for line in lines])


def points_of_interface(values):
    case = Case(Geometry(SQUARE, [Interface(values)]), [Load("a", 0)])
    (line,) = read(case).mesh.geometry.interfaces
    return numpy.array([(point.x, point.y) for point in line.polyline.points])


PLACES = {
    "per node": lambda v: load_of("node")(v)[1], "per triangle": lambda v: load_of("triangle")(v)[1],
    "coefficients": lambda v: sweep(coefficients=v), "forces": lambda v: sweep(nodal_forces=v),
    "points of a mesh": points_of_msh, "points of a line": points_of_interface}
LISTS = ("points of a line",)  # in which a case says which entry is wrong


class Arrays(unittest.TestCase):
    def setUp(self):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", PendingDeprecationWarning)  # of numpy.matrix
        self.addCleanup(warnings.resetwarnings)

    def test_same_numbers_of_any_kind_are_the_same(self):
        for place, taken in PLACES.items():
            for kind, made in RIGHT.items():
                if "names" in kind and place == "coefficients":
                    continue
                with self.subTest(place=place, kind=kind):
                    values = value_of(place)
                    numpy.testing.assert_array_equal(taken(made(values)), values)

    def test_what_means_something_else_is_refused(self):
        for place, taken in PLACES.items():
            for kind, (made, said) in WRONG.items():
                if place in LISTS:
                    if kind == "empty":
                        continue  # the server knows how many a line needs
                    said = ""
                with self.subTest(place=place, kind=kind), self.assertRaisesRegex(anticrack.CaseError, said):
                    taken(made(value_of(place)))

    def test_taken_values_are_a_copy(self):
        for place in ("per node", "per triangle"):
            values = value_of(place).copy()
            found = PLACES[place](values)
            values[:] = 0
            self.assertEqual(found.tolist(), value_of(place).tolist())
            self.assertTrue(found.flags.c_contiguous and found.flags.aligned)


class Values(FolderTest):
    def taken(self, values, per="node"):
        return load_of(per)(values)[1].tolist()

    def test_load_takes_arrays_that_are_no_lists(self):
        for f in (numpy.arange(3), range(3), [0, 1, 2], Lazy([0, 1, 2]), array.array("b", [0, 1, 2]),
                  pandas.Series([0, 1, 2]), numpy.ma.arange(3)):
            case = Case(Geometry(SQUARE), [Load("a", f, per="node")])
            self.assertEqual(read(case).arrays()[0][1].tolist(), [0, 1, 2])
        case = Case(Geometry(SQUARE), [Load("a", numpy.array(3.5)), Load("b", numpy.float16(0.5)),
                                       Load("c", numpy.array(7, ">i2"))])
        self.assertEqual([load.force.constant for load in read(case).spec.load_cases], [3.5, 0.5, 7])

    def test_labels_that_say_another_order(self):
        shuffled = pandas.Series([1.0, 2, 3], index=[2, 0, 1])
        with self.assertRaisesRegex(anticrack.CaseError, "load.b.f.values: the index of a Series is not in the order"):
            self.taken(shuffled)
        self.assertEqual(self.taken(shuffled.sort_index()), [2, 3, 1])
        self.assertEqual(self.taken(shuffled.to_numpy()), [1, 2, 3])
        self.assertEqual(self.taken(pandas.Series([1, 2], index=[5, 9])), [1, 2])
        with self.assertRaisesRegex(anticrack.CaseError, "the columns of a DataFrame is not in the order of the mesh"):
            sweep(nodal_forces=pandas.DataFrame(ROWS, columns=[1, 0]))
        with self.assertRaisesRegex(anticrack.CaseError, "y before x"):
            points_of_interface(pandas.DataFrame(ROWS, columns=["y", "x"]))
        numpy.testing.assert_array_equal(points_of_msh(pandas.DataFrame(ROWS, columns=["x", "y"])), ROWS)

    def test_columns_of_coefficients_are_found_by_name(self):
        for names in (["1", "0"], [1, 0]):
            frame = pandas.DataFrame(ROWS[:, ::-1], columns=names, index=[7, 3, 5])  # rows are as they stand
            numpy.testing.assert_array_equal(sweep(coefficients=frame), ROWS)
            numpy.testing.assert_array_equal(sweep(coefficients=frame.astype("Int32")), ROWS)
        for names in (["0", "2"], ["0", "0"], pandas.MultiIndex.from_tuples([("0", "a"), ("1", "a")])):
            with self.assertRaisesRegex(anticrack.CaseError, "coefficients: columns .* are not the loads"):
                sweep(coefficients=pandas.DataFrame(ROWS, columns=names))

    def test_files_hold_any_kind_too(self):
        path = pathlib.Path(self.folder) / "f.h5"
        with h5py.File(path, "w") as file:
            file["right"] = ROWS.ravel().astype(">f4")
            file["whole"] = ROWS.ravel().astype("u2")
            file.create_group("group")
            for name, values in (("text", ["a", "b"]), ("one", 3.0), ("complex", ROWS.ravel() + 1j),
                                 ("flags", ROWS.ravel() > 2), ("table", ROWS), ("empty", ROWS[:0, 0]),
                                 ("records", records(ROWS)), ("nan", [1, numpy.nan])):
                file[name] = values
        mapped = numpy.memmap(pathlib.Path(self.folder) / "f.bin", ">f8", "w+", shape=(6,))
        mapped[:] = ROWS.ravel()
        self.assertEqual(self.taken(mapped), ROWS.ravel().tolist())

        def of(dataset):
            case = Case.parse(f"""
            geometry.boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
            [[load]]
            name = "a"
            f = {{file = "{path}", dataset = "/{dataset}", per = "triangle"}}""")
            return read(case).arrays()[0][1].tolist()
        for name in ("right", "whole"):
            self.assertEqual(of(name), ROWS.ravel().tolist())
        for name in ("text", "one", "complex", "flags", "table", "empty", "records", "nan", "group", "none"):
            said = r"^case:\d+: load.a.f.(dataset|file): "
            with self.subTest(name), self.assertRaisesRegex(anticrack.CaseError, said):
                of(name)


class Cells(unittest.TestCase):
    def lines(self, values):
        return [line.split()[5:] for line in Msh(numpy.vstack([ROWS, [[0, 1]]]), {"triangle": values}).to_bytes()
                .decode().split("$Elements\n")[1].splitlines()[1:3]]

    def test_of_whole_numbers(self):
        right = [["1", "2", "3"], ["1", "3", "4"]]
        cells = numpy.array([(0, 1, 2), (0, 2, 3)])
        for values in (cells, cells.astype(">u8"), cells.astype("i1"), numpy.asfortranarray(cells), cells.tolist(),
                       objects(cells), masked(cells), Lazy(cells), pandas.DataFrame(cells), strided(cells).astype(int)):
            self.assertEqual(self.lines(values), right)
        for values, said in ((cells.astype(float), "float64 holds no whole numbers; write .astype"),
                             (masked(cells, 1), "masked"), (cells > 0, "true and false"), (cells[:, :2], r"\(n, 3\)"),
                             (cells - 1, "name points that are not there"), (cells + 5, "name points"),
                             (cells.astype("u8") + 2**63, "name points"), (cells.astype("timedelta64[s]"), "times"),
                             (iter(cells), "only once"), (objects(cells, 0.5), "holds no whole numbers")):
            with self.assertRaisesRegex(anticrack.CaseError, f"cells 'triangle'.*{said}"):
                self.lines(values)
        self.assertIn(b"$Elements\n1\n", Msh(ROWS, {"triangle": [(0, 1, 2)], "line": numpy.empty((0, 2))}).to_bytes())

    def test_are_in_a_plane(self):
        flat, bent = numpy.c_[ROWS, [7, 7, 7]], numpy.c_[ROWS, [7, 7, 8]]
        numpy.testing.assert_array_equal(points_of_msh(flat), ROWS)
        with self.assertRaisesRegex(anticrack.CaseError, "points: z goes from 7 to 8; a sheet is flat"):
            points_of_msh(bent)

    def test_have_names_of_text(self):
        for names in (numpy.array(["top"]), pandas.Series(["top"]), ["top"], numpy.array(["top"], object)):
            self.assertIn(b'"top"', Msh(ROWS, {"triangle": [(0, 1, 2)]}, {"triangle": names}).to_bytes())
        for names in (numpy.array([b"top"]), [None], [7], [numpy.nan]):
            with self.assertRaisesRegex(anticrack.CaseError, "is not text"):
                Msh(ROWS, {"triangle": [(0, 1, 2)]}, {"triangle": names}).to_bytes()


class SmallOnes(unittest.TestCase):
    """Points, stretches, moments, rows: short, and in lists."""

    def test_points_and_parts(self):
        geometry = Geometry(
            numpy.array(SQUARE, ">f4"), [Interface([numpy.array([-1, 0]), Lazy([1, 0])])],
            [Inclusion("a", start=numpy.array([-0.5, 0]), end=pandas.Series([0.5, 0]),
                       delaminated=[numpy.array([0, 0.25]), Lazy([0.5, 1.0])]),
             Inclusion("b", center=numpy.float32([0, 0.5]), length=numpy.array(0.25), angle=numpy.int8(45),
                       delaminated=numpy.array([[0, 0.5]]), tilt=numpy.bool_(True))],
            regions=[Region("r", circle={"center": numpy.array([0, -0.5]), "radius": numpy.float16(0.25)},
                            tension=numpy.array(2))],
            neumann=[numpy.array([(1, -1), (1, 1)])])
        made = read(Case(geometry, [Load("a", point_forces=[(numpy.array([0.5, 0.5]), numpy.float32(2))],
                                    inclusion_moments={"b": numpy.array([1, 2])}, traction=numpy.array(1.5))],
                    Mesh(align=numpy.array([[(0, 0), (0, 1)]]), size=numpy.array([[0.5]])[0, 0])))
        shape, (load,) = made.mesh.geometry, made.spec.load_cases
        self.assertEqual([point.y for point in shape.boundary], [-1, -1, 1, 1])
        self.assertEqual([point.x for point in shape.interfaces[0].polyline.points], [-1, 1])
        self.assertEqual(shape.inclusions[0].part.to.x, 0.5)
        stretches = [getattr(part, "from") for part in shape.inclusions[0].delaminated_parts.stretches]
        self.assertEqual(stretches, [0, 0.5])
        self.assertEqual(shape.inclusions[1].delaminated_parts.stretches[0].to, 0.5)
        self.assertEqual((shape.inclusions[1].line.segment.length, shape.regions[0].tension), (0.25, 2))
        self.assertEqual(shape.neumann[0].to.y, 1)
        self.assertEqual((load.point_forces[0].value, load.inclusion_moments["b"].y, load.traction), (2, 2, "1.5"))
        self.assertEqual((made.mesh.options.align[0].points[1].y, made.mesh.options.size), (1, 0.5))

    def test_numbers_that_are_none(self):
        geometry = Geometry(SQUARE, inclusions=[Inclusion("b", points=[(0, 0), (1, 0)])], neumann="all")
        for f in (numpy.bool_(True), numpy.ma.masked, numpy.timedelta64(1, "s"), numpy.datetime64(1, "s"), 1j,
                  numpy.complex64(1), numpy.array(1j), numpy.float16("inf"), numpy.longdouble("1e400"), b"1",
                  numpy.array(True), numpy.array("1 +"), decimal.Decimal(1), numpy.array([(1, 2)], "i4,i4")[0],
                  numpy.array(1.0).view(Quantity)):
            for load in (Load("a", f), Load("a", 0, traction=f), Load("a", 0, inclusion_forces={"b": f}),
                         Load("a", 0, point_forces=[((0, f), 1)])):
                if isinstance(f, numpy.ndarray) and f.dtype.kind == "U" and not load.inclusion_forces:
                    continue  # an expression
                with self.subTest(f=f, load=load), self.assertRaises(anticrack.CaseError):
                    read(Case(geometry, [load]))

    def test_rows_whose_traces_are_kept(self):
        def kept(traces):
            spec = spec_of("0", "1")
            sweep_of(spec, ROWS, None, traces, False, False)
            return list(spec.sweep.traces)
        for rows in ([2, 0], (2, 0, 2), {2, 0}, range(0, 3, 2), numpy.array([2, 0], ">i2"), iter([0, 2]),
                     pandas.Series([2, 0]), [numpy.uint8(2), 0], numpy.arange(3)[::-2], Lazy([0, 2])):
            self.assertEqual(kept(rows), [0, 2])
        for rows in ([], (), numpy.array([]), range(0)):
            self.assertEqual(kept(rows), [])
        for rows, said in (([0.5], "no whole numbers"), ([True, False, True], "true and false"), ("02", "not a list"),
                           (numpy.array([True, False]), "true and false"), ([3], "3 is no row; there are 3"),
                           ([-1], "-1 is no row"), (1, "not a list"), ([[0]], "shape"), ([None], "not a number"),
                           (masked(numpy.arange(2), 1), "masked"), ([10**30], "no whole numbers|is no row")):
            with self.assertRaisesRegex(anticrack.CaseError, f"traces: .*({said})"):
                kept(rows)
