"""Meshes of other libraries, there and back; each test skips without its library."""

from __future__ import annotations

import numpy as np
import pytest

import littoral
from littoral._foreign import handed_over

QUAD_AND_TRIANGLE = (
    np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0]], float),
    [[0, 1, 2, 3], [1, 4, 2]],
)


@pytest.fixture
def cube():
    mesh = littoral.examples.cube()
    return np.array(mesh.points), np.array(mesh.faces)


def same(surface, points, faces):
    np.testing.assert_array_equal(surface.points, points)
    assert [list(f) for f in surface.faces] == [list(f) for f in faces]


def test_pairs_and_nonsense(cube):
    same(littoral.as_surface(cube), *cube)
    same(littoral.as_surface([cube[0].tolist(), cube[1].tolist()]), *cube)
    for nonsense in (3, "mesh", None, cube[0], (cube[0],)):
        with pytest.raises(TypeError, match="expected a littoral surface"):
            littoral.as_surface(nonsense)


@pytest.mark.filterwarnings("error")
def test_polydata(cube):
    pyvista = pytest.importorskip("pyvista")
    triangles = pyvista.PolyData.from_regular_faces(*cube)
    assert isinstance(littoral.as_surface(triangles), littoral.Mesh)
    same(littoral.as_surface(triangles), *cube)
    mixed = pyvista.PolyData.from_irregular_faces(*QUAD_AND_TRIANGLE)
    same(littoral.as_surface(mixed), *QUAD_AND_TRIANGLE)
    triangles.verts = [1, 0]
    triangles.lines = [2, 0, 1]
    same(littoral.as_surface(triangles), *cube)


@pytest.mark.filterwarnings("error")
def test_polydata_without_faces():
    pyvista = pytest.importorskip("pyvista")
    points = np.random.default_rng(0).normal(size=(20, 3))
    cloud = pyvista.PolyData(points)
    got = littoral.as_surface(cloud)
    assert isinstance(got, littoral.PointCloud) and got.normals.shape == (0, 3)
    cloud["Normals"] = points
    np.testing.assert_array_equal(littoral.as_surface(cloud).normals, points)
    with pytest.raises(ValueError, match="of lines"):
        littoral.as_surface(pyvista.Line())
    with pytest.raises(ValueError, match="no points"):
        littoral.as_surface(pyvista.PolyData())


@pytest.mark.filterwarnings("error")
def test_strips_become_triangles():
    pyvista = pytest.importorskip("pyvista")
    sphere = pyvista.Sphere(theta_resolution=8, phi_resolution=6)
    strips = sphere.strip()
    assert strips.n_strips > 0
    got = littoral.as_surface(strips)
    assert got.kind == "triangle mesh" and got.n_faces == sphere.n_cells


@pytest.mark.filterwarnings("error")
def test_grids_of_pyvista():
    pyvista = pytest.importorskip("pyvista")
    image = pyvista.ImageData(dimensions=(3, 3, 3))
    for grid in (image, image.cast_to_unstructured_grid(), pyvista.MultiBlock([image])):
        got = littoral.as_surface(grid)
        assert (got.n_vertices, got.n_faces, got.n_components) == (26, 24, 1)
    sphere = pyvista.Sphere()
    cells = littoral.as_surface(sphere.cast_to_unstructured_grid())
    assert (cells.n_vertices, cells.n_faces) == (sphere.n_points, sphere.n_cells)


def test_trimesh(cube):
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.Trimesh(*cube, process=False)
    same(littoral.as_surface(mesh), *cube)
    moved = trimesh.Trimesh(cube[0] + 3, cube[1], process=False)
    scene = littoral.as_surface(trimesh.Scene([mesh, moved]))
    assert (scene.n_vertices, scene.n_faces, scene.n_components) == (16, 24, 2)
    cloud = littoral.as_surface(trimesh.PointCloud(cube[0]))
    assert isinstance(cloud, littoral.PointCloud) and cloud.n_vertices == 8
    with pytest.raises(ValueError, match="no faces"):
        littoral.as_surface(trimesh.load_path(cube[0][:4].reshape(2, 2, 3)))
    with pytest.raises(ValueError, match="no faces"):
        littoral.as_surface(trimesh.Trimesh())


