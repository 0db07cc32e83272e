"""The library itself; use the package littoral."""

from collections.abc import Callable, Sequence
import enum
from typing import Annotated, overload

import numpy
from numpy.typing import NDArray
import scipy.sparse

class Settings:
    def __init__(
        self, threads: int = 0, progress: object | None = None, memory_limit: float = 0.0
    ) -> None: ...

def method_families() -> list: ...

class Mesh:
    @staticmethod
    def of(
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        faces: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order="C", writable=False)],
    ) -> Mesh: ...
    @staticmethod
    def polygons(
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        corners: Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C", writable=False)],
        offsets: Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C", writable=False)],
    ) -> Mesh: ...
    @staticmethod
    def cloud(
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        normals: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)
        ],
    ) -> Mesh: ...
    @staticmethod
    def voxels(
        grid: Grid,
        inside: Annotated[NDArray[numpy.uint8], dict(shape=(None,), order="C", writable=False)],
    ) -> Mesh: ...
    @staticmethod
    def from_soup(soup: tuple) -> Mesh: ...
    def soup(self) -> tuple: ...
    @property
    def kind(self) -> str: ...
    @property
    def n_vertices(self) -> int: ...
    @property
    def n_faces(self) -> int: ...
    @property
    def n_edges(self) -> int: ...
    @property
    def n_components(self) -> int: ...
    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    @property
    def normals(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    @property
    def corners(self) -> Annotated[NDArray[numpy.int32], dict(writable=False)]: ...
    @property
    def face_offsets(self) -> Annotated[NDArray[numpy.int32], dict(writable=False)]: ...
    def edges(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order="C")]: ...
    def welded(self, distance: float) -> Mesh: ...
    def positions(
        self, arg: Points, /
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]: ...
    def interpolate(
        self,
        arg0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
        arg1: Points,
        /,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    def write(self, arg: str, /) -> None: ...

def mesh_extensions() -> str: ...
def read_mesh(arg: str, /) -> Mesh: ...

class Points:
    def __init__(
        self,
        on: Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C", writable=False)],
        element: Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C", writable=False)],
        b: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
    ) -> None: ...
    def __len__(self) -> int: ...
    def arrays(self) -> tuple: ...

class Sources:
    def __init__(self) -> None: ...
    def add_curve(self, arg0: Points, arg1: bool, arg2: float, /) -> None: ...
    def add_points(
        self,
        arg0: Points,
        arg1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
        /,
    ) -> None: ...
    def add_space_curve(
        self,
        arg0: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        arg1: bool,
        arg2: float,
        /,
    ) -> None: ...
    def add_chain(
        self,
        arg: Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C", writable=False)],
        /,
    ) -> None: ...
    def reversed(self) -> Sources: ...
    def sizes(self) -> tuple: ...
    def curve(self, arg: int, /) -> tuple[Points, bool, float]: ...
    def space_curve(
        self, arg: int, /
    ) -> tuple[
        Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")], bool, float
    ]: ...
    def chain(self, arg: int, /) -> list[int]: ...
    def points(self) -> Points: ...
    def point_values(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...

def read_sources(arg0: str, arg1: Mesh, /) -> Sources: ...

class Field:
    @staticmethod
    def of(
        mesh: Mesh,
        sources: Sources,
        values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
        confidence: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)
        ],
        refined: tuple | None,
        report: dict,
    ) -> Field: ...
    @property
    def values(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    @property
    def confidence(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    @property
    def sources(self) -> Sources: ...
    def refined(self) -> tuple | None: ...
    def report(self) -> dict: ...
    def write(self, arg: str, /) -> None: ...
    def write_page(self, arg: str, /) -> None: ...
    def write_picture(self, arg: str, /) -> None: ...

def isolines(
    arg0: Mesh,
    arg1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
    arg2: float,
    /,
) -> list[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]]: ...
def distance(
    mesh: Mesh,
    sources: Sources,
    method: str,
    options: Sequence[tuple[str, str]],
    settings: Settings | None,
) -> Field: ...

class DistanceSolver:
    def __init__(
        self, mesh: Mesh, method: str, options: Sequence[tuple[str, str]], settings: Settings | None
    ) -> None: ...
    def solve(self, sources: Sources, settings: Settings | None) -> Field: ...
    def report(self) -> dict: ...

def distance_matrix(
    mesh: Mesh,
    sources: Points,
    targets: Points | None,
    method: str,
    options: Sequence[tuple[str, str]],
    settings: Settings | None,
) -> tuple: ...

class Regions:
    @staticmethod
    def of(
        arg0: Mesh,
        arg1: Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C", writable=False)],
        arg2: tuple,
        arg3: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]],
        arg4: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]],
        arg5: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]],
        arg6: Sources,
        arg7: dict,
        /,
    ) -> Regions: ...
    @property
    def region(self) -> Annotated[NDArray[numpy.int32], dict(writable=False)]: ...
    def surface(self) -> tuple: ...
    @property
    def bounding(
        self,
    ) -> list[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]]: ...
    @property
    def nonbounding(
        self,
    ) -> list[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]]: ...
    @property
    def completed(
        self,
    ) -> list[Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]]: ...
    @property
    def bounding_sources(self) -> Sources: ...
    def report(self) -> dict: ...
    def write(self, arg: str, /) -> None: ...
    def write_page(self, arg: str, /) -> None: ...
    def write_picture(self, arg: str, /) -> None: ...

