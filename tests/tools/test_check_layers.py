"""The layer check finds includes that point up, and only those."""

from pathlib import Path

import check_layers
import pytest


def write(root: Path, name: str, *includes: str) -> None:
    path = root / "src" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("".join(f'#include "{include}"\n' for include in includes))


@pytest.mark.parametrize(
    ("name", "include"),
    [
        ("littoral/base/a.h", "littoral/spatial/b.h"),
        ("littoral/spatial/a.h", "littoral/solve/b.h"),
        ("littoral/solve/a.cpp", "littoral/spatial/b.h"),
        ("littoral/solve/a.cpp", "littoral/domain/b.h"),
        ("littoral/domain/a.h", "littoral/operators/b.h"),
        ("littoral/operators/a.h", "littoral/sources/b.h"),
        ("littoral/contour/a.cpp", "littoral/operators/b.h"),
        ("littoral/sources/a.h", "littoral/methods/b.h"),
        ("littoral/methods/signed_heat.cpp", "littoral/domain/surface_mesh.h"),
        ("littoral/methods/a.h", "littoral/io/b.h"),
        ("littoral/io/a.h", "littoral/methods/b.h"),
        ("littoral/api/a.h", "cli/b.h"),
    ],
)
def test_an_include_pointing_up_is_a_violation(tmp_path: Path, name: str, include: str) -> None:
    write(tmp_path, name, "littoral/base/types.h", include)
    (found,) = check_layers.violations(tmp_path)
    assert found.startswith(f"src/{name}:2: ")
    assert check_layers.main([str(tmp_path)]) == 1


@pytest.mark.parametrize(
    ("name", "include"),
    [
        ("littoral/spatial/a.h", "littoral/base/b.h"),
        ("littoral/domain/a.h", "littoral/spatial/b.h"),
        ("littoral/operators/a.h", "littoral/base/b.h"),
        ("littoral/sources/a.h", "littoral/domain/b.h"),
        ("littoral/methods/signed_heat.cpp", "littoral/solve/poisson.h"),
        ("littoral/methods/fast_marching.cpp", "littoral/domain/surface_mesh.h"),
        ("littoral/methods/exact_polyhedral.h", "littoral/domain/surface_mesh.h"),
        ("littoral/methods/cutting.cpp", "littoral/domain/surface_mesh.h"),
        ("littoral/io/a.cpp", "littoral/domain/b.h"),
        ("littoral/api/a.h", "littoral/contour/b.h"),
        ("cli/main.cpp", "littoral/api/b.h"),
        ("cli/main.cpp", "cli/b.h"),
    ],
)
def test_an_include_pointing_down_is_none(tmp_path: Path, name: str, include: str) -> None:
    write(tmp_path, name, include)
    assert check_layers.violations(tmp_path) == []
    assert check_layers.main([str(tmp_path)]) == 0


def test_a_folder_that_is_no_layer_is_a_violation(tmp_path: Path) -> None:
    write(tmp_path, "littoral/helpers/a.h")
    (found,) = check_layers.violations(tmp_path)
    assert "'helpers' is not a layer" in found