def test_meshio(cube):
    meshio = pytest.importorskip("meshio")
    same(littoral.as_surface(meshio.Mesh(cube[0], [("triangle", cube[1])])), *cube)
    points, faces = QUAD_AND_TRIANGLE
    blocks = [("quad", faces[:1]), ("triangle", faces[1:]), ("line", [[0, 1]])]
    same(littoral.as_surface(meshio.Mesh(points, blocks)), points, faces)
    same(littoral.as_surface(meshio.Mesh(points[:, :2], blocks)), points, faces)
    quads = littoral.as_surface(meshio.Mesh(points, blocks[:1]))
    assert quads.kind == "polygon mesh" and quads.n_faces == 1
    pentagon = littoral.as_surface(meshio.Mesh(points, [("polygon", [[0, 1, 4, 2, 3]])]))
    assert pentagon.corners.tolist() == [0, 1, 4, 2, 3]
    assert littoral.as_surface(meshio.Mesh(points, [])).kind == "point cloud"
    with pytest.raises(ValueError, match=r"of tetra has no triangles.* littoral\.TetMesh\("):
        littoral.as_surface(meshio.Mesh(points, [("tetra", [[0, 1, 2, 4]])]))


def test_open3d(cube):
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(cube[0]), open3d.utility.Vector3iVector(cube[1])
    )
    same(littoral.as_surface(mesh), *cube)
    tensors = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
    same(littoral.as_surface(tensors), *cube)
    assert littoral.distance(tensors, points=0).values.dtype == np.float32
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(cube[0]))
    assert littoral.as_surface(cloud).normals.shape == (0, 3)
    cloud.normals = open3d.utility.Vector3dVector(cube[0])
    for each in (cloud, open3d.t.geometry.PointCloud.from_legacy(cloud)):
        got = littoral.as_surface(each)
        np.testing.assert_array_equal(got.points, cube[0])
        np.testing.assert_array_equal(got.normals, cube[0])
    for lines in (open3d.geometry.LineSet(), open3d.t.geometry.LineSet()):
        with pytest.raises(ValueError, match="neither triangles nor a point cloud"):
            littoral.as_surface(lines)


@pytest.mark.parametrize("kind", ["pyvista", "trimesh", "meshio"])
@pytest.mark.parametrize("shape", ["triangles", "quads", "mixed", "cloud"])
def test_there_and_back(kind, shape):
    pytest.importorskip(kind)
    surface = {
        "triangles": littoral.examples.cube(),
        "quads": littoral.examples.quads(3),
        "mixed": littoral.Polygons(*QUAD_AND_TRIANGLE),
        "cloud": littoral.PointCloud(QUAD_AND_TRIANGLE[0]),
    }[shape]
    field = littoral.distance(surface, points=1, method="unsigned-heat")
    if kind == "trimesh" and shape != "triangles":
        with pytest.raises(littoral.UnsupportedError, match="trimesh holds triangles"):
            handed_over(field, kind)
        return
    out = handed_over(field, kind)
    back = littoral.as_surface(out)
    assert back.kind == surface.kind
    np.testing.assert_array_equal(back.points, surface.points)
    np.testing.assert_array_equal(back.corners, surface.corners)
    np.testing.assert_array_equal(back.face_offsets, surface.face_offsets)
    data = out.vertex_attributes if kind == "trimesh" else out.point_data
    np.testing.assert_array_equal(data["distance"], field.values)
    data["distance"][1] = 7  # their own: nothing of littoral changes
    assert field.values[1] < 1e-9


