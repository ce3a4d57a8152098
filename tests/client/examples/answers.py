# SPDX-License-Identifier: GPL-3.0-or-later
"""The answers of a result file, and what its fields say of them."""
import json

import h5py
import numpy

from processes import ANTICRACK, run


class Answers:
    """The answers of a result file, as `show --json` tells them, and its fields."""

    def __init__(self, path):
        shown = run(ANTICRACK, "--json", "show", path)
        assert shown.returncode == 0, shown.stderr
        self.loads = {answer["name"]: answer for answer in json.loads(shown.stdout)["answers"]}
        self.file = h5py.File(path)

    def told(self, load, inclusion=0):
        """A as the table has it: the middle of its bounds, or without bounds that of the mesh."""
        return self.loads[load]["inclusions"][inclusion]["A"]

    def told_energy(self, load):
        return self.loads[load]["energy"]

    def displacement(self, load, inclusion=0):
        """A on the mesh."""
        return self.loads[load]["inclusions"][inclusion]["A_mesh"]

    def traces(self, load, interface=0):
        """x and y of the nodes of an interface, u on its faces and so on, by name."""
        return {name: values[:] for group in (f"interfaces/{interface}", f"loads/{load}/traces/{interface}")
                for name, values in self.file[group].items()}

    def opens(self, load, interface=0):
        """By how much at most, and at which x."""
        traces = self.traces(load, interface)
        at = int(numpy.argmax(traces["jump"]))
        return traces["jump"][at], traces["x"][at]

    def fields(self, load):
        """Of each subdomain: name, tension, points, values on them and triangles."""
        mesh = self.file["mesh"]
        for index, part in enumerate(mesh["subdomains"][()]):
            field = self.file[f"loads/{load}/fields/{index}"]
            yield (part["name"].decode(), part["tension"], mesh["nodes"][:][field["nodes"][:]], field["u"][:],
                   field["triangles"][:])

    def strain_energy(self, load):
        """Half the integral of T |grad u|^2, from the field."""
        return sum(tension * 0.25 * float(numpy.sum(
            numpy.sum((u[triangles][:, :, None] * opposite(points[triangles])).sum(axis=1) ** 2, axis=1)
            / doubled_areas(points[triangles])))
                   for _, tension, points, u, triangles in self.fields(load))

    def integral(self, load, subdomain):
        """Of u over a subdomain."""
        return sum(float(numpy.sum(doubled_areas(points[triangles]) / 6 * u[triangles].sum(axis=1)))
                   for name, _, points, u, triangles in self.fields(load) if name == subdomain)


def opposite(corners):
    """The edges opposite to the corners of triangles: gradients of u turned by a quarter, times twice the area."""
    return numpy.roll(corners, -2, axis=1) - numpy.roll(corners, -1, axis=1)


def doubled_areas(corners):
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return numpy.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
