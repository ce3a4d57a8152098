# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands that draw and export. `anticrack` has the same options, for its help and completion, and runs these
commands."""
from __future__ import annotations

import argparse
import contextlib
import json
import os
import signal
import struct
import sys
from collections.abc import Sequence
from typing import Any

from .blocks import BlockReceiver
from .command_line import CLOSED, USAGE, Parser, Usage, complain, document_of, number
from .errors import Error, package
from .result import Result, Units
from .study.record import Study, is_study
from .text import harmless
from .v1 import mesh_pb2

FIGURES = ("overview", "membrane", "plan", "traces", "convergence", "accuracy", "growth")
PICTURES, FILMS = ("png", "svg", "pdf"), ("gif", "webp", "mp4")
ANIMATED = ("loads", "amplitude", "stages", "growth")


def _some(known: Sequence[str], wrong: str) -> Any:
    """Makes a parser of comma-separated words. wrong: the error for an unknown word, which replaces the {} in it."""
    def some(text: str) -> list[str]:
        found = list(dict.fromkeys(text.split(",")))
        for name in found:
            if name == "pressure":
                raise argparse.ArgumentTypeError("the pressure is a panel of traces; write that, or overview")
            if name not in known:
                raise argparse.ArgumentTypeError(wrong.format(name))
        return found
    return some


def _limits(text: str) -> tuple[float, float]:
    with contextlib.suppress(ValueError):
        low, high = map(float, text.split(","))
        if low < high:
            return low, high
    raise argparse.ArgumentTypeError(f"{text} is not LOW,HIGH, as -0.1,0.4")


def _parser() -> Parser:
    parser = Parser("anticrack", description="Draws results and meshes of anticrack.", allow_abbrev=False)
    commands = parser.add_subparsers(dest="command", required=True, parser_class=Parser)
    plot = commands.add_parser("plot", allow_abbrev=False, help="draw the figures of a result file")
    plot.add_argument("--together", action="store_true", help="up to 8 loads over each other on one interface")
    plot.add_argument("--only", type=_some(FIGURES, "{} is none of " + ", ".join(FIGURES)),
                      action="extend", default=[], metavar="LIST",
                      help=f"of {', '.join(FIGURES[:-1])} and {FIGURES[-1]} those to draw")
    plot.add_argument("--animate", metavar="WHAT", choices=ANIMATED,
                      help="write animations in place of figures: all loads one after another, or of each load u that "
                      "grows to its size and back, its stages, or its growth")
    plot.add_argument("--interface", default="", metavar="NAME", help="draw the traces of this one")
    plot.add_argument("--all", action="store_true", help="of loads and interfaces, however many there are")
    plot.add_argument("--amplify", type=number(1e-300, 1e300, float), metavar="FACTOR", help="of u in the membrane")
    plot.add_argument("--limits", type=_limits, metavar="LOW,HIGH", help="of the colours of u in the membrane")
    mesh = commands.add_parser("mesh", allow_abbrev=False, help="draw the mesh that anticrack mesh show reads: on "
                               "standard input Mesh, BlockLayout and the bytes of ReadMesh, with its length (8 bytes, "
                               "little-endian) before each")
    mesh.add_argument("--unit", default="", help="of length")
    mesh.add_argument("--free", action="store_true", help="no traction acts where u is not given")
    exports = commands.add_parser("export", allow_abbrev=False, help="export a result file for ParaView")
    exports.add_argument("-o", "--output", required=True, metavar="DIR", help="folder of the files")
    for command in (plot, exports):
        command.add_argument("file", metavar="RESULT", help="result file, HDF5")
        command.add_argument("--load", action="append", default=[],
                             help="this load only, of a sweep row-K; again for more")
    for command in (plot, mesh):
        command.add_argument("-o", "--output", default="figures", metavar="DIR", help="folder of the figures")
        command.add_argument("--format", metavar="LIST", help="of png, svg and pdf those to write, of animations gif, "
                             "webp and mp4", type=_some(PICTURES + FILMS, '"{}" is none of png, svg and pdf'))
        command.add_argument("--dpi", type=number(50, 1200, int), help="dots an inch of PNG files")
        command.add_argument("--width", type=number(40, 400, float), default=85.0, metavar="MM", help="of a panel")
        command.add_argument("--font", default="", metavar="NAME", help="family of the letters")
        command.add_argument("--no-titles", action="store_true", help="no titles of case, load and panels")
    for command in (plot, mesh, exports):
        command.add_argument("--json", action="store_true", help="one JSON document on standard output")
        command.add_argument("--quiet", action="store_true", help="nothing but errors")
    return parser


def _made(given: argparse.Namespace) -> Any:
    try:
        return _exported(given) if given.command == "export" else _drawn(given)
    except (IndexError, ValueError, KeyError) as error:
        if isinstance(error, Error) or given.command == "mesh":
            raise
        raise Error(f"{given.file} cannot be {'exported' if given.command == 'export' else 'drawn'}, as if it were "
                    f"damaged: {error}") from error


def _exported(given: argparse.Namespace) -> Any:
    from . import vtk
    return vtk.export(Result.read(given.file), given.file, given.output, given.load)


def _drawn(given: argparse.Namespace) -> Any:
    package("matplotlib").use("Agg")
    from .draw import files
    from .draw.sheet import Look
    animated = given.command == "plot" and given.animate
    known = FILMS if animated else PICTURES
    for kind in given.format or ():
        if kind not in known:
            raise Usage(f'--format: "{kind}" is none of {", ".join(known[:-1])} and {known[-1]}; see anticrack '
                        f"{given.command} --help")
    look = Look(given.format or list(known[:1] if animated else known[:2]), given.dpi or (150 if animated else 300),
                not given.no_titles, given.width, given.font)
    if given.command == "mesh":
        return files.draw_mesh(_read_mesh(given), given.output, look)
    look.amplify, look.limits = given.amplify, given.limits
    if given.together and given.only:
        raise Usage("--together and --only exclude each other; leave one out; see anticrack plot --help")
    if is_study(given.file):
        from .draw.studies import draw_study
        return draw_study(Study.read(given.file), given.output, look)
    result = Result.read(given.file)
    if animated:
        from .draw.animate import draw_animations
        return draw_animations(result, given.output, given.animate, given.load, look)
    wanted = files.Wanted(given.only, given.interface, given.load, given.all)
    return (files.draw_together if given.together else files.draw_figures)(result, given.output, wanted, look)


def _read_mesh(given: argparse.Namespace) -> Any:
    from .draw.meshes import Plan
    parts = []
    for _ in range(3):
        size, = struct.unpack("<Q", sys.stdin.buffer.read(8))
        parts.append(sys.stdin.buffer.read(size))
    receiver = BlockReceiver()
    receiver.accept(mesh_pb2.ReadMeshResponse(layout=mesh_pb2.BlockLayout.FromString(parts[1])))
    receiver.accept(mesh_pb2.ReadMeshResponse(chunk=mesh_pb2.BlockChunk(data=parts[2])))
    return Plan(mesh_pb2.Mesh.FromString(parts[0]), receiver.finish(), Units(given.unit), given.free)


def plot() -> int:
    """The program anticrack-plot, which `anticrack plot` runs if it is on PATH."""
    return main(["plot", *sys.argv[1:]])


def view() -> int:
    """The program anticrack-view, which `anticrack view` runs."""
    return main(["view", *sys.argv[1:]])


def main(words: Sequence[str]) -> int:
    """Runs a command line and returns the exit code: 0, 2 with a line on standard error, or 141 if the reader of
    standard output has closed it."""
    if words[:1] == ["study"]:
        from .study import command
        return command.main(words[1:])
    if words[:1] == ["view"]:
        package("aiohttp")
        from .view import program
        return program.main(words[1:])
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # a file too large is an error of the write, no signal
    code, document, lines = 0, {}, []
    try:
        given = _parser().parse_args(words)
        made = _made(given)
        document = {"files": made.files, "notes": made.notes}
        lines = [] if given.quiet else [*made.files, *made.notes]
    except Error as error:
        code, kind = USAGE, "USAGE" if isinstance(error, Usage) else "FIGURES"
        document = document_of(error, kind)
        complain(error)
    if "--json" in words:
        lines = [json.dumps(document, indent=1, ensure_ascii=False)]
    try:
        for line in lines:
            print(line if "--json" in words else harmless(line))
        sys.stdout.flush()
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # no second error at exit
        if isinstance(error, BrokenPipeError):
            return code or CLOSED
        print(f"anticrack: standard output cannot be written: {error.strerror}", file=sys.stderr)
        return USAGE
    return code