@pytest.mark.parametrize("kind", ["pyvista", "trimesh", "meshio"])
def test_what_calls_return(kind, square):
    """Every call with `as_`, beside the same without."""
    pytest.importorskip(kind)
    curve, loop = [2, 11, 20], [20, 24, 60, 56, 20]
    named = "vertex_attributes" if kind == "trimesh" else "point_data"
    distance = littoral.distance(square, curve).values
    for got in (
        littoral.distance(square, curve, as_=kind),
        littoral.DistanceSolver(square).solve(curve, as_=kind),
    ):
        np.testing.assert_array_equal(getattr(got, named)["distance"], distance)
    got = littoral.winding(square, loop, as_=kind)
    faces = got.face_attributes if kind == "trimesh" else got.cell_data
    region = faces["winding"][0] if kind == "meshio" else faces["winding"]
    np.testing.assert_array_equal(region, littoral.winding(square, loop).region)
    volume = littoral.SDF(littoral.examples.sphere(2)).sample(12)
    (shell,) = littoral.offset(volume, 0.2, as_=kind)
    for one, other in (
        (shell, littoral.offset(volume, 0.2)[0]),
        (volume.isosurface(0.1, as_=kind), volume.isosurface(0.1)),
    ):
        np.testing.assert_array_equal(littoral.as_surface(one).points, other.points)
        np.testing.assert_array_equal(littoral.as_surface(one).corners, other.corners)


def test_lines_and_tets_of_calls(square):
    pyvista = pytest.importorskip("pyvista")
    levels = [-0.1, 0.1]
    lines = littoral.offset_curves(square, [4, 13, 22], levels)
    got = littoral.offset_curves(square, [4, 13, 22], levels, as_="pyvista")
    assert got.n_cells == len(lines) == 2
    for i, line in enumerate(lines):
        np.testing.assert_array_equal(got.get_cell(i).points, line)
    assert littoral.isolines(square, np.zeros(81), 5, as_="pyvista").n_cells == 0
    assert littoral.isolines(square, np.zeros(81), 5) == []
    tets = littoral.TetMesh(np.eye(4, 3), [[0, 1, 2, 3]])
    cells = littoral.tet_distance(tets, vertices=0, as_="pyvista")
    assert cells.n_cells == 1 and isinstance(cells, pyvista.UnstructuredGrid)
    np.testing.assert_array_equal(cells["distance"], littoral.tet_distance(tets, vertices=0))
    sdf = littoral.SDF(littoral.examples.sphere(2))
    grid = sdf.sample(8, as_="pyvista")
    volume = sdf.sample(8)
    at = [volume.nodes()[2, 3, 4], grid.points[2 + 8 * (3 + 8 * 4)]]
    np.testing.assert_allclose(at[0], at[1], atol=1e-12)
    assert grid["distance"][2 + 8 * (3 + 8 * 4)] == volume.values[2, 3, 4]


def test_lines_and_tets_for_meshio(square):
    pytest.importorskip("meshio")
    lines = littoral.offset_curves(square, [4, 13, 22], [-0.1, 0.1])
    got = littoral.offset_curves(square, [4, 13, 22], [-0.1, 0.1], as_="meshio")
    np.testing.assert_array_equal(got.points, np.concatenate(lines))
    segments = got.cells_dict["line"]
    assert len(segments) == sum(len(line) - 1 for line in lines)
    np.testing.assert_array_equal(np.diff(segments, axis=1), 1)
    assert len(lines[0]) - 1 not in segments[:, 0]  # nothing from one line to the next
    tets = littoral.TetMesh(np.eye(4, 3), [[0, 1, 2, 3]])
    cells = littoral.tet_distance(tets, vertices=0, as_="meshio")
    np.testing.assert_array_equal(cells.cells_dict["tetra"], tets.tets)
    assert len(cells.point_data["distance"]) == 4


