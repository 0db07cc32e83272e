"""Meshes and clouds of other libraries, taken as they are. None of these is imported here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from ._arrays import Array, Floats, as_array
from ._errors import ArgumentError, InputError, UnsupportedError
from ._surfaces import Mesh, PointCloud, Polygons, Surface

Data: TypeAlias = dict[str, Array]


def _library(value: Any) -> str:
    """The package that the value's class, or one it derives from, comes from."""
    for cls in type(value).__mro__:
        root = cls.__module__.split(".")[0]
        if root in ("pyvista", "trimesh", "open3d", "meshio", "pytorch3d"):
            return root
    return ""


def _refused(value: Any, why: str) -> InputError:
    return InputError(f"mesh: a {type(value).__module__}.{type(value).__name__} {why}")


def _of_vtk(value: Any) -> Surface:
    """pyvista.PolyData, or the surface of a grid of cells."""
    if not hasattr(value, "GetNumberOfPolys"):
        for merged in ("combine", "cast_to_unstructured_grid"):  # of blocks; of images
            value = getattr(value, merged, lambda same=value: same)()
        try:
            value = value.extract_surface(algorithm="dataset_surface")
        except TypeError:  # before there was a choice
            value = value.extract_surface()
    if value.GetNumberOfStrips() > 0:
        value = value.triangulate()
    points = np.asarray(value.points)
    if value.GetNumberOfPolys() == 0:
        if value.GetNumberOfLines() > 0:
            raise _refused(value, "of lines has no faces; curves belong to a surface")
        normals = value.point_data.get("Normals", None)
        return PointCloud(points, None if normals is None else np.asarray(normals))
    padded = np.asarray(value.faces)  # of each face its size and its vertices
    if len(padded) == 4 * value.GetNumberOfPolys() and (padded[::4] == 3).all():
        return Mesh(points, padded.reshape(-1, 4)[:, 1:])
    return Polygons(points, [np.asarray(face) for face in value.irregular_faces])


def _of_trimesh(value: Any) -> Surface:
    if hasattr(value, "geometry") and hasattr(value, "dump"):  # a scene
        value = value.to_geometry() if hasattr(value, "to_geometry") else value.dump(True)
    if hasattr(value, "faces"):
        return Mesh(np.asarray(value.vertices), np.asarray(value.faces))
    if hasattr(value, "entities"):
        raise _refused(value, "has no faces; curves belong to a surface")
    return PointCloud(np.asarray(value.vertices))


def _of_open3d(value: Any) -> Surface:
    if hasattr(value, "triangles"):
        return Mesh(np.asarray(value.vertices), np.asarray(value.triangles))
    if hasattr(value, "triangle"):  # of open3d.t
        return Mesh(value.vertex.positions.cpu().numpy(), value.triangle.indices.cpu().numpy())
    if hasattr(value, "points") and hasattr(value, "normals"):
        normals = np.asarray(value.normals)
        return PointCloud(np.asarray(value.points), normals if len(normals) else None)
    if not hasattr(value, "point") or hasattr(value, "line"):
        raise _refused(value, "is neither triangles nor a point cloud")
    positions = value.point.positions.cpu().numpy()
    return PointCloud(
        positions, value.point.normals.cpu().numpy() if "normals" in value.point else None
    )


_CURVED_FACES = tuple(f"{name}{n}" for name in ("triangle", "quad") for n in range(1, 10))


def _of_meshio(value: Any) -> Surface:
    points = np.asarray(value.points)
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    faces: list[Array] = []
    for block in value.cells:
        if block.type in ("triangle", "quad") or block.type.startswith("polygon"):
            faces.extend(np.asarray(face) for face in block.data)
    others = sorted({block.type for block in value.cells} - {"vertex"})
    curved = [name for name in others if name.startswith(_CURVED_FACES)]
    if curved:
        raise _refused(
            value,
            f"of {', '.join(curved)} has curved faces; triangles, quads and polygons are taken",
        )
    if not faces and others:
        tets = (
            '; littoral.TetMesh(mesh.points, mesh.cells_dict["tetra"]) takes its tets'
            if "tetra" in others
            else ""
        )
        raise _refused(value, f"of {', '.join(others)} has no triangles, quads or polygons{tets}")
    if not faces:
        return PointCloud(points)
    if all(len(face) == 3 for face in faces):
        return Mesh(points, np.array(faces))
    return Polygons(points, faces)


