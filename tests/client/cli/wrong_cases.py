# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong cases: what is changed in a good one, the exit code of `anticrack run`, and all that is
said of it. jobs/ID and meshes/ID stand for what differs from run to run."""

GOOD = """\
title = "Plate"

[geometry]
boundary = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
interface = [[-1, 0], [1, 0]]

[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to = [0.5, 0]
delaminated = true

[mesh]
preset = "uniform"
size = 0.5

[solver]
method = "uzawa"
theta = 1.5

[[load]]
name = "opening"
f = "y > 0 ? 1 : -1"
"""

GEOMETRY = GOOD[GOOD.index("[geometry]"):GOOD.index("[mesh]")]
F = 'f = "y > 0 ? 1 : -1"'


def more(text):
    """Put before [mesh]."""
    return [("[mesh]", text + "\n\n[mesh]")]


# ([(old, new), ...] in GOOD, exit code, what is said)
CASES = [
    # What TOML does not allow.
    ([("size = 0.5", "size = = 0.5")], 2,
     "wrong.toml:15: column 8: this is not TOML: Error while parsing value: could not determine value "
     "type; a value is a number as 3.5, true, false, a text in quotes or a list; units are named in [units]; the line "
     "is: size = = 0.5"),
    ([('"Plate"', '"Plate')], 2,
     "wrong.toml:1: column 15: this is not TOML: Error while parsing string: unescaped control "
     'characters other than TAB (U+0009) are explicitly prohibited; a value is a number as 3.5, true, false, '
     'a text in quotes or a list; units are named in [units]; the line is: title = "Plate'),
    ([("size = 0.5", "size = 0.5\nsize = 1")], 2,
     "wrong.toml:16: column 8: this is not TOML: Error while parsing key-value pair: cannot redefine "
     "existing floating-point 'size'; the line is: size = 1"),
    ([("[mesh]", "[mesh")], 2,
     "wrong.toml:13: column 6: this is not TOML: Error while parsing table header: expected ']', saw "
     "'\\n'; the line is: [mesh"),
    # Keys.
    ([("theta", "thetta")], 2,
     "wrong.toml:19: solver.thetta: unknown key; did you mean theta?"),
    ([("[solver]", "[solvr]")], 2,
     "wrong.toml:17: solvr: unknown key; did you mean solver?"),
    ([("delaminated", "delaminatd")], 2,
     "wrong.toml:11: geometry.inclusion.fibre.delaminatd: unknown key; did you mean delaminated?"),
    ([("theta = 1.5", "max_steps = 4")], 2,
     'wrong.toml:19: solver.max_steps: belongs to method "active-set"; remove it, or write method = '
     '"active-set"'),
    ([('"uzawa"', '"active-set"')], 2,
     'wrong.toml:19: solver.theta: belongs to method "uzawa"; remove it, or write method = "uzawa"'),
    ([('"uniform"', '"paper"')], 2,
     "wrong.toml:15: mesh.size: means nothing with preset paper, which fixes the intervals; leave it out, or choose "
     "preset graded"),
    ([("size = 0.5", "tip_size = 0.1")], 2,
     "wrong.toml:15: mesh.tip_size: means nothing without preset graded; leave it out, or choose that"),
    ([("size = 0.5", "grading = 0.5")], 2,
     "wrong.toml:15: mesh.grading: means nothing without preset graded; leave it out, or choose that"),
    ([('"uniform"', '"paper"'), ("size = 0.5", "align = [[[0, 0.5], [0.5, 0.5]]]")], 2,
     "wrong.toml:15: mesh.align: preset paper has no lines to follow; leave them out, or choose preset graded"),
    (more('[mesh.groups]\ncurve.7 = "crack"'), 2,
     "wrong.toml:14: mesh.groups.curve: belongs to a mesh from a file; say in the geometry where inclusions and cracks "
     "lie"),
    (more("[mesh.tension]\ntop = 2"), 2,
     "wrong.toml:13: mesh.tension: belongs to a mesh from a file; give tensions in the regions of the geometry"),
    ([('[[load]]\nname = "opening"\n' + F + "\n", "")], 2,
     "wrong.toml: load: missing; write [[load]] with name and f for each load case"),
    ([(GEOMETRY, "")], 2,
     "wrong.toml: geometry: missing; write [geometry] with boundary and interface, or mesh.file = "
     '"x.msh"'),
    ([("size = 0.5", 'file = "x.msh"')], 2,
     "wrong.toml:3: geometry: there is a mesh.file too; remove one of the two"),
    ([("size = 0.5", 'file = "x.msh"'), (GEOMETRY, "")], 2,
     "wrong.toml:5: mesh.file: x.msh: there is no such file; name a .msh file"),
    (more("[accuracy]\nenergy = 1e-3"), 2,
     "wrong.toml:21: solver.method: an accuracy needs bounds, which Algorithm 2 (uzawa) does not have: use the active "
     "set"),
    ([('method = "uzawa"\ntheta = 1.5\n', ""), *more("[output]\nbounds = false\n[accuracy]\nA = 1e-3")], 2,
     "wrong.toml:14: output.bounds: an accuracy needs bounds: leave one of the two out"),
    ([('method = "uzawa"\ntheta = 1.5\n', ""), *more("[accuracy]\nenergy = 1e-3\nlargest = true")], 2,
     "wrong.toml:15: accuracy.largest: is about A (displacement): give that with it"),
    (more('[units]\nlength = "millimetres of mercury"'), 2,
     "wrong.toml:14: units.length: not the name of a unit: use at most 16 bytes without control characters, as mm"),
    (more("[units]\nforce = 1"), 2, "wrong.toml:14: units.force: 1 is not text; write it in quotes"),
    (more("[accuracy]\nenrgy = 1e-3"), 2,
     "wrong.toml:14: accuracy.enrgy: unknown key; did you mean energy?"),
    (more("[accuracy]\ntime = 60"), 2,
     "wrong.toml:13: accuracy: no accuracy is asked for: give energy = 1e-3, A = 1e-3 (displacement), or both; or "
     "A_estimated = 1e-3 (displacement_estimated), without a proof"),
    (more("[accuracy]\nA = 2"), 2,
     "wrong.toml:14: accuracy.A: 2 is not an accuracy: give a relative error from 1e-6 to 1"),
    # Types and values.
    ([("size = 0.5", 'size = "fine"')], 2,
     "wrong.toml:15: mesh.size: 'fine' is not a finite number; write a number without quotes"),
    ([("size = 0.5", "size = nan")], 2,
     "wrong.toml:15: mesh.size: nan is not a finite number; write a finite number"),
    ([("size = 0.5", "size = -1")], 2,
     "wrong.toml:15: mesh.size: -1 is not above 0; write a number above 0, or leave the key out for "
     "its default"),
    ([("size = 0.5", "size = 1e-6")], 2,
     "wrong.toml:15: mesh.size: an edge length of 1e-06 gives about 9.2376043e+12 triangles; at most "
     "4000000 are allowed, so choose a coarser mesh (larger size or tip_size)"),
    ([("1.5", "0")], 2,
     "wrong.toml:19: solver.theta: theta is 0; it must be a finite number above 0, or auto"),
    ([("1.5", "-2")], 2,
     "wrong.toml:19: solver.theta: theta is -2; it must be a finite number above 0, or auto"),
    ([("1.5", '"automatic"')], 2,
     "wrong.toml:19: solver.theta: 'automatic' is not a finite number; write a number above 0, or \"auto\""),
    ([("theta = 1.5", "p = -1")], 2,
     "wrong.toml:19: solver.p: p is -1; it must be finite and not negative"),
    ([("theta = 1.5", "epsilon = 0")], 2,
     "wrong.toml:19: solver.epsilon: epsilon is 0; it must be a finite number above 0"),
    ([("theta = 1.5", "kkt_tolerance = 0")], 2,
     "wrong.toml:19: solver.kkt_tolerance: kkt_tolerance is 0; it must be a finite number above 0"),
    ([("theta = 1.5", "max_iterations = 0")], 2,
     "wrong.toml:19: solver.max_iterations: 0 is not a count; write a whole number from 1 to 2147483647"),
    ([("theta = 1.5", "max_iterations = 2000000000")], 2,
     "wrong.toml:19: solver.max_iterations: max_iterations is 2000000000; it must be from 1 to 1000000"),
    ([('"uzawa"', '"usawa"')], 2,
     "wrong.toml:18: solver.method: 'usawa' is not possible; did you mean uzawa?"),
    ([('"uniform"', '"unifrom"')], 2,
     "wrong.toml:14: mesh.preset: 'unifrom' is not possible; did you mean uniform?"),
    ([('"Plate"', "3")], 2,
     "wrong.toml:1: title: 3 is not text; write it in quotes"),
    (more('[job]\npriority = "fast"'), 2,
     "wrong.toml:14: job.priority: 'fast' is not possible; known are bulk, interactive, normal"),
    (more('[job]\nrun_timeout = "soon"'), 2,
     "wrong.toml:14: job.run_timeout: 'soon' is not a time above 0; write seconds, or \"90s\", \"10min\", "
     '"2h", "1d"'),
    (more('[output]\nfields = "yes"'), 2,
     "wrong.toml:14: output.fields: 'yes' is neither true nor false"),
    # The geometry.
    ([("[1, 1], [-1, 1]", "[-1, 1], [1, 1]")], 2,
     "wrong.toml:4: geometry.boundary: boundary crosses or touches itself: the edge from boundary[1] "
     "to boundary[2] (1, -1)-(-1, 1) meets the edge from boundary[3] to boundary[0] (1, 1)-(-1, -1)"),
    ([("[1, -1], [1, 1], [-1, 1]]", "[1, -1]]")], 2,
     "wrong.toml:4: geometry.boundary: boundary has 2 vertices; a polygon takes at least 3"),
    ([("[[-1, -1], [1", "[[-1, -1, 0], [1")], 2,
     "wrong.toml:4: geometry.boundary.0: [ -1, -1, 0 ] is not a point; write [x, y]"),
    ([("[[-1, 0], [1, 0]]", "[[-2, 0], [1, 0]]")], 2,
     "wrong.toml:5: geometry.interface: the interface leaves the membrane or touches its "
     "boundary in between: the stretch from (-2, 0) to (1, 0) meets the edge (-1, 1)-(-1, -1) of boundary; "
     "only its two ends may lie on the boundary"),
    ([("from = [-0.5, 0]", "from = [-0.5, 0.1]")], 2,
     'wrong.toml:9: geometry.inclusion.fibre.from: inclusion "fibre": from (-0.5, 0.1) lies 0.1 off the '
     "interface; it must lie on it, to 2.8284271e-06; nearest is (-0.5, 0); or give it a line of "
     "its own in place of from and to: points, arc, spline, or center, angle and length"),
    ([("[1, 0]]\n", '[1, 0]]\nneumann = ["left"]\n')], 2,
     'wrong.toml:6: geometry.neumann.0: neumann names no side or hole: "left"; there are side-1, side-2, '
     "side-3, side-4"),
    ([("[1, 0]]\n", "[1, 0]]\nneumann = [[[-1, -1], [-1, 1]]]\n")], 2,
     "wrong.toml:6: geometry.neumann.0: neumann[0] from (-1, -1) to (-1, 1), walked counterclockwise, is all of the "
     "boundary but the straight side between them; for that side write its name, \"side-4\", or [(-1, 1), (-1, -1)], "
     "for the others their names"),
    ([("to = [0.5, 0]", "to = [-0.5, 0]")], 2,
     'wrong.toml:9: geometry.inclusion.fibre.from: inclusion "fibre" has no length: it runs from (-0.5, '
     "0) to (-0.5, 0)"),
    (more('[[geometry.inclusion]]\nname = "fibre"\nfrom = [0.6, 0]\nto = [0.7, 0]'), 2,
     'wrong.toml:14: geometry.inclusion.fibre.name: inclusions[1].name "fibre" is already the name of '
     "inclusions[0]; every inclusion and crack needs its own"),
    (more('[[geometry.crack]]\nname = "c"\nfrom = [0.4, 0]\nto = [0.7, 0]'), 2,
     'wrong.toml:15: geometry.crack.c.from: crack "c" and inclusion "fibre" overlap from (0.4, 0) on; a '
     "piece of the interface belongs to one inclusion or crack"),
    (more('[[geometry.region]]\nname = "top"\nat = [0, 0]'), 2,
     'wrong.toml:15: geometry.region.top.at: region "top": at (0, 0) lies on the interface; it '
     "must lie inside the subdomain it names"),
    (more('[[geometry.region]]\nname = "top"\nat = [0, 0.5]\ntension = -1'), 2,
     "wrong.toml:16: geometry.region.top.tension: -1 is not above 0; write a number above 0, or leave "
     "the key out for its default"),
    ([("delaminated = true", "contact = false")], 2,
     "wrong.toml:11: geometry.inclusion.fibre.contact: belongs to [[geometry.crack]]; an inclusion has delaminated "
     "= true or false"),
    (more('[[geometry.crack]]\nname = "c"\nfrom = [0.6, 0]\nto = [0.7, 0]\ntilt = true'), 2,
     "wrong.toml:17: geometry.crack.c.tilt: belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so "
     "remove it"),
    ([("delaminated = true", "fixed = nan")], 2,
     "wrong.toml:11: geometry.inclusion.fibre.fixed: nan is not a finite number; write a finite number"),
    ([("delaminated = true", "tilt = true\nfixed = 0.1")], 2,
     'wrong.toml:12: geometry.inclusion.fibre.fixed: inclusion "fibre": it is fixed at 0.1 and tilts; an inclusion that '
     "is held does not tilt, so leave one of the two out"),
    (more("[mesh.inclusions]\nfibre = { tilt = true }"), 2,
     "wrong.toml:13: mesh.inclusions: belongs to a mesh from a file; say tilt or fixed in the inclusions of the "
     "geometry"),
    ([("[1, 0]]\n", '[1, 0]]\nneumann = "left"\n')], 2,
     "wrong.toml:6: geometry.neumann: 'left' is not possible; write a list of names of sides and holes, or of "
     '[from, to], parts of the boundary walked counterclockwise, or "all"'),
    ([("[1, 0]]\n", '[1, 0]]\nneumann = "all"\n')], 2,
     "wrong.toml:6: geometry.neumann: all of the boundary is in neumann, so nothing holds the membrane and it "
     "could move as a whole; leave a side or a hole out of neumann, or hold an inclusion, as by fixed = 0"),
    ([("interface = [[-1, 0], [1, 0]]\n", ""),
      *more('[[geometry.interface]]\narc = [[-1, 0], [1, 0]]')], 2,
     "wrong.toml:13: geometry.interface.0.arc: [ [ -1, 0 ], [ 1, 0 ] ] is not an arc; write [from, "
     "through, to], three points with the second between the others"),
    ([("[[-1, 0], [1, 0]]", "[[-1, 0], [0.9, 0]]"), ('"uniform"', '"paper"'), ("size = 0.5\n", "")], 2,
     "wrong.toml:14: mesh.preset: preset paper is for one polyline that cuts the polygon in two from boundary to "
     "boundary; choose preset graded or uniform for this geometry"),
    ([('"uniform"', '"graded"'), ("size = 0.5", "grading = 2")], 2,
     "wrong.toml:15: mesh.grading: options.grading is 2; it is an exponent above 0 and at most 1"),
    ([('"uniform"', '"graded"'), ("size = 0.5", "align = [[[0, 0.5], [0, 5]]]")], 2,
     "wrong.toml:15: mesh.align.0: options.align[0] leaves the membrane or touches its boundary in between: the "
     "stretch from (0, 0.5) to (0, 5) meets the edge (1, 1)-(-1, 1) of boundary; only its two ends may lie on the boundary"),
    ([("[1, 0]]\n", "[1, 0]]\nneumann = [[[0, 0], [1, 1]]]\n")], 2,
     "wrong.toml:6: geometry.neumann.0: neumann[0].from (0, 0) lies 1 off the boundary; it must lie on it, to "
     "2.8284271e-06"),
    (more('[[geometry.region]]\nname = "top"\nat = [5, 5]'), 2,
     'wrong.toml:15: geometry.region.top.at: region "top": at (5, 5) lies outside the membrane; it must lie inside '
     "the subdomain it names"),
    ([("interface = [[-1, 0], [1, 0]]\n", ""), *more(
        "[[geometry.interface]]\npoints = [[-1, 0], [1, 0]]\n[[geometry.interface]]\npoints = [[0, 0], [1, 0]]")], 2,
     "wrong.toml:15: geometry.interface.1.points: interface 2 and interface 1 run along each other from (0, 0) on; "
     "leave that stretch out of one of them"),
    ([("interface = [[-1, 0], [1, 0]]\n", ""), *more("[[geometry.interface]]\narc = [[-1, 0], [0, 0], [1, 0]]")], 2,
     "wrong.toml:13: geometry.interface.0.arc: the interface: through (0, 0) lies 0 off the straight line through "
     "(-1, 0) and (1, 0); that is not an arc, give a polyline instead"),
    ([("interface = [[-1, 0], [1, 0]]\n", ""), *more(
        "[[geometry.interface]]\npoints = [[-1, 0], [1, 0]]\n[[geometry.interface]]\nclosed = true\n"
        "points = [[-0.5, 0.3], [0.5, 0.3], [0.5, 0.8], [-0.5, 0.8]]\n"
        '[[geometry.region]]\nname = "patch"\nat = [0, 0.5]')], 1,
     'jobs/ID failed: wrong.toml:26: solver.method: load case "opening": the subdomain "patch" has a part without '
     'Dirichlet nodes, so Algorithm 2 cannot solve on it alone; use the method "active-set"'),
    # Loads.
    ([("[[load]]", "[load]")], 2,
     "wrong.toml:21: load: { f = 'y > 0 ? 1 : -1', name = 'opening' } is not a list of tables; write "
     "[[load]] above each of them"),
    ([(F + "\n", "")], 2,
     "wrong.toml:21: load.opening.f: missing; write a number, an expression in x and y in quotes, {region = "
     'number} or {file = "f.h5", dataset = "/f", per = "triangle"}'),
    ([('name = "opening"\n', "")], 2,
     "wrong.toml:21: load.0.name: missing; give the load case a name"),
    ([('"opening"', '"a/b"')], 2,
     "wrong.toml:22: load.a/b.name: \"a/b\" is not a name of a load case: use 1 to 64 letters, digits, '_', "
     "'.', '-' and spaces, a letter or digit first"),
    (more('[[load]]\nname = "opening"\nf = 1'), 2,
     'wrong.toml:26: load.opening.name: two load cases are named "opening": give each its own name'),
    ([("y > 0 ? 1 : -1", "y > 0 ? 1 :")], 2,
     'wrong.toml:23: load.opening.f: the expression "y > 0 ? 1 :" cannot be read: Unexpected end of '
     "expression at position 12 (symbols are x, y, _pi, _e)"),
    ([("y > 0 ? 1 : -1", "sine(x)")], 2,
     'wrong.toml:23: load.opening.f: the expression "sine(x)" cannot be read: Unexpected token "sine" found '
     "at position 0. (symbols are x, y, _pi, _e)"),
    ([(F, 'f = "x**2"')], 2,
     'wrong.toml:23: load.opening.f: the expression "x**2" has **; a power is ^, so write x^2 for x**2'),
    ([("size = 0.5", "size = 3")], 2,
     "wrong.toml:15: mesh.size: an edge length of 3 is more than the membrane, which is 2.8284271 across; write a "
     "smaller one, or leave it out for its default"),
    ([(F, 'f = "3 kPa"')], 2,
     'wrong.toml:23: load.opening.f: "3 kPa" is a number with a unit; write 3: the units of all numbers are those of '
     "[units]"),
    ([("y > 0 ? 1 : -1", "1 / (x - x)")], 1,
     'jobs/ID failed: wrong.toml:23: load.opening.f: load case "opening": the expression has the value inf '
     "at (x, y) = (X, Y); it must be finite wherever the "
     "membrane is"),
    ([(F, "f = { topp = 1 }"), *more('[[geometry.region]]\nname = "top"\nat = [0, 0.5]')], 2,
     'wrong.toml:27: load.opening.f.topp: there is no region "topp"; did you mean top?'),
    ([(F, "f = { omega7 = 1 }")], 1,
     'jobs/ID failed: wrong.toml:23: load.opening.f.omega7: load case "opening": the mesh has no subdomain "omega7"; '
     'it has "omega1", "omega2"'),
    ([(F, "inclusion_forces = { fibr = 1 }")], 2,
     'wrong.toml:23: load.opening.inclusion_forces.fibr: there is no inclusion "fibr"; did you mean fibre?'),
    ([(F, "inclusion_moments = { fibre = [0, 1] }")], 2,
     "wrong.toml:23: load.opening.inclusion_moments.fibre: the inclusion does not tilt, so a moment on it does nothing; "
     "write tilt = true in its [[geometry.inclusion]], or leave the moment out"),
    ([("delaminated = true", "fixed = 0.1"), (F, "inclusion_forces = { fibre = 0 }")], 2,
     "wrong.toml:23: load.opening.inclusion_forces.fibre: the inclusion is held by its key fixed, so a force on it moves "
     "nothing; leave one of the two out"),
    ([("[1, 0]]\n", '[1, 0]]\nneumann = ["side-2"]\n'), (F, F + '\ntraction = "x +* 2"')], 2,
     'wrong.toml:25: load.opening.traction: the expression "x +* 2" cannot be read: Unexpected operator "*" found at '
     "position 3 (symbols are x, y, _pi, _e)"),
    ([(F, F + '\ntraction = "1"')], 2,
     "wrong.toml:24: load.opening.traction: nothing has a traction, as no part of the boundary is in geometry.neumann; "
     "name its sides or holes there"),
    ([("[1, 0]]\n", '[1, 0]]\nneumann = "all"\n'), ("delaminated = true", "fixed = 0"), (F, 'boundary_value = "x"')], 2,
     "wrong.toml:24: load.opening.boundary_value: nothing has a boundary value, as all of the boundary is a Neumann "
     "boundary; leave it out, or name fewer sides in the geometry's neumann"),
    ([(F, "point_forces = [{ at = [3, 3], value = 1 }]")], 1,
     'jobs/ID failed: wrong.toml:23: load.opening.point_forces.0.at: load case "opening": the point (3, 3) '
     "is outside the membrane: move it inside"),
    ([("delaminated = true", "delaminated = true\ntilt = true"), (F, "inclusion_moments = { fibre = [inf, 0] }")], 2,
     "wrong.toml:24: load.opening.inclusion_moments.fibre: inf is not a finite number; write inclusion = [Mx, My] for "
     "each of them"),
    ([(F, "point_forces = [{ at = [0.2, 0.3] }]")], 2,
     "wrong.toml:23: load.opening.point_forces.0.value: missing; write the force, a number"),
    ([(F, 'f = { file = "no.h5", dataset = "/vector", per = "node" }')], 2,
     "wrong.toml:23: load.opening.f: no.h5: no such file; name a one-dimensional dataset of float64 in an "
     "HDF5 file"),
    ([(F, 'f = { file = "plain.h5", dataset = "/vectr", per = "node" }')], 2,
     'wrong.toml:23: load.opening.f: plain.h5: "vectr" is missing, there is matrix, named, vector, wide; '
     "name a one-dimensional dataset of float64 in an HDF5 file"),
    ([(F, 'f = { file = "plain.h5", dataset = "/vector", per = "nodes" }')], 2,
     "wrong.toml:23: load.opening.f.per: 'nodes' is not possible; did you mean node?"),
    ([(F, 'f = { file = "plain.h5", dataset = "/vector", per = "node" }')], 1,
     'jobs/ID failed: wrong.toml:23: load.opening.f: load case "opening": the array of the force has 3 '
     "values, but the mesh has 31 nodes: give one value for each, in the order of ReadMesh"),
    ([(F, F + '\nboundary_value = "q"')], 2,
     'wrong.toml:24: load.opening.boundary_value: the expression "q" cannot be read: Unexpected token "q" '
     "found at position 0. (symbols are x, y, _pi, _e)"),
]


# Another good one.
SAMPLE = """\
title = "A plate"

[geometry]
boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
interface = [[-1, 0], [1, 0]]

[[geometry.inclusion]]
name = "fibre"
from = [-0.5, 0]
to   = [0.5, 0]

[solver]
theta = 1.5
method = "uzawa"
[[load]]
name = "one"
f = 1
[[load]]
name = "two"
f = "y > 0 ? 1 : -1"
"""
INTERFACE = "interface = [[-1, 0], [1, 0]]\n"
SOLVER = '[solver]\ntheta = 1.5\nmethod = "uzawa"'
LOAD = "f = 1\n"

# (old, new, what is said) of SAMPLE, with the exit code 2: what cannot be read.
UNREADABLE = [
    ("theta = 1.5", "thta = 1.5", "wrong.toml:13: solver.thta: unknown key; did you mean theta?"),
    ("theta = 1.5", "colour = 1.5",
     "wrong.toml:13: solver.colour: unknown key; known are epsilon, kkt_tolerance, mass, max_iterations, max_steps, "
     "method, p, theta, tolerance"),
    ("[solver]", "[slover]", "wrong.toml:12: slover: unknown key; did you mean solver?"),
    (LOAD, "force = 1\n",
     "wrong.toml:17: load.one.force: unknown key; known are boundary_value, f, inclusion_forces, inclusion_moments, "
     "name, point_forces, traction"),
    ("theta = 1.5", 'theta = "fast"',
     "wrong.toml:13: solver.theta: 'fast' is not a finite number; write a number above 0, or \"auto\""),
    ("theta = 1.5", "theta = nan",
     'wrong.toml:13: solver.theta: nan is not a finite number; write a number above 0, or "auto"'),
    ("theta = 1.5", 'epsilon = "1e-12"',
     "wrong.toml:13: solver.epsilon: '1e-12' is not a finite number; write a number without quotes"),
    ("theta = 1.5", "max_iterations = 1.5",
     "wrong.toml:13: solver.max_iterations: 1.5 is not a count; write a whole number from 1 to 2147483647"),
    ('theta = 1.5\nmethod = "uzawa"', "method = 3", "wrong.toml:13: solver.method: 3 is not text; write it in quotes"),
    (SOLVER, "[mesh]\npreset = 3", "wrong.toml:13: mesh.preset: 3 is not text; write it in quotes"),
    ("boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]\n", "",
     "wrong.toml:3: geometry.boundary: missing; write [[x, y], [x, y], ...], or [[geometry.boundary]] for each side"),
    ("[[-1, -1], [1, -1], [1, 1], [-1, 1]]", "3",
     "wrong.toml:4: geometry.boundary: 3 is not a list of points; write [[x, y], [x, y], ...]"),
    ("[1, -1]", "[1, -1, 0]", "wrong.toml:4: geometry.boundary.1: [ 1, -1, 0 ] is not a point; write [x, y]"),
    ("[1, -1]", '[1, "a"]', "wrong.toml:4: geometry.boundary.1: 'a' is not a finite number; write [x, y]"),
    ("[1, -1]", "[1, inf]", "wrong.toml:4: geometry.boundary.1: inf is not a finite number; write [x, y]"),
    ('name = "fibre"\n', "", "wrong.toml:7: geometry.inclusion.0.name: missing; give the inclusion a name"),
    ("from = [-0.5, 0]\n", "",
     "wrong.toml:7: geometry.inclusion.fibre.from: missing; write [x, y], a point of an interface, or a line of its "
     "own: points, arc, spline, or center, angle and length"),
    ("[[geometry.inclusion]]", "[geometry.inclusion]",
     "wrong.toml:7: geometry.inclusion: { from = [ -0.5, 0 ], name = 'fibre', to = [ 0.5, 0 ] } is not a list of "
     "tables; write [[geometry.inclusion]] above each of them"),
    ("to   = [0.5, 0]", 'to   = [0.5, 0]\ndelaminated = "yes"',
     "wrong.toml:11: geometry.inclusion.fibre.delaminated: 'yes' is not possible; write true, false, \"left\", "
     '"right", [[from, to], ...] or [[0.5, 1.0], ...], stretches of its length'),
    ("to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = [[[0, 0]]]",
     "wrong.toml:11: geometry.inclusion.fibre.delaminated.0: [ [ 0, 0 ] ] is not a part; a part is [from, to], and "
     "a list of parts [[from, to]]"),
    ("to   = [0.5, 0]", "to   = [0.5, 0]\ndelaminated = [[0, 0.5, 1]]",
     "wrong.toml:11: geometry.inclusion.fibre.delaminated.0: [ 0, 0.5, 1 ] is not a stretch; write [0.5, 1.0], by "
     "arc length over the whole length"),
    ("to   = [0.5, 0]", 'to   = [0.5, 0]\nside = "up"',
     "wrong.toml:11: geometry.inclusion.fibre.side: 'up' is not possible; known are left, right"),
    ("to   = [0.5, 0]", 'to   = [0.5, 0]\ndelaminated = "left"\nside = "left"',
     "wrong.toml:12: geometry.inclusion.fibre.side: delaminated names a side too; remove one of the two"),
    ("to   = [0.5, 0]", 'to   = [0.5, 0]\ndelaminated = false\nside = "left"',
     "wrong.toml:12: geometry.inclusion.fibre.side: nothing comes off on it, as delaminated = false; remove one of "
     "the two"),
    ("from = [-0.5, 0]\nto   = [0.5, 0]", "center = [0, 0.5]\nlength = 0",
     "wrong.toml:10: geometry.inclusion.fibre.length: 0 is not above 0; write a number above 0"),
    ("from = [-0.5, 0]\nto   = [0.5, 0]", 'center = [0, 0.5]\nlength = "infinite"',
     "wrong.toml:10: geometry.inclusion.fibre.length: 'infinite' is not a finite number; write a number without "
     "quotes"),
    ("from = [-0.5, 0]\nto   = [0.5, 0]", 'center = [0, 0.5]\nlength = "-1.5e2 mm"',
     "wrong.toml:10: geometry.inclusion.fibre.length: '-1.5e2 mm' is a number with a unit; write -1.5e2: the units "
     "of all numbers are those of [units]"),
    ("to   = [0.5, 0]", "to   = [0.5, 0]\ncenter = [0, 0.5]\nlength = 1",
     "wrong.toml:9: geometry.inclusion.fibre.from: belongs to a part of an interface, but the inclusion has center, "
     "a line of its own; remove one of the two"),
    ("to   = [0.5, 0]", "points = [[0, 0], [1, 1]]\ncenter = [0, 0.5]",
     "wrong.toml:11: geometry.inclusion.fibre.center: the inclusion has points too; remove one of the two"),
    ("from = [-0.5, 0]\nto   = [0.5, 0]", "center = [0, 0.5]",
     "wrong.toml:7: geometry.inclusion.fibre.length: missing; write its length, beside its center"),
    ("from = [-0.5, 0]\nto   = [0.5, 0]", 'center = [0, 0.5]\nlength = 1\nangle = "20"',
     "wrong.toml:11: geometry.inclusion.fibre.angle: '20' is not a finite number; write a number without quotes"),
    ("to   = [0.5, 0]", "to   = [0.5, 0]\nangle = 20",
     "wrong.toml:11: geometry.inclusion.fibre.angle: belongs to center; write center = [x, y], angle in degrees and "
     "length"),
    (LOAD, "",
     "wrong.toml:15: load.one.f: missing; write a number, an expression in x and y in quotes, {region = number} or "
     '{file = "f.h5", dataset = "/f", per = "triangle"}'),
    (LOAD, "f = [1]\n",
     "wrong.toml:17: load.one.f: [ 1 ] is not a finite number; write a number, an expression in x and y in quotes, "
     '{region = number} or {file = "f.h5", dataset = "/f", per = "triangle"}'),
    (LOAD, 'f = {a = "b"}\n',
     "wrong.toml:17: load.one.f.a: 'b' is not a finite number; write one number for each region"),
    (INTERFACE, "interface = 3\n",
     "wrong.toml:5: geometry.interface: 3 is not a list of points; write [[x, y], [x, y], ...]"),
    (INTERFACE, "[[geometry.interface]]\npoint = [[0, 0], [1, 0]]\n",
     "wrong.toml:6: geometry.interface.0.point: unknown key; did you mean points?"),
    (INTERFACE, '[[geometry.interface]]\nname = "a"\n',
     "wrong.toml:5: geometry.interface.a: an interface without a shape; write points = [[x, y], ...], arc = [from, "
     "through, to] or spline = [[x, y], ...]"),
    (INTERFACE, "[[geometry.interface]]\npoints = [[-1, 0], [1, 0]]\narc = [[-1, 0], [0, 1], [1, 0]]\n",
     "wrong.toml:7: geometry.interface.0.arc: the interface has points too; remove one of the two"),
    (INTERFACE, "[[geometry.interface]]\narc = [[-1, 0], [0, 1], [1, 0]]\nclosed = true\n",
     "wrong.toml:7: geometry.interface.0.closed: an arc has two ends; remove the key, or write a spline through the "
     "points"),
    (INTERFACE, "[[geometry.interface]]\nspline = [[-1, 0], [1, 0]]\nclosed = 1\n",
     "wrong.toml:7: geometry.interface.0.closed: 1 is neither true nor false"),
    (INTERFACE, "[[geometry.interface]]\nname = 1\n",
     "wrong.toml:6: geometry.interface.0.name: 1 is not text; write it in quotes"),
    (INTERFACE, "[[geometry.interface]]\nspline = [[-1, 0], [1]]\n",
     "wrong.toml:6: geometry.interface.0.spline.1: [ 1 ] is not a point; write [x, y]"),
    (INTERFACE, 'neumann = ["left", 2]\n',
     "wrong.toml:5: geometry.neumann.1: 2 is not a part; a part is [from, to], and a list of parts [[from, to]]"),
    (INTERFACE, '[[geometry.hole]]\nname = "window"\n',
     "wrong.toml:5: geometry.hole.window: the hole without a shape; write circle = { center = [x, y], radius = r }, "
     "points = [[x, y], ...] or spline = [[x, y], ...]"),
    (INTERFACE, "[[geometry.hole]]\ncirlce = {}\n",
     "wrong.toml:6: geometry.hole.0.cirlce: unknown key; did you mean circle?"),
    (INTERFACE, "[[geometry.hole]]\ncircle = { center = [0, 0], radius = 1 }\nspline = []\n",
     "wrong.toml:7: geometry.hole.0.spline: the hole has circle too; remove one of the two"),
    (INTERFACE, "[[geometry.hole]]\ncircle = { center = [0, 0], radius = 0 }\n",
     "wrong.toml:6: geometry.hole.0.circle.radius: 0 is not above 0; write a number above 0"),
    (INTERFACE, "[[geometry.hole]]\ncircle = { center = [0, 0] }\n",
     "wrong.toml:6: geometry.hole.0.circle.radius: missing; write its radius"),
    (INTERFACE, "[[geometry.hole]]\ncircle = 3\n",
     "wrong.toml:6: geometry.hole.0.circle: 3 is not a table; write [geometry.hole.0.circle]"),
    (INTERFACE, '[[geometry.region]]\nname = "r"\nat = [0, 0]\npoints = []\n',
     "wrong.toml:8: geometry.region.r.points: the region has at too; remove one of the two"),
    ("boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]", 'boundary = [{ name = "left" }]',
     "wrong.toml:4: geometry.boundary.left: a side without a shape; write points = [[x, y], ...], arc = [from, "
     "through, to] or spline = [[x, y], ...]"),
    ("boundary  = [[-1, -1], [1, -1], [1, 1], [-1, 1]]", "boundary = [{ point = [] }]",
     "wrong.toml:4: geometry.boundary.0.point: unknown key; did you mean points?"),
    ("[[geometry.inclusion]]\n", '[[geometry.crack]]\nside = "left"\n',
     "wrong.toml:8: geometry.crack.fibre.side: belongs to [[geometry.inclusion]]; the plus side of a crack is on "
     "its left, so write it the other way round"),
    (INTERFACE, "neumann = [[1, -1], [1, 1]]\n", "wrong.toml:5: geometry.neumann.0.0: 1 is not a point; write [x, y]"),
    (INTERFACE, "neumann = [[[1, -1], [1, 1], [0, 0]]]\n",
     "wrong.toml:5: geometry.neumann.0: [ [ 1, -1 ], [ 1, 1 ], [ 0, 0 ] ] is not a part; a part is [from, to], and "
     "a list of parts [[from, to]]"),
    ("from = [-0.5, 0]\n", 'from = [-0.5, 0]\nfixed = "yes"\n',
     "wrong.toml:10: geometry.inclusion.fibre.fixed: 'yes' is not a finite number; write a number without quotes"),
    ("from = [-0.5, 0]\n", "from = [-0.5, 0]\ntilt = 1\n",
     "wrong.toml:10: geometry.inclusion.fibre.tilt: 1 is neither true nor false"),
    ("[[geometry.inclusion]]\n", "[[geometry.crack]]\ntilt = false\n",
     "wrong.toml:8: geometry.crack.fibre.tilt: belongs to [[geometry.inclusion]]; nothing rigid lies on a crack, so "
     "remove it"),
    (INTERFACE, "[[geometry.region]]\nat = [0, 1]\n",
     "wrong.toml:5: geometry.region.0.name: missing; give the region a name"),
    (INTERFACE, '[[geometry.region]]\nname = "top"\n',
     "wrong.toml:5: geometry.region.top.at: missing; write [x, y], a point inside the region, or its outline: "
     "circle, points or spline"),
    (INTERFACE, '[[geometry.region]]\nname = "top"\nat = [0, 1]\ntensoin = 2\n',
     "wrong.toml:8: geometry.region.top.tensoin: unknown key; did you mean tension?"),
    (INTERFACE, '[[geometry.region]]\nname = "top"\nat = [0, 1]\ntension = 0\n',
     "wrong.toml:8: geometry.region.top.tension: 0 is not above 0; write a number above 0, or leave the key out for "
     "its default"),
    (INTERFACE, '[[geometry.region]]\nname = "top"\nat = [0, 1]\ntension = { across = 2 }\n',
     "wrong.toml:8: geometry.region.top.tension.along: missing; write the tension in the direction of angle, a "
     "number or an expression"),
    (SOLVER, "[mesh]\ngradin = 0.2", "wrong.toml:13: mesh.gradin: unknown key; did you mean grading?"),
    (SOLVER, '[mesh]\ntip_size = "small"',
     "wrong.toml:13: mesh.tip_size: 'small' is not a finite number; write a number without quotes"),
    (SOLVER, "[mesh]\ngrading = 0",
     "wrong.toml:13: mesh.grading: 0 is not above 0; write a number above 0, or leave the key out for its default"),
    (SOLVER, "[mesh]\nalign = 3",
     "wrong.toml:13: mesh.align: 3 is not a list of lines; write [[[x, y], [x, y], ...], ...]"),
    (SOLVER, "[mesh]\nalign = [[0, 0], [1, 1]]", "wrong.toml:13: mesh.align.0.0: 0 is not a point; write [x, y]"),
    (SOLVER, '[mesh]\nfile = "a.msh"\n[mesh.inclusions]\nfibre = 1',
     "wrong.toml:15: mesh.inclusions.fibre: 1 is not a table; write NAME = { tilt = true } or NAME = { fixed = 0.1 "
     "} for each of them"),
    (SOLVER, '[mesh]\nfile = "a.msh"\ninclusions = ["fibre"]',
     "wrong.toml:14: mesh.inclusions: [ 'fibre' ] is not a table; write NAME = { tilt = true } or NAME = { fixed = "
     "0.1 } for each of them"),
    (SOLVER, '[mesh]\nfile = "a.msh"\n[mesh.inclusions]\nfibre = { tlit = true }',
     "wrong.toml:15: mesh.inclusions.fibre.tlit: unknown key; did you mean tilt?"),
    (SOLVER, '[mesh]\nfile = "a.msh"\n[mesh.inclusions]\nfibre.fixed = nan',
     "wrong.toml:15: mesh.inclusions.fibre.fixed: nan is not a finite number; write a finite number"),
    (SOLVER, '[mesh]\nfile = "a.msh"\n[mesh.groups]\ncurves.7 = "crack"',
     "wrong.toml:15: mesh.groups.curves: unknown key; did you mean curve?"),
    (SOLVER, '[mesh]\nfile = "a.msh"\n[mesh.groups]\ncurve.seven = "crack"',
     "wrong.toml:15: mesh.groups.curve.seven: 'seven' is not a tag; write the tag of a physical group and its "
     'meaning in quotes, for example curve.7 = "crack" or surface.1 = "top"'),
    (SOLVER, '[mesh]\nfile = "a.msh"\n[mesh.groups.surface]\n1 = 2',
     "wrong.toml:15: mesh.groups.surface.1: 2 is not a meaning of a group; write the tag of a physical group and "
     'its meaning in quotes, for example curve.7 = "crack" or surface.1 = "top"'),
    (SOLVER, '[mesh]\nfile = "a.msh"\ngroups.curve = [7]',
     "wrong.toml:14: mesh.groups.curve: [ 7 ] is not a table; write the tag of a physical group and its meaning in "
     'quotes, for example curve.7 = "crack" or surface.1 = "top"'),
    (SOLVER, '[mesh]\nfile = "a.msh"\ntension.top = [2]',
     "wrong.toml:14: mesh.tension.top: [ 2 ] is not a finite number; write a finite number"),
    (SOLVER, '[mesh]\nfile = "a.msh"\ntension = 2',
     "wrong.toml:14: mesh.tension: 2 is not a table; write subdomain = tension for each"),
    (SOLVER, "[solver]\nkkt_tolerance = 1e-8",
     'wrong.toml:13: solver.kkt_tolerance: belongs to method "uzawa"; remove it, or write method = "uzawa"'),
    (SOLVER, '[solver]\ntolerance = "tiny"',
     "wrong.toml:13: solver.tolerance: 'tiny' is not a finite number; write a number without quotes"),
    (SOLVER, "[solver]\nmax_steps = 0",
     "wrong.toml:13: solver.max_steps: 0 is not a count; write a whole number from 1 to 2147483647"),
    (LOAD, 'f = {file = "f.h5", per = "node"}\n',
     'wrong.toml:17: load.one.f.dataset: missing; name the dataset in the file, as "/f"'),
    (LOAD, 'f = {file = "f.h5", dataset = "/f"}\n',
     'wrong.toml:17: load.one.f.per: missing; write per = "triangle" or per = "node"'),
    (LOAD, 'f = {dataset = "/f", per = "node"}\n', "wrong.toml:17: load.one.f.file: missing; name an HDF5 file"),
    (LOAD, 'f = {file = "f.h5", dataset = "/f", per = "nodes"}\n',
     "wrong.toml:17: load.one.f.per: 'nodes' is not possible; did you mean node?"),
    (LOAD, 'f = {file = "f.h5", datset = "/f", per = "node"}\n',
     "wrong.toml:17: load.one.f.datset: unknown key; did you mean dataset?"),
    (LOAD, "traction = [1]\n",
     "wrong.toml:17: load.one.traction: [ 1 ] is not a finite number; write a number, or an expression in x and y "
     "in quotes"),
    (LOAD, "boundary_value = nan\n",
     "wrong.toml:17: load.one.boundary_value: nan is not a finite number; write a number, or an expression in x and "
     "y in quotes"),
    (LOAD, "point_forces = [{at = [0, 0], valeu = 1}]\n",
     "wrong.toml:17: load.one.point_forces.0.valeu: unknown key; did you mean value?"),
    (LOAD, "point_forces = [{value = 1}]\n",
     "wrong.toml:17: load.one.point_forces.0.at: missing; write [x, y], where the force acts"),
    (LOAD, "point_forces = [{at = [0, 0]}]\n",
     "wrong.toml:17: load.one.point_forces.0.value: missing; write the force, a number"),
    (LOAD, 'point_forces = [{at = [0, 0], value = "1"}]\n',
     "wrong.toml:17: load.one.point_forces.0.value: '1' is not a finite number; write a number without quotes"),
    (LOAD, "inclusion_forces = 2\n",
     "wrong.toml:17: load.one.inclusion_forces: 2 is not a table; write inclusion = number for each of them"),
    (LOAD, 'inclusion_forces = {fibre = "2"}\n',
     "wrong.toml:17: load.one.inclusion_forces.fibre: '2' is not a finite number; write inclusion = number for each "
     "of them"),
    (LOAD, "inclusion_moments = [0, 1]\n",
     "wrong.toml:17: load.one.inclusion_moments: [ 0, 1 ] is not a table; write inclusion = [Mx, My] for each of "
     "them"),
    (LOAD, "inclusion_moments = {fibre = 2}\n",
     "wrong.toml:17: load.one.inclusion_moments.fibre: 2 is not a moment; write inclusion = [Mx, My] for each of "
     "them"),
    (LOAD, "inclusion_moments = {fibre = [0, 0, 2]}\n",
     "wrong.toml:17: load.one.inclusion_moments.fibre: [ 0, 0, 2 ] is not a moment; write inclusion = [Mx, My] for "
     "each of them"),
    (LOAD, "inclusion_moments = {fibre = [0, nan]}\n",
     "wrong.toml:17: load.one.inclusion_moments.fibre: nan is not a finite number; write inclusion = [Mx, My] for "
     "each of them"),
]


def changed(text, edits):
    """The text with the edits."""
    for old, new in edits:
        if old not in text:
            raise ValueError(f"{old!r} is not there")
        text = text.replace(old, new, 1)
    return text


def texts():
    """(wrong case, exit code, what is said) of both."""
    for edits, code, message in CASES:
        yield changed(GOOD, edits), code, message
    for old, new, message in UNREADABLE:
        yield changed(SAMPLE, [(old, new)]), 2, message
