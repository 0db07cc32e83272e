"""Formats of other programs, beside files that trimesh and meshio write, and read again."""

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh
from conftest import Run

CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], float)
HEXAHEDRON = [[0, 1, 3, 2, 4, 5, 7, 6]]


def entries(run: Run, file: Path) -> dict[str, str]:
    """What `info` says of a file, by its labels."""
    rows = (row.split(":", 1) for row in run("info", file).stdout.splitlines() if ":" in row)
    return {label.strip(): text.strip() for label, text in rows}


def as_trimesh(run: Run, file: Path, folder: Path) -> trimesh.Trimesh:
    """A file as the program reads it, by way of .ply."""
    run("convert", file, "-o", folder / "read.ply")
    return trimesh.load(folder / "read.ply", process=False)


@pytest.mark.parametrize("extension", ["glb", "gltf"])
def test_scenes_of_trimesh(run: Run, tmp_path: Path, extension: str) -> None:
    scene = trimesh.Scene()
    turn = trimesh.transformations.rotation_matrix(1, [1, 2, 3], [4, 5, 6])
    ball = trimesh.creation.icosphere(2)
    scene.add_geometry(ball, transform=turn, node_name="ball")
    scene.add_geometry(ball, transform=trimesh.transformations.scale_matrix(3), node_name="again")
    scene.add_geometry(trimesh.creation.box([1, 2, 3]), node_name="box")
    folder = tmp_path / "scene"
    folder.mkdir()
    if extension == "gltf":
        for name, data in scene.export(file_type="gltf").items():
            (folder / name).write_bytes(data)
        (folder / "model.gltf").rename(folder / "a.gltf")
    else:
        (folder / f"a.{extension}").write_bytes(scene.export(file_type=extension))
    read = as_trimesh(run, folder / f"a.{extension}", tmp_path)
    whole = scene.to_geometry()
    assert len(read.faces) == len(whole.faces)
    assert read.is_watertight
    assert read.volume == pytest.approx(whole.volume, rel=1e-6)
    assert read.bounds == pytest.approx(whole.bounds, abs=1e-5)


def test_what_is_written_is_read_by_trimesh(run: Run, mesh: Path, tmp_path: Path) -> None:
    run(
        "distance",
        "square.obj",
        "--vertex",
        "0",
        "--method",
        "unsigned-heat",
        "-o",
        "d.glb",
        "-o",
        "d.ply",
    )
    values = trimesh.load(tmp_path / "d.ply", process=False).metadata["_ply_raw"]["vertex"]["data"]
    scene = trimesh.load(tmp_path / "d.glb", process=False)
    (read,) = scene.geometry.values()
    assert read.vertices.shape == (121, 3) and read.faces.shape == (200, 3)
    assert read.vertex_attributes["_DISTANCE"].ravel() == pytest.approx(
        values["distance"], rel=1e-6
    )
    assert len(np.unique(read.visual.vertex_attributes["color"], axis=0)) > 50
    colours = trimesh.load(tmp_path / "d.ply", process=False).visual.vertex_colors
    assert len(np.unique(colours, axis=0)) > 50
    # The field comes back, and so do its lines.
    run("contour", "d.glb", "--level", "0.25,0.5", "-o", "lines.obj")
    groups = [x for x in (tmp_path / "lines.obj").read_text().splitlines() if x.startswith("g ")]
    assert groups == ["g level_0.25", "g level_0.5"]
    run("contour", "d.glb", "--level", "0.25,0.5", "-o", "lines.svg")
    assert (tmp_path / "lines.svg").read_text().count('data-level="0.5"') >= 1


