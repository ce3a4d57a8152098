# SPDX-License-Identifier: GPL-3.0-or-later
"""What an example opens with: comment lines that say what it shows, the commands and what to expect.

A command is a line "#   anticrack ..." (a backslash at its end continues it); two spaces or more and
"exit code N" after it say that it ends with another code than 0.
"""
import dataclasses
import itertools
import re


@dataclasses.dataclass
class Command:
    text: str
    exit_code: int


class Opening:
    def __init__(self, path):
        lines = itertools.takewhile(lambda line: line.startswith("#"), path.read_text(encoding="utf-8").splitlines())
        text = "\n".join(line[1:] for line in lines).replace("\\\n", " ")
        self.commands = []
        self.words = ""
        for line in text.splitlines()[1:]:  # below the licence
            command = re.fullmatch(r"   (anticrack .*?)(?:\s{2,}exit code (\d+))?", line)
            if command:
                self.commands.append(Command(command.group(1), int(command.group(2) or 0)))
            else:
                self.words += line + "\n"
