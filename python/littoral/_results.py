"""What results have in common: what is said of them, how they are looked at, and `as_`."""

from __future__ import annotations

import functools
import inspect
import os
from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar, overload

from . import _display
from ._foreign import check_kind, handed_over
from ._report import Report, ReportWarning

P = ParamSpec("P")
R = TypeVar("R")
R_co = TypeVar("R_co", covariant=True)
S = TypeVar("S")
S_contra = TypeVar("S_contra", contravariant=True)


class Reported:
    """What carries a report of how it was computed."""

    report: Report

    @property
    def warnings(self) -> list[ReportWarning]:
        """What the computation warns of; empty where nothing is doubtful."""
        return self.report.warnings


class Shown:
    """What has a page and a picture."""

    _handle: Any

    def show(self, path: str | os.PathLike[str] | None = None) -> Any:
        """The page to turn it in: in a notebook, or opened in the browser (`littoral.show`)."""
        return _display.show(self, path)

    def plot(self, ax: Any = None) -> Any:
        """A picture by littoral's renderer in matplotlib axes: in `ax` or new ones, returned."""
        return _display.plot(self, ax)

    def _write_page(self, path: str) -> None:
        self._handle.write_page(path)

    def _write_picture(self, path: str) -> None:
        self._handle.write_picture(path)

    def _repr_png_(self) -> bytes:
        return _display.picture(self)


class TakesKind(Protocol[P, R_co]):
    """A function whose result may be asked for as an object of another library."""

    @overload
    def __call__(self, *arguments: Any, as_: str, **keywords: Any) -> Any: ...
    @overload
    def __call__(self, *arguments: P.args, **keywords: P.kwargs) -> R_co: ...


class MethodTakesKind(Protocol[S_contra, P, R_co]):
    """The same of a method."""

    def __get__(self, instance: S_contra, owner: Any = None) -> TakesKind[P, R_co]: ...


def _with_kind(call: Callable[..., Any]) -> Any:
    @functools.wraps(call)
    def wrapper(*arguments: Any, as_: str | None = None, **keywords: Any) -> Any:
        if as_ is None:
            return call(*arguments, **keywords)
        check_kind(as_)
        return handed_over(call(*arguments, **keywords), as_)

    signature = inspect.signature(call)
    parameters = list(signature.parameters.values())
    at = len(parameters) - (parameters[-1].kind is inspect.Parameter.VAR_KEYWORD)
    added = inspect.Parameter(
        "as_", inspect.Parameter.KEYWORD_ONLY, default=None, annotation="str | None"
    )
    wrapper.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[*parameters[:at], added, *parameters[at:]]
    )
    return wrapper


def takes_kind(call: Callable[P, R]) -> TakesKind[P, R]:
    """A function that also takes `as_`: "pyvista", "trimesh" or "meshio"."""
    made: TakesKind[P, R] = _with_kind(call)
    return made


def method_takes_kind(call: Callable[Concatenate[S, P], R]) -> MethodTakesKind[S, P, R]:
    """The same for a method."""
    made: MethodTakesKind[S, P, R] = _with_kind(call)
    return made
