"""Pages and pictures."""

from __future__ import annotations

import pytest

import littoral


def test_pages_and_pictures(square, line, tmp_path, monkeypatch):
    field = littoral.distance(square, line)
    regions = littoral.winding(square, [20, 24, 60, 56, 20])
    for result in (field, regions):
        try:
            page = result.show(tmp_path / "page.html")
        except littoral.UnsupportedError:  # built without the viewer
            continue
        assert page.read_bytes().lstrip().lower().startswith(b"<!doctype html")
    assert field._repr_png_().startswith(b"\x89PNG")
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert field.show().is_file() and opened[0].startswith("file:")
    with pytest.raises(TypeError, match="Field"):
        littoral.show(square)


def test_plot_draws_into_axes(square):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = littoral.distance(square, points=0).plot()
    assert len(axes.images) == 1


def test_notebooks_get_the_page_inline(square, monkeypatch):
    monkeypatch.setattr("littoral._display._in_notebook", lambda: True)
    page = littoral.distance(square, points=0).show()
    assert page._repr_html_().startswith("<iframe")
