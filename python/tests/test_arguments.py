"""Wrong arguments: errors are littoral's, are of Python's kinds too, and name the argument."""

from __future__ import annotations

import re
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import littoral

SQUARE = littoral.examples.square(4)
CUBE = littoral.examples.cube()
SDF = littoral.SDF(CUBE)
VOLUME = SDF.sample(9)
TETS = littoral.TetMesh(np.eye(4, 3), [[0, 1, 2, 3]])
FIELD = littoral.distance(SQUARE, points=0)
IN_TETS = littoral.tet_distance(TETS, vertices=0)
CURVES = littoral.winding(SQUARE, [6, 8, 18, 16, 6]).bounding_sources

# What is called, what is raised beside littoral.Error, and what the message begins with.
WRONG: list[tuple[Callable[[], Any], type[Exception], str]] = [
    (lambda: littoral.distance(SQUARE, points=1.0), TypeError, "points: "),
    (lambda: littoral.distance(SQUARE, points=0, threads=-1), ValueError, "threads: "),
    (lambda: littoral.distance(SQUARE, points=0, method=5), TypeError, "method: "),
    (lambda: littoral.distance(SQUARE, points=0, time_scale=[1]), TypeError, "option time_scale: "),
    (lambda: littoral.distance(SQUARE, points=0, as_=["trimesh"]), ValueError, "as_: "),
    (lambda: littoral.distance(SQUARE, points=[np.timedelta64(1)]), TypeError, "points: "),
    (lambda: littoral.distance(SQUARE, points=np.array("a")), TypeError, "points: "),
    (lambda: littoral.distance(SQUARE, [[0, np.timedelta64(1)]]), TypeError, "curves[0]"),
    (lambda: littoral.distance(SQUARE, 2.5), TypeError, "curves: "),
    (lambda: littoral.distance(SQUARE, np.zeros(3)), TypeError, "curves: "),
    (lambda: littoral.distance(SQUARE, [0, 1], signed="no"), TypeError, "signed: "),
    (lambda: littoral.distance(SQUARE, [0, 1], signed=3), TypeError, "signed: "),
    (lambda: littoral.distance(SQUARE, littoral.Curve([0, 1], value="x")), TypeError, "curves[0]"),
    (lambda: littoral.distance(SQUARE, littoral.Curve([0, 1], "no")), TypeError, "curves[0]"),
    (lambda: littoral.distance(SQUARE, CURVES, points=0), ValueError, "points: "),
    (lambda: littoral.distance(SQUARE, CURVES, signed=False), ValueError, "signed: "),
    (lambda: littoral.distance(SQUARE, CURVES, values=1), ValueError, "values: "),
    (lambda: littoral.distance(5, points=0), TypeError, "mesh: "),
    (lambda: littoral.SurfacePoint.vertex(1.7), TypeError, "v: "),
    (lambda: littoral.SurfacePoint.edge(0, "half"), TypeError, "t: "),
    (lambda: littoral.SurfacePoint(1, 0, 3), ValueError, "SurfacePoint: "),
    (lambda: littoral.PointCloud(None), TypeError, "P: expected real numbers (n x 3), got None"),
    (lambda: littoral.Polygons(np.eye(3), 5), TypeError, "faces: "),
    (lambda: littoral.Surface(), TypeError, "make a Mesh"),
    (lambda: SQUARE.welded("near"), TypeError, "distance: "),
    (lambda: SDF([1, 2, "x"]), TypeError, "points: "),
    (lambda: SDF.sample(8, bounds="all"), TypeError, "bounds: "),
    (lambda: SDF.sample(8, bounds=np.zeros((3, 2))), ValueError, "bounds: "),
    (lambda: SDF.sample(spacing="fine"), TypeError, "spacing: "),
    (lambda: SDF.sample(padding="wide"), TypeError, "padding: "),
    (lambda: SDF.sample("8"), ValueError, "resolution: expected a whole number of nodes, got '8'"),
    (lambda: SDF.sample([8, [8, 8]]), ValueError, "resolution: "),
    (lambda: SDF.sample(8, grid=VOLUME), ValueError, "resolution: "),
    (lambda: SDF.sample(grid=VOLUME, bounds=SDF.bounds), ValueError, "bounds: "),
    (lambda: SDF | 3, TypeError, "unite: "),
    (lambda: littoral.unite(SDF, SDF, "round"), TypeError, "blend: "),
    (lambda: littoral.SDF(CUBE, flip="no"), TypeError, "flip: "),
    (lambda: littoral.offset(CUBE, []), ValueError, "distances: expected at least one"),
    (lambda: littoral.offset(VOLUME, 0.1, resolution=64), ValueError, "resolution: "),
    (lambda: littoral.offset(VOLUME, 0.1, spacing=0.1), ValueError, "spacing: "),
    (lambda: littoral.offset(CUBE, 0.1, open="x"), TypeError, "open: "),
    (lambda: VOLUME.isosurface([0, 0.1]), TypeError, "level: expected one number, got [0, 0.1]"),
    (lambda: VOLUME.isosurface(10**400), ValueError, "level: "),
    (lambda: TETS.isosurface([0, 1, 1, 1], "x"), TypeError, "level: "),
    (lambda: IN_TETS.show(slice="x"), TypeError, "slice: "),
    (lambda: littoral.tet_distance(SQUARE, vertices=0), TypeError, "mesh: "),
    (lambda: littoral.tet_distance(TETS, vertices=0, flip=True), ValueError, "flip: "),
    (lambda: littoral.tet_distance(TETS, 5), TypeError, "mesh: expected a littoral surface"),
    (lambda: littoral.SDF(5), TypeError, "mesh: expected a littoral surface"),
    (lambda: littoral.offset(CUBE, 1e9), ValueError, "distances: 1e+09 times the size"),
    (lambda: littoral.tet_distance(TETS, vertices=0.5), TypeError, "vertices: "),
    (lambda: littoral.distance(TETS, points=0, vertices=0), TypeError, "points and vertices: "),
    (lambda: littoral.repair(CUBE, error="x"), TypeError, "error: "),
    (lambda: littoral.repair(CUBE, spacing="x"), TypeError, "spacing: "),
    (lambda: littoral.samples(CUBE, sharp="x"), TypeError, "sharp: "),
    (lambda: littoral.samples(CUBE, scales=["x"]), TypeError, "scales: "),
    (lambda: littoral.Factorization("x"), ValueError, "A: "),
    (lambda: littoral.examples.square(1.5), ValueError, "n: "),
    (lambda: littoral.examples.sphere("x"), ValueError, "subdivisions: "),
    (lambda: littoral.read(5), TypeError, "path: "),
    (lambda: FIELD.save(5), TypeError, "path: "),
    (lambda: littoral.show(5), TypeError, "expected a littoral.Field"),
    (lambda: littoral.set_threads("x"), ValueError, "threads: expected a number of threads or 0"),
    (lambda: littoral.set_memory_limit(True), ValueError, "limit: "),
    (lambda: littoral.progress(5), TypeError, "progress: "),
    (lambda: littoral.batch(5, len, "out"), TypeError, "items: "),
    (lambda: littoral.batch([1], 5, "out"), TypeError, "work: "),
    (lambda: littoral.batch([1], len, 5), TypeError, "out: "),
    (lambda: littoral.batch([1], "info", "out"), TypeError, "items: "),
    (lambda: littoral.batch([1], len, "out", to=[".ply"]), TypeError, "to: "),
    (lambda: littoral.batch([1], len, "out", to=5), TypeError, "to: "),
    (lambda: littoral.batch([1], len, "out", shard=3), TypeError, "shard: "),
    (lambda: littoral.batch([1], len, "out", retries=1.5), ValueError, "retries: "),
    (lambda: littoral.batch([1], len, "out", time_limit="x"), TypeError, "time_limit: "),
    (lambda: littoral.batch([1], len, "out", options=[1]), TypeError, "options: "),
    (lambda: littoral.batch([1], len, "out", options={"x": len}), TypeError, "options: "),
]  # fmt: skip


