"""Distance and inside/outside for geometry that is broken.

On surfaces: `distance`, `DistanceSolver`, `distance_matrix`, `winding`, `isolines`,
`offset_curves`. In space: `SDF`, `Volume`, `offset`, `unite`, `intersect`, `subtract`, `fit_tori`,
`repair`, `samples`. Through tets: `TetMesh`, `tet_distance`. Many inputs: `batch`. Files: `read`,
`read_volume`, `read_tets`. Lengths are in the unit of the input.
"""

from . import examples
from ._batch import BatchFailures, BatchSummary, batch
from ._display import show
from ._distance import (
    DistanceSolver,
    Field,
    distance,
    distance_matrix,
    isolines,
    offset_curves,
)
from ._errors import (
    ArgumentError,
    Cancelled,
    Error,
    IndexOutOfRange,
    InputError,
    IoError,
    SolveError,
    UnsupportedError,
)
from ._files import read, read_sources, read_tets, read_volume
from ._foreign import as_surface
from ._methods import Method, Option, methods
from ._operators import Factorization, Operators, operators
from ._regions import Regions, winding
from ._repair import Repaired, repair
from ._report import Report, ReportWarning
from ._samples import Samples, samples
from ._settings import progress, set_memory_limit, set_threads
from ._sources import Curve, FaceChain, SurfacePoint
from ._space import (
    SDF,
    Closest,
    fit_tori,
    intersect,
    offset,
    sdf_of_volume,
    signed_heat_grid,
    subtract,
    unite,
    winding_number,
)
from ._surfaces import Mesh, PointCloud, Polygons, Surface, Voxels
from ._tets import TetDistanceSolver, TetField, TetMesh, tet_distance
from ._volumes import Volume

__version__ = "0.1.0"

__all__ = [
    "SDF",
    "ArgumentError",
    "BatchFailures",
    "BatchSummary",
    "Cancelled",
    "Closest",
    "Curve",
    "DistanceSolver",
    "Error",
    "FaceChain",
    "Factorization",
    "Field",
    "IndexOutOfRange",
    "InputError",
    "IoError",
    "Mesh",
    "Method",
    "Operators",
    "Option",
    "PointCloud",
    "Polygons",
    "Regions",
    "Repaired",
    "Report",
    "ReportWarning",
    "Samples",
    "SolveError",
    "Surface",
    "SurfacePoint",
    "TetDistanceSolver",
    "TetField",
    "TetMesh",
    "UnsupportedError",
    "Volume",
    "Voxels",
    "as_surface",
    "batch",
    "distance",
    "distance_matrix",
    "examples",
    "fit_tori",
    "intersect",
    "isolines",
    "methods",
    "offset",
    "offset_curves",
    "operators",
    "progress",
    "read",
    "read_sources",
    "read_tets",
    "read_volume",
    "repair",
    "samples",
    "sdf_of_volume",
    "set_memory_limit",
    "set_threads",
    "show",
    "signed_heat_grid",
    "subtract",
    "tet_distance",
    "unite",
    "winding",
    "winding_number",
]
