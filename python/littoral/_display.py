"""Looking at results: the page, in a notebook or a browser, and pictures."""

from __future__ import annotations

import base64
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import Any

from ._arguments import path_to_write
from ._errors import ArgumentError


def _in_notebook() -> bool:
    try:
        from IPython import get_ipython  # type: ignore[attr-defined, unused-ignore]
    except ImportError:
        return False
    shell = get_ipython()
    return shell is not None and shell.__class__.__name__ == "ZMQInteractiveShell"


class Page:
    """A page in a notebook's output."""

    def __init__(self, html: bytes) -> None:
        self._data = base64.b64encode(html).decode()

    def _repr_html_(self) -> str:
        return (
            f'<iframe src="data:text/html;base64,{self._data}" '
            'style="width: 100%; height: 480px; border: 0"></iframe>'
        )


def show(result: Any, path: str | os.PathLike[str] | None = None) -> Any:
    """The self-contained page of a field, regions or a volume, to turn and measure in.

    In a notebook it becomes the cell's output; with `path` it is written there, and otherwise it is
    opened in the browser. Raises ArgumentError for anything else, UnsupportedError where littoral
    was built without pages, IoError where the page cannot be written. Pages of meshes alone are
    made by the command `littoral view`.

    >>> import littoral
    >>> littoral.show("a text")
    Traceback (most recent call last):
    littoral.ArgumentError: expected a littoral.Field, TetField, Regions or Volume, got str
    """
    write = _writer(result, "_write_page")
    if path is not None:
        to = path_to_write(path)
        write(to)
        return Path(to)
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder) / "page.html"
        if _in_notebook():
            write(os.fspath(inside))
            return Page(inside.read_bytes())
    file, name = tempfile.mkstemp(suffix=".html", prefix="littoral-")
    os.close(file)
    write(name)
    webbrowser.open(Path(name).as_uri())
    return Path(name)


def _writer(result: Any, name: str) -> Any:
    if not hasattr(result, name):
        expected = "expected a littoral.Field, TetField, Regions or Volume, got "
        hint = "; the command littoral view shows meshes" if hasattr(result, "points") else ""
        raise ArgumentError(expected + type(result).__name__ + hint)
    return getattr(result, name)


def picture(result: Any) -> bytes:
    """A PNG of a field, regions or a volume by littoral's renderer, without a display."""
    write = _writer(result, "_write_picture")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        write(os.fspath(path))
        return path.read_bytes()


def plot(result: Any, ax: Any = None) -> Any:
    """That picture in matplotlib axes, which are returned."""
    import io

    import matplotlib.pyplot as plt

    image = plt.imread(io.BytesIO(picture(result)), format="png")
    if ax is None:
        height, width = image.shape[:2]
        _, ax = plt.subplots(figsize=(6, 6 * height / width))
    ax.imshow(image)
    ax.set_axis_off()
    return ax