@pytest.mark.parametrize("row", range(len(WRONG)))
def test_wrong_arguments_are_errors_of_littoral_and_named(row: int) -> None:
    call, kind, begin = WRONG[row]
    with pytest.raises(littoral.Error, match="^" + re.escape(begin)) as raised:
        call()
    assert isinstance(raised.value, kind)
    assert raised.value.code != "internal"


def test_the_package_raises_no_plain_errors_of_python() -> None:
    plain = re.compile(r"raise (Type|Value|Index|Key|OS|Runtime|NotImplemented)Error\(")
    for path in Path(littoral.__file__).parent.rglob("*.py"):
        assert not plain.search(path.read_text()), path.name


def test_boxes_are_six_numbers_or_two_corners() -> None:
    six = SDF.bounds.ravel().tolist()
    for corners in (SDF.bounds, SDF.bounds.tolist()):
        a, b = SDF.sample(8, bounds=corners), SDF.sample(8, bounds=six)
        assert (a.values == b.values).all() and (a.origin == [0, 0, 0]).all()
        a, b = (littoral.signed_heat_grid(CUBE, resolution=8, bounds=x) for x in (corners, six))
        assert (a.values == b.values).all()
        c, d = (littoral.TetMesh.around(CUBE, resolution=5, bounds=x) for x in (corners, six))
        assert (c.points == d.points).all()


@pytest.mark.parametrize("callback", [5, "bar", lambda share: None, lambda a, b, c: None])
def test_what_cannot_be_told_of_progress_is_refused_at_the_start(callback: Any) -> None:
    with pytest.raises(littoral.ArgumentError, match="progress: expected a function of the share"):
        littoral.progress(callback)
    big = littoral.examples.square(40)
    with pytest.raises(littoral.ArgumentError, match="progress: expected a function of the share"):
        littoral.distance(big, points=0, progress=callback)


def test_what_takes_two_arguments_can_be_told(capsys: pytest.CaptureFixture[str]) -> None:
    told: list[Any] = []

    class Listener:
        def hear(self, share: float, stage: str, more: int = 0) -> None:
            told.append((share, stage))

    for callback in (Listener().hear, lambda *both: told.append(both), print):
        littoral.distance(SQUARE, points=0, progress=callback)
        if callback is not print:
            assert told.pop()[0] == 1
    assert capsys.readouterr().out.startswith("0")


def test_numbers_of_all_libraries_are_numbers() -> None:
    wanted = VOLUME.isosurface(0.125).points
    for level in (np.float32(0.125), np.array(0.125), Fraction(1, 8), Decimal("0.125")):
        assert (VOLUME.isosurface(level).points == wanted).all()
    assert VOLUME.isosurface(np.int64(0)).n_faces == VOLUME.isosurface(False).n_faces
    assert littoral.SurfacePoint.vertex(np.int32(3)) == littoral.SurfacePoint.vertex(3)
    assert SDF.sample(np.float64(8), spacing=None).shape == (8, 8, 8)
