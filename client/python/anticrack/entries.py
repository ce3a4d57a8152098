# SPDX-License-Identifier: GPL-3.0-or-later
"""The single values of the API's messages, as result files name them. They are found by walking the message type, so
that a new field appears everywhere by itself. client/results/entries.hpp does the same for the command."""
from __future__ import annotations

import functools
import importlib.resources
import re
from typing import Any

from google.protobuf import descriptor_pb2
from google.protobuf.descriptor import FieldDescriptor

NAN = float("nan")
# Names of an inclusion's, a boundary's and a tip's values.
_SYMBOLS = [("displacement", "A"), ("slope_", "B"), ("moment_", "M"), ("k_iii", "K_III"), ("energy_release_rate", "G")]
_MESSAGES, _FIELDS = 4, 2  # numbers in paths of source_code_info, see descriptor.proto


def name_of(field: Any) -> str:
    """The name in files: the field's, but A, B, M of inclusions as in the paper, K_III and G of tips, G1 and Gc of
    growth, and seconds for durations."""
    name = str(field.name)
    if field.message_type is not None and field.message_type.name == "Duration":
        return name.replace("time", "seconds")
    if field.containing_type.name == "GrowthRow":
        return "Gc" if name == "toughness" else name.replace("g1", "G1").replace("g_dead", "G_dead")
    if field.containing_type.name in ("InclusionAnswer", "BoundaryAnswer", "Tip"):
        for long_name, symbol in _SYMBOLS:
            if name.startswith(long_name):
                return symbol + name.removeprefix(long_name)
    return name


def status_name(code: int, enum: Any) -> str:
    """The name of a status in files: "not_converged" for STATUS_NOT_CONVERGED."""
    first = enum.values_by_number[0].name  # STATUS_UNSPECIFIED
    return str(enum.values_by_number[int(code)].name)[first.rfind("_") + 1:].lower()


def _is_nested(field: Any) -> bool:
    return field.message_type is not None and field.message_type.name not in ("Duration", "Status", "Timestamp")


def _is_list(field: Any) -> bool:
    return bool(field.label == field.LABEL_REPEATED)


@functools.cache
def entries_of(descriptor: Any) -> dict[str, tuple[Any, Any]]:
    """Maps each name in files to the nested message that has the value, or None, and to the value's field. Leaves out
    lists and nested messages with lists."""
    found: dict[str, tuple[Any, Any]] = {}
    for field in descriptor.fields:
        if _is_nested(field) and not _is_list(field):
            if not any(map(_is_list, field.message_type.fields)):
                found.update((f"{field.name}_{name_of(inner)}", (field, inner)) for inner in field.message_type.fields
                             if not _is_nested(inner))
        elif not _is_list(field):
            found[name_of(field)] = (None, field)
    return found


def lists_of(descriptor: Any) -> list[Any]:
    """The fields that are lists of texts or messages."""
    return [field for field in descriptor.fields if _is_list(field)
            and not (field.message_type is not None and field.message_type.GetOptions().map_entry)]


def none_of(field: Any) -> Any:
    """The value that means "not set"."""
    if field.message_type is not None:
        return 0.0 if field.message_type.name == "Duration" else ""
    known = {FieldDescriptor.CPPTYPE_DOUBLE: NAN, FieldDescriptor.CPPTYPE_INT32: 0, FieldDescriptor.CPPTYPE_UINT64: 0,
             FieldDescriptor.CPPTYPE_BOOL: 0}
    return known.get(field.cpp_type, "")


def value_of(message: Any, outer: Any, field: Any) -> Any:
    """Reads a value: an enum by its name, an error by its message, a time by its text; NaN if a number is not set."""
    if outer is not None:
        if not message.HasField(outer.name):
            return none_of(field)
        message = getattr(message, outer.name)
    if field.has_presence and not message.HasField(field.name):
        return none_of(field)
    value = getattr(message, field.name)
    if field.enum_type is not None:
        return status_name(value, field.enum_type)
    if field.message_type is None:
        return int(value) if isinstance(value, bool) else value
    kind = field.message_type.name
    return value.ToNanoseconds() / 1e9 if kind == "Duration" else (
        value.ToJsonString() if kind == "Timestamp" else value.message)


def set_value(message: Any, outer: Any, field: Any, value: Any) -> None:
    """Sets the value that value_of reads."""
    if (outer is not None or field.has_presence) and (value == none_of(field) or value != value):
        return
    if outer is not None:
        message = getattr(message, outer.name)
    if field.enum_type is not None:
        value = next(known.number for known in field.enum_type.values
                     if status_name(known.number, field.enum_type) == value)
    if field.message_type is None:
        setattr(message, field.name, bool(value) if field.cpp_type == FieldDescriptor.CPPTYPE_BOOL else value)
    elif field.message_type.name == "Status":
        getattr(message, field.name).message = value
    elif field.message_type.name == "Duration":
        getattr(message, field.name).FromNanoseconds(round(1e9 * value))
    else:
        getattr(message, field.name).FromJsonString(value)


def values_of(message: Any) -> dict[str, Any]:
    return {name: value_of(message, *place) for name, place in entries_of(message.DESCRIPTOR).items()}


def defaults_of(message: Any) -> dict[str, Any]:
    """The values of a message in which nothing is set, by name."""
    return {name: none_of(field) for name, (_, field) in entries_of(message.DESCRIPTOR).items()}


@functools.cache
def _comments() -> dict[str, str]:
    """The comments of the proto files, by the full names of fields."""
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
    """Splits a field's comment, as "Pi(u) [F L]", into the meaning and the unit in F and L."""
    comment = _comments().get(field.full_name, "")
    found = re.fullmatch(r"(.*) \[([FLs/() ^0-9]+)\]", comment)
    return (found[1], found[2]) if found else (comment, "")


def meanings(descriptor: Any, where: str) -> list[tuple[str, str, str, str]]:
    """For each value in a message and in its lists: its place in a file, name, dimension and meaning."""
    rows = []
    for at, of in [(where, descriptor), *((field.name, field.message_type) for field in lists_of(descriptor)
                                          if field.message_type is not None)]:
        for name, (_, field) in entries_of(of).items():
            meaning, unit = meaning_of(field)
            rows.append((at, name, unit, meaning))
    return rows