_READ = {
    "pyvista": _of_vtk,
    "trimesh": _of_trimesh,
    "open3d": _of_open3d,
    "meshio": _of_meshio,
}


def as_surface(value: Any) -> Surface:
    """A littoral surface, or one made of what other libraries hold.

    Taken: littoral's own; `pyvista.PolyData` and grids (their surface); `trimesh.Trimesh`, scenes
    and point clouds; open3d's meshes and clouds; `meshio.Mesh`; pytorch3d's `Meshes` of one mesh;
    and pairs (V, F), of numpy, torch, jax or lists. Raises ArgumentError for anything else,
    InputError for those without faces or points.

    >>> import littoral
    >>> littoral.as_surface(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
    <littoral.Mesh: 3 vertices, 1 faces>
    """
    if isinstance(value, Surface):
        return value
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return Mesh(value[0], value[1])
    library = _library(value)
    if library in _READ:
        return _READ[library](value)
    if library == "pytorch3d":
        if len(value) != 1:
            raise InputError(f"mesh: expected a batch of one mesh, got {len(value)}")
        return Mesh(value.verts_packed(), value.faces_packed())
    if hasattr(value, "tets"):
        raise ArgumentError(
            f"mesh: a {type(value).__name__} is no surface; littoral.tet_distance and "
            "TetDistanceSolver measure through it, and their results show() and plot() cuts"
        )
    raise ArgumentError(
        "mesh: expected a littoral surface, a pair (V, F) or a mesh of pyvista, trimesh, open3d or "
        f"meshio, got {type(value).__module__}.{type(value).__name__}"
    )


def as_cloud_or_surface(V: Any, F: Any = None) -> Surface:
    """V, F: a surface where F holds integers, a cloud with normals where it holds real numbers."""
    if F is None:
        if isinstance(V, (Surface, tuple)) or _library(V) or hasattr(V, "tets"):
            return as_surface(V)
        points = as_array(V, "P")
        return as_surface(V) if points.ndim == 0 else PointCloud(points)
    second = as_array(F, "F")
    if second.dtype.kind in "iu":
        return Mesh(V, second)
    return PointCloud(V, second)


def _meshio_cells(surface: Surface) -> list[tuple[str, Any]]:
    """Blocks of faces of as many corners, in the order of the faces."""
    if surface.n_faces == 0:
        return [("vertex", np.arange(surface.n_vertices)[:, None])]
    sizes = np.diff(surface.face_offsets)
    starts = np.flatnonzero(np.diff(sizes, prepend=0))
    names = {3: "triangle", 4: "quad"}
    return [
        (
            names.get(int(sizes[a]), "polygon"),
            np.array(surface.corners[surface.face_offsets[a] : surface.face_offsets[b]]).reshape(
                b - a, -1
            ),
        )
        for a, b in zip(starts, [*starts[1:], len(sizes)], strict=True)
    ]


def _segments(lines: list[Floats]) -> tuple[Array, Array]:
    """All nodes (n x 3), and the segments between them (n x 2)."""
    points = np.concatenate([np.empty((0, 3)), *lines])
    ends = np.cumsum([len(line) for line in lines], dtype=int)
    first = np.setdiff1d(np.arange(len(points)), ends - 1)
    return points, np.column_stack([first, first + 1])


def _pyvista_surface(surface: Surface, points: Data, faces: Data) -> Any:
    import pyvista

    corners = surface.faces
    if surface.n_faces == 0:
        out = pyvista.PolyData(np.array(surface.points))
    elif isinstance(corners, list):
        out = pyvista.PolyData.from_irregular_faces(np.array(surface.points), corners)
    else:
        out = pyvista.PolyData.from_regular_faces(np.array(surface.points), np.array(corners))
    return _with_data(out, points, faces)