def winding(
    mesh: Mesh,
    curves: Sources,
    method: str,
    options: Sequence[tuple[str, str]],
    settings: Settings | None,
) -> Regions: ...

class Grid:
    def __init__(
        self, n: Sequence[int], origin: Sequence[float], spacing: Sequence[float]
    ) -> None: ...
    @staticmethod
    def around(
        sdf: Sdf,
        resolution: int | None,
        spacing: float | None,
        bounds: Sequence[float] | None,
        padding: float,
    ) -> Grid: ...
    @property
    def n(self) -> list[int]: ...
    @property
    def origin(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order="C")]: ...
    @property
    def spacing(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order="C")]: ...

class Volume:
    def __init__(
        self,
        grid: Grid,
        values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
    ) -> None: ...
    @property
    def grid(self) -> Grid: ...
    @property
    def values(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    def write(self, arg: str, /) -> None: ...
    def write_page(self, arg: str, /) -> None: ...
    def write_picture(self, arg: str, /) -> None: ...

def read_volume(arg: str, /) -> Volume: ...
def isosurface(
    volume: Volume, level: float, close_at_box: bool, settings: Settings | None
) -> Mesh: ...
@overload
def offset(
    volume: Volume, distances: Sequence[float], open: float, close: float, settings: Settings | None
) -> list[Mesh]: ...
@overload
def offset(
    shape: Sdf,
    grid: Grid,
    distances: Sequence[float],
    open: float,
    close: float,
    settings: Settings | None,
) -> list[Mesh]: ...

class Sdf:
    @staticmethod
    def of(
        input: Mesh,
        method: str,
        options: Sequence[tuple[str, str]],
        flip: bool,
        estimate_normals: bool,
        settings: Settings | None,
    ) -> Sdf: ...
    @staticmethod
    def of_volume(arg: Volume, /) -> Sdf: ...
    def at(
        self,
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        settings: Settings | None,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    def with_gradients(
        self,
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        settings: Settings | None,
    ) -> tuple: ...
    def closest(
        self,
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        settings: Settings | None,
    ) -> tuple: ...
    def winding_number(
        self,
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        settings: Settings | None,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    def confidence(
        self,
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        settings: Settings | None,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    def sample(self, grid: Grid, settings: Settings | None) -> Volume: ...
    def bounds(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]: ...
    def report(self) -> dict: ...

def unite(a: Sdf, b: Sdf, blend: float) -> Sdf: ...
def intersect(a: Sdf, b: Sdf, blend: float) -> Sdf: ...
def subtract(a: Sdf, b: Sdf, blend: float) -> Sdf: ...
def fit_tori(
    cloud: Mesh,
    options: Sequence[tuple[str, str]],
    flip: bool,
    estimate_normals: bool,
    settings: Settings | None,
) -> tuple: ...
def repair(
    input: Mesh,
    method: str,
    options: Sequence[tuple[str, str]],
    flip: bool,
    estimate_normals: bool,
    resolution: int | None,
    spacing: float | None,
    error: float,
    thicken: float,
    smallest_part: float,
    cavities: bool,
    remesh: bool,
    fit: bool,
    settings: Settings | None,
) -> tuple: ...

class TetMesh:
    def __init__(
        self,
        points: Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C", writable=False)],
        tets: Annotated[NDArray[numpy.int32], dict(shape=(None, 4), order="C", writable=False)],
    ) -> None: ...
    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    @property
    def tets(self) -> Annotated[NDArray[numpy.int32], dict(writable=False)]: ...
    def isosurface(
        self,
        values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
        level: float,
        settings: Settings | None,
    ) -> Mesh: ...

class TetSources:
    def __init__(
        self,
        surface: Mesh | None,
        vertices: Sequence[int],
        boundary: bool,
        flip: bool,
        estimate_normals: bool,
        values: Sequence[float],
    ) -> None: ...

class TetField:
    @staticmethod
    def of(
        mesh: TetMesh,
        values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C", writable=False)],
        report: dict,
    ) -> TetField: ...
    @property
    def values(self) -> Annotated[NDArray[numpy.float64], dict(writable=False)]: ...
    def report(self) -> dict: ...
    def write(self, arg: str, /) -> None: ...
    def write_page(self, path: str, axis: int, position: float | None) -> None: ...
    def write_picture(self, path: str, axis: int, position: float | None) -> None: ...

class TetDistanceSolver:
    def __init__(
        self,
        mesh: TetMesh,
        method: str,
        options: Sequence[tuple[str, str]],
        settings: Settings | None,
    ) -> None: ...
    def solve(self, sources: TetSources, settings: Settings | None) -> TetField: ...

def tets_around(
    surface: Mesh,
    resolution: int | None,
    spacing: float | None,
    bounds: Sequence[float] | None,
    padding: float,
    settings: Settings | None,
) -> TetMesh: ...
def read_tets(arg: str, /) -> TetMesh: ...

class SurfaceOperators:
    @property
    def L(self) -> scipy.sparse.csc_matrix[float]: ...
    @property
    def M(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    @property
    def G(self) -> scipy.sparse.csc_matrix[float]: ...
    @property
    def A(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    @property
    def D(self) -> scipy.sparse.csc_matrix[float]: ...
    @property
    def connection(self) -> scipy.sparse.csc_matrix["std::complex<double>"]: ...
    @property
    def connection_mass(
        self,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    @property
    def vector_at(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None, 2), order="C")]: ...

def surface_operators(mesh: Mesh, settings: Settings | None) -> SurfaceOperators: ...

class Factorization:
    @staticmethod
    def real(
        A: scipy.sparse.csc_matrix[float], laplacian: bool, settings: Settings | None
    ) -> Factorization: ...
    @staticmethod
    def complex(
        A: scipy.sparse.csc_matrix["std::complex<double>"], settings: Settings | None
    ) -> Factorization: ...
    def solve(
        self,
        B: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="F")],
        settings: Settings | None,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None, None), order="F")]: ...
    def solve_complex(
        self,
        B: Annotated[NDArray[numpy.complex128], dict(shape=(None, None), order="F")],
        settings: Settings | None,
    ) -> Annotated[NDArray[numpy.complex128], dict(shape=(None, None), order="F")]: ...
    @property
    def size(self) -> int: ...
    @property
    def nonzeros(self) -> float: ...

def batch(
    jobs: Sequence[tuple[str, str, Sequence[str]]],
    run: Callable,
    hash: Callable,
    folder: str,
    how: dict,
    settings: Settings | None,
) -> dict: ...

class SampleNumbers(enum.Enum):
    float16 = 0

    float32 = 1

    float64 = 2

class SampleOptions:
    def __init__(self) -> None: ...
    @property
    def resolution(self) -> int: ...
    @resolution.setter
    def resolution(self, arg: int, /) -> None: ...
    @property
    def surface(self) -> int: ...
    @surface.setter
    def surface(self, arg: int, /) -> None: ...
    @property
    def space(self) -> int: ...
    @space.setter
    def space(self, arg: int, /) -> None: ...
    @property
    def sharp(self) -> float: ...
    @sharp.setter
    def sharp(self, arg: float, /) -> None: ...
    @property
    def uniform(self) -> float: ...
    @uniform.setter
    def uniform(self, arg: float, /) -> None: ...
    @property
    def curvature(self) -> float: ...
    @curvature.setter
    def curvature(self, arg: float, /) -> None: ...
    @property
    def scales(self) -> list[float]: ...
    @scales.setter
    def scales(self, arg: Sequence[float], /) -> None: ...
    @property
    def margin(self) -> float: ...
    @margin.setter
    def margin(self, arg: float, /) -> None: ...
    @property
    def seed(self) -> int: ...
    @seed.setter
    def seed(self, arg: int, /) -> None: ...
    @property
    def numbers(self) -> SampleNumbers: ...
    @numbers.setter
    def numbers(self, arg: SampleNumbers, /) -> None: ...

class Samples:
    @property
    def centre(self) -> Annotated[NDArray[numpy.float64], dict(shape=(3), order="C")]: ...
    @property
    def half_side(self) -> float: ...
    @property
    def surface(self) -> Mesh: ...
    @property
    def surface_points(
        self,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]: ...
    @property
    def surface_normals(
        self,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]: ...
    @property
    def surface_confidence(
        self,
    ) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    @property
    def surface_kinds(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C")]: ...
    @property
    def points(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None, 3), order="C")]: ...
    @property
    def distances(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    @property
    def confidence(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    @property
    def kinds(self) -> Annotated[NDArray[numpy.int32], dict(shape=(None,), order="C")]: ...
    @property
    def deviations(self) -> Annotated[NDArray[numpy.float64], dict(shape=(None,), order="C")]: ...
    def card(self, arg: str, /) -> str: ...
    def report(self) -> dict: ...
    def write(self, arg0: str, arg1: str, /) -> None: ...

def sample(
    input: Mesh,
    options: SampleOptions,
    method: str,
    method_options: Sequence[tuple[str, str]],
    flip: bool,
    estimate_normals: bool,
    settings: Settings | None,
) -> Samples: ...
