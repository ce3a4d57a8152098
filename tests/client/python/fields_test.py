# SPDX-License-Identifier: GPL-3.0-or-later
"""Forces on the boundary, probes, fluxes and nodal forces, from the server to files and back."""
import csv
import os
import unittest

import numpy

import anticrack
from anticrack import vtk
from anticrack.draw.files import Wanted, draw_figures
from anticrack.draw.sheet import Look
from processes import ANTICRACKD, FolderTest


def case(**output):
    sides = [{"name": "south", "points": [[-1, -1], [1, -1]]}, {"points": [[1, -1], [1, 1]]},
             {"points": [[1, 1], [-1, 1]]}, {"name": "west", "points": [[-1, 1], [-1, -1]]}]
    fibre = {"name": "fibre", "from": [-0.5, 0], "to": [0.5, 0], "delaminated": True}
    built = anticrack.Case()
    built.tables = {
        "geometry": {"boundary": sides, "interface": [{"points": [[-1, 0], [1, 0]]}], "inclusion": [fibre],
                     "hole": [{"circle": {"center": [0.4, 0.6], "radius": 0.2}}], "neumann": ["west"],
                     "region": [{"name": "upper", "at": [0, 0.2],
                                 "tension": {"along": "1 + x*x", "across": "2", "angle": 30}}]},
        "mesh": {"size": 0.1, "preset": "uniform"},
        "load": [{"name": "held", "boundary_value": "x*y + 0.3*x"},
                 {"name": "pulled", "f": "1 + x", "traction": "y", "inclusion_forces": {"fibre": -0.5}}],
        "output": {"fields": True, **output}}
    return built


PROBES = [{"at": [0.3, -0.4]}, {"name": "along", "from": [-0.9, 0], "to": [0.9, 0], "points": 7},
          {"name": "edge", "from": [1, -1], "to": [1, 1], "points": 2}]


