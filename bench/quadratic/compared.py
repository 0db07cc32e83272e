"""The methods that accuracy.py compares, littoral's and others', behind one call.

usage: compared.py NAME MESH.npz VERTEX OUT.npy      one of the others, on arrays

Others run in a process of their own with a time limit, as some of them end the process, or never
end, on meshes they cannot take.
"""

import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from surface import Floats, Ints, Run, limited, subdivided

LIMIT = 60  # processor seconds for one run of one method

# Label of each method; those of others begin with their package's name.
LABELS = {
    "potpourri3d heat": "heat (potpourri3d)",
    "unsigned-heat": "heat (littoral)",
    "potpourri3d marching": "fast marching (potpourri3d)",
    "fast-marching": "fast marching (littoral)",
    "belyaev-fayolle": "Belyaev-Fayolle",
    "exact": "exact polyhedral",
    "quadratic": "quadratic",
}
# The paper's four: its HM and FMM are potpourri3d's.
OF_PAPER = ["potpourri3d heat", "potpourri3d marching", "belyaev-fayolle", "quadratic"]
# The paper solves Belyaev and Fayolle's problem by CVXPY, to its optimum.
OPTIONS = {"belyaev-fayolle": ["--tolerance", "2e-4"]}


def others(name: str, points: Floats, faces: Ints, vertex: int) -> Floats:
    """Distance from a vertex by another program, in this process."""
    if name == "pygeodesic":
        from pygeodesic import geodesic

        exact = geodesic.PyGeodesicAlgorithmExact(points, faces.astype(np.int32))
        return np.asarray(exact.geodesicDistances(np.array([vertex], dtype=np.int32), None)[0])
    import potpourri3d

    if name == "potpourri3d heat":
        return np.asarray(
            potpourri3d.MeshHeatMethodDistanceSolver(points, faces).compute_distance(vertex)
        )
    marching = potpourri3d.MeshFastMarchingDistanceSolver(points, faces)
    return np.asarray(marching.compute_distance([[(vertex, [])]]))


def linear(name: str, points: Floats, faces: Ints, vertex: int) -> Floats | None:
    """Distance at the vertices from one of them; none where the method fails."""
    try:
        if not name.startswith(("potpourri3d", "pygeodesic")):
            return Run(points, faces, vertex, name, OPTIONS.get(name, []), limit=LIMIT).values
        with tempfile.TemporaryDirectory() as folder:
            mesh, out = Path(folder) / "mesh.npz", Path(folder) / "out.npy"
            np.savez(mesh, points=points, faces=faces)
            command = [sys.executable, __file__, name, str(mesh), str(vertex), str(out)]
            subprocess.run(command, check=True, capture_output=True, preexec_fn=limited(LIMIT))
            return np.asarray(np.load(out)).ravel()
    except subprocess.CalledProcessError as error:
        said = error.stderr if isinstance(error.stderr, str) else error.stderr.decode()
        reason = said.strip().splitlines()[-1:] or [f"ended by signal {-error.returncode}"]
        print(f"{name}: {reason[0][:160]}", file=sys.stderr)
        return None


def quadratic(
    points: Floats, faces: Ints, source: int, levels: int, options: Sequence[str] = ()
) -> Floats | None:
    """The quadratic method's distance at the vertices of `levels` subdivisions."""
    try:
        extra = [*options, "--subdivide", str(2**levels)]
        run = Run(points, faces, source, "quadratic", extra, limit=LIMIT)
    except subprocess.CalledProcessError as error:
        print(f"quadratic: {type(error).__name__}", file=sys.stderr)
        return None
    fine, f = subdivided(points, faces, levels)
    # Vertices may coincide where parts touch: the same place in the same coarse triangle.
    n = len(faces)
    here = np.concatenate([fine[f.ravel()], (np.arange(len(f)).repeat(3) % n)[:, None]], 1)
    parent = np.arange(len(run.faces)).repeat(3) // 4**levels
    there = np.concatenate([run.points[run.faces.ravel()], parent[:, None]], 1)
    apart, at = cKDTree(there).query(here)
    assert apart.max() < 1e-9, "not the places that were asked for"
    values = np.empty(len(fine))
    values[f.ravel()] = run.values[run.faces.ravel()[at]]
    return values


if __name__ == "__main__":
    given = np.load(sys.argv[2])
    np.save(sys.argv[4], others(sys.argv[1], given["points"], given["faces"], int(sys.argv[3])))
