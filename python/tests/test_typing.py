"""What the type checker sees."""

import subprocess
import sys
from pathlib import Path

import pytest

SNIPPET = """
import littoral

def look(tets: littoral.TetMesh, mesh: littoral.Mesh) -> None:
    reveal_type(littoral.distance(tets, points=0))
    reveal_type(littoral.distance(mesh, points=0))
    reveal_type(littoral.distance(mesh, points=0, as_="trimesh"))
    reveal_type(mesh.welded(0.1))
"""


@pytest.mark.slow
def test_distance_is_typed_by_what_it_runs_on(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    (tmp_path / "look.py").write_text(SNIPPET)
    source = Path(__file__).parents[1]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "look.py"],
        cwd=tmp_path,
        env={"MYPYPATH": str(source), "PATH": ""},
        capture_output=True,
        text=True,
    )
    types = [line.split('"')[1] for line in done.stdout.splitlines() if "Revealed" in line]
    assert [name.rsplit(".")[-1] for name in types] == ["TetField", "Field", "Any", "Mesh"]