def test_printing_formats_go_round(run: Run, tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(2)
    ball.export(tmp_path / "ball.stl")
    run("convert", "ball.stl", "-o", "ball.3mf")
    run("convert", "ball.3mf", "-o", "again.stl")
    again = trimesh.load(tmp_path / "again.stl")
    assert again.volume == pytest.approx(ball.volume, rel=1e-6)


@pytest.mark.parametrize(
    "name, options",
    [
        ("a.msh", {"file_format": "gmsh22", "binary": False}),
        ("a.msh", {"file_format": "gmsh22", "binary": True}),
        ("a.msh", {"file_format": "gmsh", "binary": False}),
        ("a.msh", {"file_format": "gmsh", "binary": True}),
        ("a.vtu", {"binary": False}),
        ("a.vtu", {"binary": True, "compression": None}),
        ("a.vtu", {"binary": True, "compression": "zlib"}),
        ("a.vtk", {"binary": True}),
        ("a.mesh", {}),
    ],
)
def test_cells_of_meshio(run: Run, tmp_path: Path, name: str, options: dict[str, object]) -> None:
    # Medit has no values here, and meshio writes those of Gmsh as text wrongly.
    without = name == "a.mesh" or (name == "a.msh" and not options["binary"])
    values = {} if without else {"depth": CUBE @ [1.0, 2.0, 4.0]}
    meshio.write(
        tmp_path / name, meshio.Mesh(CUBE, [("hexahedron", HEXAHEDRON)], values), **options
    )
    said = entries(run, Path(name))
    assert said["tets"].startswith("6")
    boundary = as_trimesh(run, Path(name), tmp_path)
    assert boundary.is_watertight and abs(boundary.volume) == pytest.approx(1)
    if values:
        run("convert", name, "--field", "depth", "-o", "b.vtk")
        read = meshio.read(tmp_path / "b.vtk").point_data["depth"].ravel()
        assert read == pytest.approx(values["depth"])
    # Inside and outside of the solid.
    (tmp_path / "at.csv").write_text("x,y,z\n.5,.5,.5\n2,.5,.5\n")
    run("query", name, "--points", "at.csv", "-o", "out.csv")
    rows = (tmp_path / "out.csv").read_text().splitlines()[1:]
    assert [float(row.split(",")[-1]) for row in rows] == pytest.approx([-0.5, 1])


@pytest.mark.parametrize("name", ["a.msh", "a.vtu", "a.vtk", "a.mesh"])
def test_flat_cells_are_a_surface(run: Run, tmp_path: Path, name: str) -> None:
    flat = meshio.Mesh(CUBE, [("quad", [[0, 1, 3, 2], [0, 1, 5, 4]])])
    meshio.write(tmp_path / name, flat, **({"file_format": "gmsh"} if name == "a.msh" else {}))
    run("distance", name, "--vertex", "2", "--method", "unsigned-heat", "-o", "d.csv")
    assert len((tmp_path / "d.csv").read_text().splitlines()) == 9


def test_clouds_of_numpy(run: Run, tmp_path: Path) -> None:
    ball = trimesh.creation.icosphere(3)
    np.save(tmp_path / "a.npy", np.hstack([ball.vertices, ball.vertices]))
    np.savez(tmp_path / "a.npz", points=ball.vertices, normals=ball.vertices)
    np.save(tmp_path / "at.npy", [[0.0, 0, 0], [2, 0, 0]])
    for name in ("a.npy", "a.npz"):
        run("query", name, "--points", "at.npy", "-o", "out.csv")
        rows = (tmp_path / "out.csv").read_text().splitlines()[1:]
        assert [float(row.split(",")[-1]) for row in rows] == pytest.approx([-1, 1], abs=0.05)
    assert entries(run, Path("a.npy"))["vertices"] == str(len(ball.vertices))
    # An array of three axes is still a volume.
    np.save(tmp_path / "v.npy", np.zeros((3, 4, 5)))
    assert "nodes along axes: 3 4 5" in run("info", "v.npy").stdout
    np.save(tmp_path / "bad.npy", np.zeros((3, 5)))
    assert "this one is 3 x 5" in run("info", "bad.npy", status=2).stderr


def test_volumes_of_openvdb(run: Run, tmp_path: Path) -> None:
    x = (np.arange(20) - 9.5) / 10
    distance = np.sqrt(x[:, None, None] ** 2 + x[None, :, None] ** 2 + x[None, None] ** 2) - 0.6
    np.savez(tmp_path / "a.npz", distance=distance, origin=[-0.95] * 3, spacing=[0.1] * 3)
    run("convert", "a.npz", "-o", "a.vdb")
    run("contour", "a.vdb", "--level", "0", "-o", "a.stl")
    assert trimesh.load(tmp_path / "a.stl").volume == pytest.approx(
        4 / 3 * np.pi * 0.6**3, rel=0.03
    )


def test_required_extensions_are_named(run: Run, tmp_path: Path) -> None:
    document = {"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]}
    (tmp_path / "a.gltf").write_text(json.dumps(document))
    assert "'KHR_draco_mesh_compression'" in run("info", "a.gltf", status=2).stderr


def test_colours_of_a_ply_that_are_numbers_are_kept(run: Run, tmp_path: Path) -> None:
    """Scalars of these names are written as they were read, and nothing else as colours."""
    header = "ply\nformat ascii 1.0\nelement vertex 3\n"
    header += "".join(f"property float {x}\n" for x in ("x", "y", "z", "red", "green", "blue"))
    header += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "a.ply").write_text(
        header + "0 0 0 0.5 0 1\n1 0 0 0.25 0 1\n0 1 0 0 0.125 1\n3 0 1 2\n"
    )
    run("convert", "a.ply", "-o", "b.ply")
    for field, expected in (("red", [0.5, 0.25, 0]), ("green", [0, 0, 0.125])):
        run("convert", "b.ply", "--field", field, "-o", "c.csv")
        lines = (tmp_path / "c.csv").read_text().splitlines()
        assert [float(line.split(",")[-1]) for line in lines[1:]] == expected
    assert b"property double red" in (tmp_path / "b.ply").read_bytes()
    assert b"uchar red" not in (tmp_path / "b.ply").read_bytes()


def test_an_nrrd_of_colours_is_no_volume(run: Run, tmp_path: Path) -> None:
    for kinds, status in (("RGB-color domain domain", 2), ("domain domain domain", 0)):
        (tmp_path / "a.nrrd").write_text(
            f"NRRD0004\ntype: double\ndimension: 3\nsizes: 3 2 2\nkinds: {kinds}\n"
            "encoding: ascii\n\n" + " ".join(map(str, range(12))) + "\n"
        )
        made = run("info", "a.nrrd", status=status)
        assert ("'RGB-color'" in made.stderr) == (status != 0)
