"""Every public name says what it is, and functions and classes show a use that runs."""

from __future__ import annotations

import importlib
import inspect
import re
from types import ModuleType
from typing import Any

import pytest

import littoral

# What other calls raise or return; the docstrings of these show them.
NO_EXAMPLE = {"BatchFailures", "BatchSummary", "Closest", "Option"} | {
    name
    for name, value in vars(littoral).items()
    if inspect.isclass(value) and issubclass(value, littoral.Error)
}

# What calls return; nobody makes one.
RETURNED = {
    "Closest",
    "Field",
    "Method",
    "Operators",
    "Option",
    "Regions",
    "Repaired",
    "Report",
    "TetField",
}
RETURNED |= {"BatchFailures", "BatchSummary", "Samples"}

COMPAT = [
    "igl",
    "mesh_to_sdf",
    "open3d",
    "potpourri3d",
    "pygeodesic.geodesic",
    "signedheat3d",
    "trimesh",
]


def members(cls: type) -> dict[str, Any]:
    """The public methods and properties that a class defines itself, by name."""
    return {
        name: getattr(value, "__func__", value)
        for name, value in vars(cls).items()
        if not name.startswith("_")
        and (callable(value) or isinstance(value, (property, staticmethod, classmethod)))
    }


def public(module: ModuleType) -> dict[str, Any]:
    """The functions and classes that belong to a module, by name."""
    names = getattr(module, "__all__", None) or [
        name
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", None) == module.__name__
    ]
    found = {name: getattr(module, name) for name in names}
    return {
        name: value
        for name, value in found.items()
        if inspect.isclass(value) or inspect.isfunction(value)
    }


def is_plain(value: Any) -> bool:
    """Whether Python wrote the docstring of a dataclass or of a named tuple by itself."""
    text = (value.__doc__ or "").strip()
    return not text or text.startswith(f"{value.__name__}(")


def undocumented(names: dict[str, Any], prefix: str) -> list[str]:
    found = []
    for name, value in names.items():
        if is_plain(value):
            found.append(f"{prefix}.{name}")
        if inspect.isclass(value):
            found += [
                f"{prefix}.{name}.{member}"
                for member, each in members(value).items()
                if not inspect.getdoc(each)
            ]
    return found


def test_every_public_name_has_a_docstring():
    assert littoral.__doc__ and littoral.examples.__doc__
    assert undocumented(public(littoral), "littoral") == []
    assert undocumented(public(littoral.examples), "littoral.examples") == []


@pytest.mark.parametrize("name", COMPAT)
def test_so_has_every_name_of_the_modules_for_other_packages(name):
    module = importlib.import_module(f"littoral.compat.{name}")
    assert module.__doc__
    names = public(module)
    assert names
    assert undocumented(names, name) == []
    assert any(">>>" in (value.__doc__ or "") for value in names.values())


def test_functions_and_classes_show_a_use():
    names = public(littoral)
    assert set(names) >= NO_EXAMPLE, "names without an example that there are no more"
    without = [
        name
        for name, value in names.items()
        if name not in NO_EXAMPLE and ">>>" not in (value.__doc__ or "")
    ]
    assert without == []


def silent(names: dict[str, Any], of_module: str) -> list[str]:
    """What takes arguments and does not say what it raises, nor does its class or its module."""
    speaks = re.compile(r"[Rr]aise|Error\b|IndexOutOfRange|errors as")
    found = []
    for name, value in names.items():
        own = inspect.getdoc(value) or ""
        if name not in RETURNED and not speaks.search(own + of_module) and takes_something(value):
            found.append(name)
        if not inspect.isclass(value):
            continue
        for member, each in members(value).items():
            if not speaks.search((inspect.getdoc(each) or "") + own + of_module):
                found += [f"{name}.{member}"] * takes_something(each)
    return found


def takes_something(value: Any) -> bool:
    if isinstance(value, property):
        return False
    if inspect.isclass(value) and issubclass(value, (Exception, str)):
        return False
    return bool(set(inspect.signature(value).parameters) - {"self", "cls", "threads"})


def test_calls_say_what_they_raise():
    assert silent(public(littoral), "") == []
    assert silent(public(littoral.examples), "") == []
    for name in COMPAT:
        module = importlib.import_module(f"littoral.compat.{name}")
        assert silent(public(module), module.__doc__ or "") == [], name


def test_lengths_have_a_unit():
    """Docstrings of what is measured say in what."""
    for name in ("distance", "offset", "isolines", "SDF", "Volume", "TetMesh", "Mesh", "Field"):
        text = inspect.getdoc(getattr(littoral, name))
        assert "[length" in text or "nodes x 3" in text, name


def test_first_lines_are_a_sentence():
    for name, value in public(littoral).items():
        first = inspect.getdoc(value).split("\n\n")[0]
        assert first.rstrip().endswith((".", "]")), name
