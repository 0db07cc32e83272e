"""Methods and their options by name."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from . import _core
from ._errors import ArgumentError

Options: TypeAlias = list[tuple[str, str]]


@functools.cache
def _of_any_text() -> frozenset[str]:
    """Options whose value is no word that the library knows, but the name of a file."""
    return frozenset(
        option["name"]
        for _, family in _core.method_families()
        for entry in family
        for option in entry["options"]
        if option["kind"] == "text"
    )


def _known_name(name: str) -> str:
    return name.rstrip("_").replace("_", "-")


def _text(name: str, value: Any) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    if isinstance(value, os.PathLike):
        return os.fsdecode(value)
    if isinstance(value, str):
        is_word = value.isidentifier() and _known_name(name) not in _of_any_text()
        return value.replace("_", "-") if is_word else value
    if hasattr(value, "item") and getattr(value, "ndim", 0) == 0:
        return _text(name, value.item())
    if isinstance(value, (int, float)):
        return repr(value)
    raise ArgumentError(f"option {name}: expected a number, a word or a truth value, got {value!r}")


def option_texts(options: Mapping[str, Any]) -> Options:
    """Keyword arguments as the library reads them; None leaves an option at its default."""
    return [
        (_known_name(name), _text(name, value))
        for name, value in options.items()
        if value is not None
    ]


@dataclass(frozen=True)
class Option:
    """One option of a method: name, unit, range, choices, default, help, and kind of value.

    The name is the command line's; in Python "-" becomes "_".
    """

    name: str
    unit: str
    range: str
    choices: tuple[str, ...]
    default: str
    help: str
    kind: str


@dataclass(frozen=True)
class Method:
    """A method: its name, what it does, where it runs, its options and its paper.

    >>> import littoral
    >>> heat = littoral.methods()["Distance on surfaces"][1]
    >>> heat.name, heat.domains[0], heat.options[0].name
    ('signed-heat', 'triangle mesh', 'time-scale')
    """

    name: str
    summary: str
    domains: tuple[str, ...]
    options: tuple[Option, ...]
    reference: str


def methods() -> dict[str, list[Method]]:
    """All methods by purpose, the default of each first; each names its paper in `reference`.

    >>> import littoral
    >>> [m.name for m in littoral.methods()["Distance on surfaces"]][:3]
    ['auto', 'signed-heat', 'unsigned-heat']
    """
    return {
        title: [
            Method(
                entry["name"],
                entry["summary"],
                tuple(entry["domains"]),
                tuple(
                    Option(**{**option, "choices": tuple(option["choices"])})
                    for option in entry["options"]
                ),
                entry["reference"],
            )
            for entry in family
        ]
        for title, family in _core.method_families()
    }