class Fields(FolderTest):
    @classmethod
    def setUpClass(cls):
        with anticrack.local(program=ANTICRACKD) as client:
            cls.result = client.run(case(probe=PROBES, balanced_flux=True), progress=False)

    def test_the_balanced_flux_balances(self):
        mesh = self.result.mesh
        corners = mesh.nodes[mesh.triangles]
        a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        areas = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
        for name, force in (("held", 0 * areas), ("pulled", areas * (1 + corners[:, :, 0].mean(axis=1)))):
            load = self.result[name]
            flux = load.balanced_flux
            numpy.testing.assert_allclose(flux.sum(axis=1), -force, rtol=0, atol=1e-10 * abs(flux).max())
            # near T grad u: their distance is what bounds the error
            parts = [(part.nodes[part.triangles], part.flux, part.areas) for part in load.fields]
            for triangles, slopes, part_areas in parts:
                means = vtk.of_triangles(mesh, mesh.mean_flux(flux), triangles)
                apart, size = ((part_areas * (values**2).sum(axis=1)).sum() for values in (means - slopes, slopes))
                self.assertLess(apart, 0.1 * size)
                self.assertGreater(apart, 0)

    def test_forces_balance_the_load(self):
        for name, applied in (("held", 0.0), ("pulled", None)):
            load = self.result[name]
            self.assertEqual([(part.name, part.free) for part in load.boundary],
                             [("south", 0), ("side-2", 0), ("side-3", 0), ("west", 1), ("hole-1", 0)])
            if applied is None:  # int (1 + x) of the mesh, whose hole is a polygon
                nodes = self.result.mesh.nodes
                corners = numpy.concatenate([nodes[part.nodes[part.triangles]] for part in load.fields])
                areas = numpy.concatenate([part.areas for part in load.fields])
                applied = (areas * (1 + corners[:, :, 0].mean(axis=1))).sum()
            forces = [part.resultant for part in [*load.boundary, *load.inclusions.values()]] + [applied]
            self.assertLess(abs(sum(forces)), 1e-10 * sum(map(abs, forces)))
        self.assertAlmostEqual(self.result["pulled"].boundary[3].resultant, 0, delta=1e-12)  # int y
        self.assertAlmostEqual(self.result["pulled"].boundary[3].My, 2 / 3, delta=1e-12)

    def test_energy_is_that_of_its_density(self):
        load = self.result["held"]  # has no load, so that all energy is strain
        energy = sum((part.areas * part.energy_density).sum() for part in load.fields)
        self.assertAlmostEqual(energy, load.energy_mesh, delta=1e-9 * abs(load.energy_mesh))
        wrong = 0.0  # with the mean of T
        for part, tension in zip(load.fields, self.result.mesh.tension):
            wrong += (part.areas * tension * (part.slopes**2).sum(axis=1)).sum() / 2
        self.assertGreater(abs(wrong - load.energy_mesh), 1e-3 * load.energy_mesh)

    def test_probes_have_u_of_both_sides(self):
        for load in self.result.loads.values():
            self.assertEqual({name: len(of["s"]) for name, of in load.probes.items()},
                             {"probe-1": 1, "along": 7, "edge": 2})
            along, line, trace = load.probes["along"], self.result.interfaces[0], load.traces[0]
            for side in ("u_minus", "u_plus"):
                numpy.testing.assert_allclose(along[side], numpy.interp(along["x"], line.x, getattr(trace, side)),
                                              rtol=0, atol=1e-12)
            numpy.testing.assert_allclose(along["s"], along["x"] + 0.9, atol=1e-15)
        edge = self.result["held"].probes["edge"]
        numpy.testing.assert_allclose(edge["u_plus"], edge["x"] * edge["y"] + 0.3 * edge["x"], atol=1e-14)

    def test_pressure_is_of_contacts_alone(self):
        line = self.result.interfaces[0]
        contact = numpy.isin(line.kind, (anticrack.result.CRACK, anticrack.result.DELAMINATED))
        for load in self.result.loads.values():
            trace = load.traces[0]
            self.assertTrue((trace.pressure[~contact] == 0).all() and (trace.flux[contact] == 0).all())
            self.assertTrue((trace.flux[~contact] != 0).any())
            values, lengths = trace.pressure + trace.flux, (line.s[2:] - line.s[:-2]) / 2
            inner = numpy.flatnonzero(values[1:-1]) + 1
            numpy.testing.assert_allclose(trace.force[inner], values[inner] * lengths[inner - 1], rtol=1e-11)

    def test_files_keep_all_of_it(self):
        path = self.folder / "result.h5"
        self.result.save(path)
        read = anticrack.read(path)
        for load in self.result.loads.values():
            again = read[load.name]
            self.assertEqual(again.boundary, load.boundary)
            self.assertEqual(again.probe_points, load.probe_points)
            for part, other in zip(load.fields, again.fields):
                numpy.testing.assert_array_equal(part.flux, other.flux)
            numpy.testing.assert_array_equal(load.traces[0].force, again.traces[0].force)
            numpy.testing.assert_array_equal(load.balanced_flux, again.balanced_flux)
        made = vtk.export(read, "result.h5", str(self.folder / "new"), ["held"])
        membrane = next(file for file in made.files if file.endswith("held.vtu"))
        with open(membrane, "rb") as file:
            self.assertIn(b'"balanced_flux_x"', file.read())
        with open(next(file for file in made.files if file.endswith("held-probes.csv")), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([float(row["u_minus"]) for row in rows],
                         [point.u_minus for point in read["held"].probe_points])

    def test_membranes_of_growth_are_those_of_their_rows(self):
        built = anticrack.Case()
        built.tables = {
            "geometry": {"boundary": [[-1, -1], [1, -1], [1, 1], [-1, 1]],
                         "inclusion": [{"name": "fibre", "points": [[-0.5, 0], [0.5, 0]], "delaminated": True}]},
            "mesh": {"size": 0.05},
            "growth": {"positions": 20,
                       "path": [{"interface": "fibre", "from": [-0.5, 0], "to": [0, 0], "Gc": "0.1"}]},
            "load": [{"name": "up", "f": "y > 0 ? 1 : -1"}], "output": {"fields": True}}
        with anticrack.local(program=ANTICRACKD) as client:
            result = client.run(built, progress=False)
        path = self.folder / "growth.h5"
        result.save(path)
        for load in (result["up"], anticrack.read(path)["up"]):
            rows = [int(row) for row in load.membrane_rows]
            self.assertEqual(rows, sorted({0, *rows}))
            self.assertGreater(len(rows), 1)
            for row in rows:
                grown = load.grown(row)
                u = numpy.concatenate([part.u for part in grown.fields])
                self.assertLess(abs(u - load.growth["displacement"][row]).min(), 1e-9)  # on the side that holds
                self.assertGreater(min(part.energy_density.max() for part in grown.fields), 0)
            with self.assertRaisesRegex(anticrack.Error, "row 1000 of growth is not kept; those of rows 0, "):
                load.grown(1000)
        made = draw_figures(result, str(self.folder / "figures"), Wanted(["growth"]), Look(["png"], 50))
        self.assertLessEqual({f"up-growth-{row}.png" for row in rows}, {os.path.basename(name) for name in made.files})

    def test_what_is_wrong_is_told(self):
        with anticrack.local(program=ANTICRACKD) as client:
            for probe, said in (({"at": [2, 0]}, "outside the membrane"), ({"at": [0.4, 0.6]}, "outside the membrane"),
                                ({"from": [0, 0], "to": [0, 0], "points": 3}, "ends where it begins"),
                                ({"from": [0, 0], "to": [1, 0], "points": 5000}, "may have 1000"),
                                ({"from": [0, 0], "to": [1, 0], "points": 1}, "at least 2"),
                                ({"at": [float("nan"), 0]}, "at"), ({"at": [0, 0], "points": 3}, "neither")):
                with self.assertRaisesRegex(anticrack.Error, said):
                    client.run(case(probe=[probe]), progress=False)


if __name__ == "__main__":
    unittest.main()
