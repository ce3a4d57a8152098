# SPDX-License-Identifier: GPL-3.0-or-later
"""The single values of the API's messages, as result files name them: walked, so that a new field is everywhere by
itself. The command's client/results/entries.hpp says the same."""
from __future__ import annotations

import functools
import importlib.resources
import re
from typing import Any

from google.protobuf import descriptor_pb2
from google.protobuf.descriptor import FieldDescriptor

NAN = float("nan")
_SYMBOLS = [("displacement", "A"), ("slope_", "B"), ("moment_", "M")]  # of an inclusion
_MESSAGES, _FIELDS = 4, 2  # in paths of source_code_info, see descriptor.proto


def name_of(field: Any) -> str:
    """In files: that of the field; of an inclusion A, B and M as in the paper; of a duration in seconds."""
    name = str(field.name)
    if field.message_type is not None and field.message_type.name == "Duration":
        return name.replace("time", "seconds")
    if field.containing_type.name == "InclusionAnswer":
        for long_name, symbol in _SYMBOLS:
            if name.startswith(long_name):
                return symbol + name.removeprefix(long_name)
    return name


def status_name(code: int, enum: Any) -> str:
    """STATUS_NOT_CONVERGED is "not_converged"."""
    return str(enum.values_by_number[int(code)].name).removeprefix("STATUS_").lower()


def _is_nested(field: Any) -> bool:
    return field.message_type is not None and field.message_type.name not in ("Duration", "Status")


def fields_of(message: Any) -> dict[str, Any]:
    """By the names of files; lists and nested messages left out."""
    return {name_of(field): field for field in message.DESCRIPTOR.fields
            if field.label != field.LABEL_REPEATED and not _is_nested(field)}


def value_of(message: Any, field: Any) -> Any:
    """Of an enum its name, of an error its message; NaN of a number that is not set."""
    if field.has_presence and field.message_type is None and not message.HasField(field.name):
        return NAN
    value = getattr(message, field.name)
    if field.enum_type is not None:
        return status_name(value, field.enum_type)
    if field.message_type is None:
        return value
    return value.message if field.message_type.name == "Status" else value.ToNanoseconds() / 1e9


def values_of(message: Any) -> dict[str, Any]:
    return {name: value_of(message, field) for name, field in fields_of(message).items()}


def defaults_of(message: Any) -> dict[str, Any]:
    """What is not known."""
    known: dict[int, Any] = {FieldDescriptor.CPPTYPE_DOUBLE: NAN, FieldDescriptor.CPPTYPE_INT32: 0,
                             FieldDescriptor.CPPTYPE_UINT64: 0}
    return {name: 0.0 if field.message_type is not None and field.message_type.name == "Duration"
            else known.get(field.cpp_type, "") for name, field in fields_of(message).items()}


@functools.cache
def _comments() -> dict[str, str]:
    """By the full names of fields."""
    packed = importlib.resources.files(__package__).joinpath("v1/comments.desc").read_bytes()
    comments = {}
    for file in descriptor_pb2.FileDescriptorSet.FromString(packed).file:
        for place in file.source_code_info.location:
            if len(place.path) == 4 and place.path[0] == _MESSAGES and place.path[2] == _FIELDS:
                message = file.message_type[place.path[1]]
                name = f"{file.package}.{message.name}.{message.field[place.path[3]].name}"
                comments[name] = " ".join((place.trailing_comments or place.leading_comments).split())
    return comments


def meaning_of(field: Any) -> tuple[str, str]:
    """What the comment says, and the unit in F and L that ends it: "Pi(u) [F L]"."""
    comment = _comments().get(field.full_name, "")
    found = re.fullmatch(r"(.*) \[([FLs/() ^0-9]+)\]", comment)
    return (found[1], found[2]) if found else (comment, "")


def meanings(descriptor: Any, where: str, prefix: str = "") -> list[tuple[str, str, str, str]]:
    """Of all values in a message and in its lists: where they are in a file, name, dimension and meaning."""
    rows: list[tuple[str, str, str, str]] = []
    lists = []
    for field in descriptor.fields:
        if field.label == field.LABEL_REPEATED:
            lists += [field] if field.message_type is not None else []
        elif _is_nested(field):
            rows += meanings(field.message_type, where, f"{field.name}_")
        else:
            meaning, unit = meaning_of(field)
            rows.append((where, prefix + name_of(field), unit, meaning))
    return rows + [row for field in lists for row in meanings(field.message_type, field.name)]
