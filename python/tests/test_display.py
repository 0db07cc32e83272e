"""Pages and pictures."""

from __future__ import annotations

import io
import itertools

import numpy as np
import pytest

import littoral
from littoral import _display, _tets


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
    with pytest.raises(littoral.ArgumentError, match=r"Field.*got Mesh; .* littoral view shows"):
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


@pytest.fixture(scope="module")
def box() -> littoral.TetMesh:
    """The unit cube in 4 x 4 x 4 cubes of six tets each."""
    n = 4
    axis = np.arange(n + 1)
    nodes = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    step = np.array([(n + 1) ** 2, n + 1, 1])
    first = (nodes @ step)[(nodes < n).all(axis=1)]
    ways = [np.cumsum([0, *step[list(order)]]) for order in itertools.permutations(range(3))]
    return littoral.TetMesh(nodes / n, np.concatenate([first[:, None] + way for way in ways]))


def pixels(picture: bytes) -> np.ndarray:
    return np.asarray(pytest.importorskip("PIL.Image").open(io.BytesIO(picture)))


@pytest.mark.slow
def test_tets_are_drawn_and_cut_open(box, tmp_path):
    depth = littoral.tet_distance(box, boundary=True)
    assert depth.values.max() == pytest.approx(0.5)
    depth.save(tmp_path / "picture.png")
    by_file = pixels((tmp_path / "picture.png").read_bytes())
    assert (by_file == pixels(depth._repr_png_())).all()
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    by_middle = depth.plot(slice=0.5).images[0].get_array()
    assert (np.round(255 * by_middle[..., :3]) == by_file[..., :3]).all()
    for other in ({"slice": 0.3}, {"axis": "x", "slice": 0.5}):
        assert (depth.plot(**other).images[0].get_array() != by_middle).any()
    for name in ("ply", "vtu", "csv"):
        depth.save(tmp_path / f"field.{name}")
    boundary = littoral.read(tmp_path / "field.ply")
    assert (boundary.n_vertices, boundary.n_faces) == (5**3 - 3**3, 6 * 16 * 2)
    with pytest.raises(littoral.InputError, match="misses the tets"):
        depth.plot(slice=2)
    with pytest.raises(littoral.InputError, match="axis: expected"):
        depth.plot(axis="w", slice=0.5)
    with pytest.raises(littoral.UnsupportedError):
        depth.save(tmp_path / "field.stp")


def test_tets_that_no_source_reaches_are_cut_open(box):
    V, T = box.points, box.tets
    two = littoral.TetMesh(
        np.concatenate([V, V + np.array([2, 0, 0])]), np.concatenate([T, T + len(V)])
    )
    field = littoral.tet_distance(two, vertices=0)
    assert np.isinf(field.values[len(V) :]).all()
    for place in (0.3, 0.5, 0.625):
        assert pixels(_display.picture(_tets._Cut(field, "z", place))).std() > 10


def test_volumes_have_pages_and_pictures(sphere, tmp_path):
    volume = littoral.SDF(sphere).sample(12)
    volume.save(tmp_path / "volume.png")
    assert (pixels((tmp_path / "volume.png").read_bytes()) == pixels(volume._repr_png_())).all()
    assert pixels(volume._repr_png_()).std() > 10


def test_all_that_is_drawn_has_a_page(box, sphere, tmp_path):
    field = littoral.tet_distance(box, vertices=0)
    volume = littoral.SDF(sphere).sample(8)
    try:
        pages = [field.show(tmp_path / "a.html"), littoral.show(field, tmp_path / "b.html"),
                 field.show(tmp_path / "c.html", axis="y", slice=0.3),
                 volume.show(tmp_path / "d.html")]  # fmt: skip
    except littoral.UnsupportedError:
        pytest.skip("built without the viewer")
    a, b, c, d = (page.read_bytes() for page in pages)
    assert a == b and len({a, c, d}) == 3
    assert all(page.lstrip().lower().startswith(b"<!doctype html") for page in (a, c, d))