def test_what_is_not_handed_over(square):
    with pytest.raises(littoral.UnsupportedError, match=r"meshio is handed no grid.*'pyvista'"):
        littoral.SDF(littoral.examples.cube()).sample(4, as_="meshio")
    with pytest.raises(littoral.UnsupportedError, match="trimesh is handed no lines"):
        littoral.isolines(square, square.points[:, 0], 0.3, as_="trimesh")
    with pytest.raises(ValueError, match="'pyvista', 'trimesh', 'meshio', got 'open3d'"):
        littoral.distance(square, points=0, as_="open3d")


@pytest.fixture
def accessor_mesh():
    pyvista = pytest.importorskip("pyvista")
    pytest.importorskip("littoral.pyvista")
    mesh = littoral.examples.sphere(2)
    return pyvista.PolyData.from_regular_faces(np.array(mesh.points), np.array(mesh.faces))


def test_distance_of_polydata(accessor_mesh):
    expected = littoral.distance(accessor_mesh, points=[0, 5]).values
    got = accessor_mesh.littoral.distance(points=[0, 5])
    np.testing.assert_array_equal(got["distance"], expected)
    assert "distance" not in accessor_mesh.point_data
    heat = accessor_mesh.littoral.distance(curves=[[0, 5]], method="signed-heat", signed=False)
    assert heat["distance"].min() >= -0.1
    before = got["distance"].max()
    accessor_mesh.points *= 2  # is seen
    assert accessor_mesh.littoral.distance(points=[0, 5])["distance"].max() == pytest.approx(
        2 * before
    )
    with pytest.raises(ValueError, match="no-such"):
        accessor_mesh.littoral.distance(points=0, method="no-such")


def test_options_of_polydata_may_be_lists_and_arrays(accessor_mesh):
    pyvista = pytest.importorskip("pyvista")
    points = pyvista.PolyData(np.array([[0, 0, 0], [3, 0, 0.0]]))
    for values, expected in (([-1, -0.5], 0.5), (np.array([-1, -0.75]), 0.25), ((-1, -0.5), 0.5)):
        assert points.littoral.sdf([2, 0, 0], values=values) == pytest.approx(expected)
    one = accessor_mesh.littoral.offset(np.array(0.1), resolution=12)
    assert one.bounds[1] == pytest.approx(1.1, abs=0.05)


def test_winding_of_polydata(square, accessor_mesh):
    flat = handed_over(square, "pyvista")
    loop = [20, 24, 60, 56, 20]
    got = flat.littoral.winding(loop)
    np.testing.assert_array_equal(got["winding"], littoral.winding(square, loop).region)
    assert set(got["winding"]) == {0, 1}
    flat.verts = [1, 0]
    with pytest.raises(ValueError, match="faces only"):
        flat.littoral.winding(loop)


def test_space_around_polydata(accessor_mesh):
    got = accessor_mesh.littoral.sdf([[0, 0, 0], [0, 0, 2]])
    np.testing.assert_allclose(got, [-1, 1], atol=0.05)
    (shell,) = accessor_mesh.littoral.offset([0.5], resolution=24)
    radii = np.linalg.norm(shell.points, axis=1)
    np.testing.assert_allclose(radii, 1.5, atol=0.05)
    assert accessor_mesh.littoral.offset(0.5, resolution=24).n_points == shell.n_points


def test_curved_faces_are_refused_even_among_flat_ones():
    meshio = pytest.importorskip("meshio")
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.5, 0, 0], [0.5, 0.5, 0], [0, 0.5, 0]])
    cells = [("triangle", [[0, 2, 1]]), ("triangle6", [[0, 1, 2, 3, 4, 5]])]
    with pytest.raises(littoral.InputError, match="of triangle6 has curved faces"):
        littoral.as_surface(meshio.Mesh(points, cells))
    assert littoral.as_surface(meshio.Mesh(points, cells[:1])).n_faces == 1
