"""--json: one schema for all verbs, also where they fail."""

import json
from pathlib import Path
from typing import Any

import pytest
from conftest import Run
from test_volumes import sphere, write_nrrd

SCHEMA = Path(__file__).parents[2] / "docs/reference/report.schema.json"
TYPES: dict[str, Any] = {
    "object": dict,
    "array": list,
    "string": str,
    "integer": int,
    "number": (int, float),
    "boolean": bool,
}


def check(value: Any, schema: dict[str, Any], at: str = "report") -> None:
    """The part of JSON Schema that the file uses."""
    known = {"$schema", "title", "type", "required", "properties", "additionalProperties"}
    assert set(schema) <= known | {"items", "enum", "const"}, at
    if "const" in schema:
        assert value == schema["const"], at
    if "enum" in schema:
        assert value in schema["enum"], at
    names = schema.get("type", [])
    types = tuple(TYPES[name] for name in ([names] if isinstance(names, str) else names))
    if types:
        assert any(isinstance(value, t) for t in types), at
        assert isinstance(value, bool) == (types == (bool,)), at
    if isinstance(value, list) and "items" in schema:
        for i, item in enumerate(value):
            check(item, schema["items"], f"{at}[{i}]")
    if isinstance(value, dict):
        assert set(schema.get("required", [])) <= set(value), at
        others = schema.get("additionalProperties", {})
        for key, item in value.items():
            inner = schema.get("properties", {}).get(key, others)
            assert inner is not False, f"{at} has {key}"
            check(item, inner, f"{at}.{key}")


def report(run: Run, *arguments: object, status: int = 0) -> dict[str, Any]:
    out: dict[str, Any] = json.loads(run(*arguments, "--json", status=status).stdout)
    check(out, json.loads(SCHEMA.read_text()))
    assert ("error" in out) == (status != 0)
    return out


def test_reports_of_surfaces(run: Run, mesh: Path) -> None:
    out = report(run, "distance", "square.obj", "-s", "curve.txt", "-o", "a.txt", "-o", "a.csv")
    assert out["verb"] == "distance"
    assert out["inputs"] == ["square.obj", "curve.txt"]
    assert out["outputs"] == ["a.txt", "a.csv"]
    assert out["values"]["distance"]["count"] == 121
    assert out["values"]["distance"]["min"] == pytest.approx(-0.5, abs=1e-6)
    assert out["values"]["distance"]["max"] == pytest.approx(0.5, abs=1e-6)
    out = report(run, "pairs", "square.obj", "--vertex", 0, "--method", "exact", "-o", "a.npy")
    assert out["values"]["distance"]["max"] == pytest.approx(2**0.5)
    assert report(run, "winding", "square.obj", "-s", "curve.txt", "-o", "a.txt")["values"]


def test_reports_of_space(run: Run, mesh: Path) -> None:
    write_nrrd(mesh.parent / "d.nrrd", 9, sphere)
    out = report(run, "sdf", "d.nrrd", "--resolution", 9, "-o", "a.npy")
    assert out["grid"]["shape"] == [9, 9, 9]
    assert out["grid"]["origin"] == pytest.approx([-1.5, -1.5, -1.5])
    assert out["grid"]["spacing"] == pytest.approx([3 / 8] * 3)
    out = report(run, "offset", "d.nrrd", "--distance", "0.1", "-o", "a.ply")
    assert out["grid"]["spacing"] == pytest.approx([0.25] * 3)
    (mesh.parent / "p.csv").write_text("x,y,z\n0,0,0.5\n")
    out = report(run, "query", "d.nrrd", "--points", "p.csv", "-o", "a.csv")
    assert out["inputs"] == ["d.nrrd", "p.csv"]
    assert out["values"]["distance"]["count"] == 1


@pytest.mark.parametrize(
    ("arguments", "status", "kind", "words"),
    [
        (("distance", "no.obj", "--vertex=0", "-o", "a.txt"), 2, "io", "no.obj"),
        (("distance", "square.obj", "-o", "a.txt"), 2, "input", "nothing to measure"),
        (("distance", "square.obj", "--vertex=0", "-o", "a.png2"), 2, "unsupported", "a.png2"),
        (("distance", "square.obj", "--vertex=0", "-o", "no/a.txt"), 1, "io", "no/a.txt"),
        (("distance", "square.obj", "--virtex=0", "-o", "a.txt"), 2, "usage", "--vertex"),
        (("sdf", "square.obj"), 2, "usage", "--output"),
        (("info", "no.obj"), 2, "io", "no.obj"),
        (("quary",), 2, "usage", "query"),
    ],
)
def test_failures_are_reported(
    run: Run, mesh: Path, arguments: tuple[str, ...], status: int, kind: str, words: str
) -> None:
    out = report(run, *arguments, status=status)
    assert out["status"] == "failed"
    assert out["error"]["kind"] == kind
    assert words in out["error"]["message"]
    assert out["error"]["exit_status"] == status
    assert out["verb"] == arguments[0]
