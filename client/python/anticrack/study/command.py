# SPDX-License-Identifier: GPL-3.0-or-later
"""The program anticrack-study, which `anticrack study` runs."""
from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
from collections.abc import Sequence
from typing import Any

from .. import client as clients
from ..case import as_case
from ..command_line import (CLOSED, FAILED, INTERRUPTED, NOT_CONVERGED, Parser, add_server, client_of, code_of,
                            complain, document_of, finite)
from ..errors import CaseError, Error, ServerError
from ..text import harmless, shown
from ..transport import finished
from .record import SOLVED, Study
from .rows import csv_rows, grid, product, value_of, varied
from .run import AT_ONCE, MOST_MESHES, Plan, Told, check_size, dry_text, plan_of, solve


def _parser() -> Parser:
    parser = Parser(
        "anticrack study", allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Solve a case for many values of its keys, each row as a job of its own.",
        epilog="All combinations of the --vary are solved, for each row of --csv. Keys and values are\n"
               "those of --set. A row that is refused or fails keeps its error. Run again after Ctrl-C\n"
               "or a crash, it goes on from FILE.\n\n"
               "Exit codes: 0 all rows converged, 1 a row failed or was refused, 3 a row did not\n"
               "converge; 2, 4, 130 and 141 as of anticrack.")
    parser.add_argument("case", nargs="?", metavar="CASE", help="a case, TOML")
    for flag, metavar, what in (
            ("--vary", "KEY=VALUES", "FIRST:LAST:COUNT, evenly spaced, or VALUE,VALUE,...; again for more keys"),
            ("--set", "KEY=VALUE", "a value for all rows")):
        parser.add_argument(flag, action="append", default=[], metavar=metavar, help=what)
    parser.add_argument("--csv", metavar="FILE", help="rows: a line of keys, then a line of values for each row")
    parser.add_argument("-o", "--output", metavar="FILE", help="the study, HDF5; its rows are not solved again")
    parser.add_argument("--jobs", type=int, default=AT_ONCE, metavar="N", help=f"so many at once (default: {AT_ONCE})")
    parser.add_argument("--show", metavar="FILE", help="only show a study")
    for flag, what in (("--dry-run", "solve nothing, but say what would be solved"),
                       ("--yes", f"do not ask before more than {MOST_MESHES} meshes are made"),
                       ("--retry", "solve rows that failed again"), ("--json", "one JSON document on standard output"),
                       ("--quiet", "nothing but errors")):
        parser.add_argument(flag, action="store_true", help=what)
    add_server(parser)
    return parser


def _rows(given: argparse.Namespace) -> list[dict[str, Any]]:
    """The rows of the command line; values of --set are keys of every row, as the last word of each key wins."""
    fixed = dict[str, Any]()
    for text in given.set:
        key, equals, value = text.partition("=")
        if not equals or not key:
            raise CaseError(f"{shown(text)} sets nothing; write --set KEY=VALUE")
        fixed[key] = value_of(value)
    rows = csv_rows(given.csv) if given.csv else [{}]
    for text in given.vary:
        rows = product(rows, grid(dict([varied(text)])))
    return [{**fixed, **row} for row in rows]


def _ask(plan: Plan, yes: bool) -> None:
    if yes or plan.meshes <= MOST_MESHES:
        return
    if sys.stdin.isatty():
        print(f"{plan.meshes} meshes would be made. Go on? [y/N] ", end="", file=sys.stderr, flush=True)
        if sys.stdin.readline().strip().lower() in ("y", "yes"):
            return
        raise CaseError("nothing was solved")
    check_size(plan, MOST_MESHES, "write --yes if that is meant, and --dry-run to see what it is")


def _code(study: Study) -> int:
    states = {row.status for row in study.rows}
    return FAILED if states - {*SOLVED} else NOT_CONVERGED if "not_converged" in states else 0


def _document(study: Study) -> str:
    rows = [{"values": row.values, "status": row.status, "error": row.error, "job": row.job,
             "answers": finite(row.answers)} for row in study.rows]
    return json.dumps({"title": study.title, "rows": rows}, indent=1, ensure_ascii=False)


def _print(text: str) -> None:
    print(harmless(text, "\n"), flush=True)


def _run(given: argparse.Namespace) -> int:
    if given.show:
        study = Study.read(given.show)
        _print(_document(study) if given.json else study.text(len(study.rows) * max(1, len(study.loads))))
        return 0
    if not given.case:
        raise CaseError("there is no case; name one, a TOML file; see anticrack study --help")
    if not given.output and not given.dry_run:
        raise CaseError("there is no -o FILE for the answers; name one, or see what would be solved with --dry-run")
    case, rows, told = as_case(given.case), _rows(given), Told(not given.quiet)
    with client_of(clients, given) as client:
        session = client._session
        plan = finished(plan_of(session, case, rows, given.output, given.retry, told))
        if given.dry_run:
            _print(dry_text(plan))
            return 0
        _ask(plan, given.yes)
        study = finished(solve(session, case, plan, given.output, given.jobs, given.retry, told))
    if not given.quiet:
        for note in plan.notes:
            print("anticrack:", harmless(note), file=sys.stderr)
    if given.json:
        _print(_document(study))
    elif not given.quiet:
        _print(study.text() + f"\nStudy: {given.output}")
    return _code(study)


def main(words: Sequence[str] | None = None) -> int:
    """Runs a command line and returns the exit code."""
    words = sys.argv[1:] if words is None else words
    try:
        return _run(_parser().parse_args(words))
    except KeyboardInterrupt:
        print("anticrack: interrupted; the same command goes on from what is done", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        with contextlib.suppress(OSError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # no second error at exit
        return CLOSED
    except Error as error:
        complain(error)
        if "--json" in words:
            print(json.dumps(document_of(error, "SERVER" if isinstance(error, ServerError) else "USAGE"), indent=1))
        return code_of(error)
