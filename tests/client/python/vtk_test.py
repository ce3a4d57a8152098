# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of `anticrack export`: what they hold, by a reader that goes by their XML and the lengths of arrays."""
import copy
import os
import pathlib
import struct
import unittest
from xml.etree import ElementTree

import numpy

import anticrack
from anticrack import output, vtk
from processes import ANTICRACKD, FolderTest

EXAMPLES = pathlib.Path(os.environ["EXAMPLES"])
TYPES = {"Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1"}


class Vtu:
    """A .vtu file: arrays and their units by name, which must fill the raw data without a gap."""

    def __init__(self, path):
        head, _, raw = path.read_bytes().partition(b'<AppendedData encoding="raw">\n_')
        raw = raw.removesuffix(b"\n  </AppendedData>\n</VTKFile>\n")
        xml = ElementTree.fromstring(head + b"</VTKFile>")
        assert (xml.get("byte_order"), xml.get("header_type")) == ("LittleEndian", "UInt64")
        piece = xml.find("UnstructuredGrid/Piece")
        counts = {"PointData": int(piece.get("NumberOfPoints")), "CellData": int(piece.get("NumberOfCells"))}
        self.arrays, self.units, end = {}, {}, 0
        for section in piece:
            for array in section:
                name, at, kind = array.get("Name"), int(array.get("offset")), numpy.dtype(TYPES[array.get("type")])
                length, = struct.unpack_from("<Q", raw, at)
                values = numpy.frombuffer(raw, kind, length // kind.itemsize, at + 8)
                width = int(array.get("NumberOfComponents"))
                self.arrays[name] = values.reshape(-1, width) if width > 1 else values
                self.units[name] = array.findtext("InformationKey", "")
                assert at == end and len(values) == counts.get(section.tag, len(values)), name
                end = at + 8 + length
        assert end == len(raw) and len(self["Points"]) == counts["PointData"]
        width = len(self["connectivity"]) // counts["CellData"]
        numpy.testing.assert_array_equal(self["offsets"], width * numpy.arange(1, counts["CellData"] + 1))
        self.corners = self["connectivity"].reshape(-1, width)

    def __getitem__(self, name):
        return self.arrays[name]


class Exports(FolderTest):
    @classmethod
    def setUpClass(cls):
        with anticrack.local(program=ANTICRACKD) as client:
            case = anticrack.Case.read(EXAMPLES / "several-inclusions.toml")
            case.tables["output"] = {"fields": True}
            cls.several = client.run(case, progress=False)
            cls.slit = client.run(EXAMPLES / "slit.toml", progress=False)
            cls.sweep = client.run(EXAMPLES / "load-ratio.toml", numpy.eye(2), traces=[1], progress=False)

    def export(self, result, *names):
        self.made = vtk.export(result, "result.h5", str(self.folder / "new"), names)
        self.assertEqual(sorted(self.made.files), sorted(map(str, (self.folder / "new").iterdir())))
        return [pathlib.Path(file).name for file in self.made.files]

    def read(self, name):
        return Vtu(self.folder / "new" / name)

    def test_two_files_a_load_and_their_collection(self):
        files = self.export(self.several)
        self.assertEqual(files, ["opening.vtu", "opening-interfaces.vtu", "pulled.vtu", "pulled-interfaces.vtu",
                                 "result.pvd"])
        members = ElementTree.parse(self.folder / "new" / "result.pvd").findall("Collection/DataSet")
        self.assertEqual([member.get("file") for member in members], files[:-1])
        self.assertEqual([member.get("timestep") for member in members], ["0", "0", "1", "1"])
        self.assertEqual(ElementTree.fromstring(vtk.pvd([('"a" <b> & c', "a.vtu", 3, 1)])).find(
            "Collection/DataSet").attrib, {"timestep": "3", "part": "1", "name": '"a" <b> & c', "file": "a.vtu"})

    def test_membrane_keeps_both_faces(self):
        for result, name in ((self.several, "pulled"), (self.slit, next(iter(self.slit.loads)))):
            self.export(result, name)
            seen, fields, mesh = self.read(f"{name}.vtu"), result[name].fields, result.mesh
            numpy.testing.assert_array_equal(seen["Points"][:, :2], mesh.nodes[seen["node"]])
            numpy.testing.assert_array_equal(seen["Points"][:, 2], 0)
            numpy.testing.assert_array_equal(seen["u"], numpy.concatenate([part.u for part in fields]))
            numpy.testing.assert_array_equal(seen["node"][seen.corners],
                                             numpy.concatenate([part.nodes[part.triangles] for part in fields]))
            numpy.testing.assert_array_equal(seen["u"][seen.corners],
                                             numpy.concatenate([part.u[part.triangles] for part in fields]))
            numpy.testing.assert_array_equal(seen["tension"], mesh.tension[seen["subdomain"]])
            self.assertEqual(list(numpy.bincount(seen["subdomain"])), [len(part.triangles) for part in fields])
            self.assertEqual(set(seen["types"]), {5})
            self.assertGreater(len(seen["node"]), len(mesh.nodes))
            for path in (self.folder / "new").iterdir():
                path.unlink()

    def test_each_triangle_has_its_error_indicator(self):
        result = copy.deepcopy(self.several)
        for part in result["pulled"].fields:  # a field may have its triangles in any order, each from any corner
            part.triangles = numpy.roll(part.triangles[::-1], 1, axis=1)
        result["opening"].indicator = None
        self.export(result)
        self.assertNotIn("error_indicator", self.read("opening.vtu").arrays)
        seen = self.read("pulled.vtu")
        known = dict(zip(map(frozenset, result.mesh.triangles.tolist()), result["pulled"].indicator))
        self.assertEqual(list(seen["error_indicator"]),
                         [known[frozenset(corners)] for corners in seen["node"][seen.corners].tolist()])

    def test_interfaces_are_lines_that_nothing_joins(self):
        self.export(self.several)
        seen, load, lines = self.read("opening-interfaces.vtu"), self.several["opening"], self.several.interfaces
        self.assertGreater(len(lines), 1)
        for name in ("u_minus", "u_plus", "jump", "pressure", "contact"):
            numpy.testing.assert_array_equal(seen[name], numpy.concatenate([getattr(at, name) for at in load.traces]))
        for name in ("s", "kind"):
            numpy.testing.assert_array_equal(seen[name], numpy.concatenate([getattr(line, name) for line in lines]))
        numpy.testing.assert_array_equal(seen["inclusion"], numpy.concatenate([line.edge_inclusion for line in lines]))
        first = numpy.cumsum([0, *(len(line.s) for line in lines)])[seen["interface"]]
        last = first + numpy.array([len(line.s) for line in lines])[seen["interface"]]
        self.assertTrue(((first <= seen.corners[:, 0]) & (seen.corners[:, 1] < last)).all())
        numpy.testing.assert_allclose(numpy.diff(seen["s"][seen.corners])[:, 0], numpy.linalg.norm(
            numpy.diff(seen["Points"][seen.corners], axis=1)[:, 0], axis=1), atol=1e-15)
        self.assertEqual(set(seen["types"]), {3})

    def test_units(self):
        result = copy.deepcopy(self.several)
        result.units = anticrack.result.Units("<mm>", "N")
        self.export(result)
        units = self.read("opening.vtu").units
        self.assertEqual((units["u"], units["tension"], units["error_indicator"], units["node"]),
                         ("<mm>", "N/<mm>", "N <mm>", ""))
        self.assertEqual(self.read("opening-interfaces.vtu").units["pressure"], "N/<mm>")

    def test_of_a_sweep_are_the_traces_it_kept(self):
        self.assertEqual(self.export(self.sweep, "row-1"), ["row-1-interfaces.vtu", "result.pvd"])
        with self.assertRaisesRegex(anticrack.Error, "there is no load row-2; did you mean row-1"):
            self.export(self.sweep, "row-2")
        bare = copy.deepcopy(self.sweep)
        bare.loads.clear()
        with self.assertRaisesRegex(anticrack.Error, "result.h5: no load has an answer to export; keep the traces"):
            self.export(bare)

    def test_what_is_missing_is_told(self):
        result = copy.deepcopy(self.several)
        result["opening"].fields.clear()
        with self.assertRaisesRegex(anticrack.Error, 'result.h5: load "opening": the result has no fields: .*anticrack '
                                    f"job fetch {result.job} --fields -o .*fields = true"):
            self.export(result)
        self.assertFalse((self.folder / "new").exists())
        result["opening"].traces.clear()
        result["opening"].status = "failed"
        self.assertEqual(self.export(result), ["pulled.vtu", "pulled-interfaces.vtu", "result.pvd"])
        self.assertEqual(self.made.notes, ['load "opening" has no answer (failed): nothing to export'])
        del result.loads["pulled"]
        with self.assertRaisesRegex(anticrack.Error, "no load has an answer to export; solve the case first"):
            self.export(result)
        (self.folder / "file").touch()
        with self.assertRaisesRegex(anticrack.Error, "cannot be made a folder"):
            vtk.export(self.several, "result.h5", str(self.folder / "file" / "a"))

    def test_names_of_files_are_unique_and_safe(self):
        self.assertEqual(output.stems(["opening", "partly closed", "partly_closed", "PARTLY_CLOSED"], []),
                         ["opening", "partly_closed", "partly_closed-2", "PARTLY_CLOSED-3"])
        self.assertEqual(output.stems(["../etc/passwd", "-rf", "", "a'b|c"], []),
                         ["load.._etc_passwd", "load-rf", "load", "a_b_c"])
        self.assertEqual(output.stems(["a", "a-traces"], ["-traces"]), ["a", "a-traces-2"])
        self.assertEqual(output.stems(["a-traces", "a"], ["-traces"]), ["a-traces", "a-2"])


if __name__ == "__main__":
    unittest.main()