def _pyvista_lines(lines: list[Floats]) -> Any:
    import pyvista

    out = pyvista.PolyData()
    out.points = np.concatenate([np.empty((0, 3)), *lines])
    ends = np.cumsum([len(line) for line in lines], dtype=int)
    out.lines = np.concatenate(
        [np.empty(0, int)]
        + [np.r_[len(line), b - len(line) : b] for line, b in zip(lines, ends, strict=True)]
    )
    return out


def _pyvista_tets(points: Array, tets: Array, values: Data) -> Any:
    import pyvista

    kinds = np.full(len(tets), pyvista.CellType.TETRA, np.uint8)
    cells = np.column_stack([np.full(len(tets), 4), tets]).ravel()
    return _with_data(pyvista.UnstructuredGrid(cells, kinds, np.array(points)), values, {})


def _pyvista_volume(values: Array, spacing: Array, origin: Array) -> Any:
    import pyvista

    out = pyvista.ImageData(dimensions=values.shape, spacing=spacing, origin=origin)
    return _with_data(out, {"distance": values.ravel(order="F")}, {})


def _with_data(out: Any, points: Data, cells: Data) -> Any:
    for name, values in points.items():
        out.point_data[name] = np.array(values)
    for name, values in cells.items():
        out.cell_data[name] = np.array(values)
    return out


def _trimesh_surface(surface: Surface, points: Data, faces: Data) -> Any:
    import trimesh

    corners = surface.faces
    if surface.n_faces == 0 or isinstance(corners, list) or corners.shape[1] != 3:
        raise UnsupportedError("as_: trimesh holds triangles; this is a " + surface.kind)
    return trimesh.Trimesh(
        np.array(surface.points),
        np.array(corners),
        vertex_attributes={name: np.array(values) for name, values in points.items()},
        face_attributes={name: np.array(values) for name, values in faces.items()},
        process=False,
    )


def _meshio_surface(surface: Surface, points: Data, faces: Data) -> Any:
    import meshio

    cells = _meshio_cells(surface)
    ends = np.cumsum([len(block) for _, block in cells])[:-1]
    return meshio.Mesh(
        np.array(surface.points),
        cells,
        point_data={name: np.array(values) for name, values in points.items()},
        cell_data={name: np.split(np.array(values), ends) for name, values in faces.items()},
    )


def _meshio_lines(lines: list[Floats]) -> Any:
    import meshio

    points, segments = _segments(lines)
    return meshio.Mesh(points, [("line", segments)])


def _meshio_tets(points: Array, tets: Array, values: Data) -> Any:
    import meshio

    data = {name: np.array(each) for name, each in values.items()}
    return meshio.Mesh(np.array(points), [("tetra", np.array(tets))], point_data=data)


# What each library is handed, by what it is.
_WRITE: dict[str, dict[str, Callable[..., Any]]] = {
    "pyvista": {
        "surface": _pyvista_surface,
        "lines": _pyvista_lines,
        "tets": _pyvista_tets,
        "grid": _pyvista_volume,
    },
    "trimesh": {"surface": _trimesh_surface},
    "meshio": {"surface": _meshio_surface, "lines": _meshio_lines, "tets": _meshio_tets},
}


def check_kind(kind: str) -> None:
    """Raises InputError for a library that nothing is handed over to."""
    if not isinstance(kind, str) or kind not in _WRITE:
        raise InputError(f"as_: expected one of {', '.join(map(repr, _WRITE))}, got {kind!r}")


def handed_over(result: Any, kind: str) -> Any:
    """A result as an object of another library; a list of lines as one, of surfaces as a list.

    Results say what they are by `_parts`: the name in `_WRITE`, then what is written.
    """
    check_kind(kind)
    if isinstance(result, list) and result and not isinstance(result[0], np.ndarray):
        return [handed_over(each, kind) for each in result]
    what, *parts = ("lines", result) if isinstance(result, list) else result._parts()
    if what not in _WRITE[kind]:
        able = ", ".join(repr(name) for name in _WRITE if what in _WRITE[name])
        raise UnsupportedError(f"as_: {kind} is handed no {what}; possible: {able}")
    return _WRITE[kind][what](*parts)
