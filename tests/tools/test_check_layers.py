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
        ("base/a.h", "spatial/b.h"),
        ("spatial/a.h", "solve/b.h"),
        ("solve/a.cpp", "spatial/b.h"),
        ("solve/a.cpp", "domain/b.h"),
        ("domain/a.h", "operators/b.h"),
        ("operators/a.h", "sources/b.h"),
        ("contour/a.cpp", "operators/b.h"),
        ("sources/a.h", "methods/b.h"),
        ("methods/heat/signed_heat.cpp", "domain/mesh/surface_mesh.h"),
        ("methods/a.h", "io/b.h"),
        ("io/a.h", "methods/b.h"),
        ("api/a.h", "cli/b.h"),
    ],
)
def test_an_include_pointing_up_is_a_violation(tmp_path: Path, name: str, include: str) -> None:
    write(tmp_path, name, "littoral/types.h", include)
    (found,) = check_layers.violations(tmp_path)
    assert found.startswith(f"src/{name}:2: ")
    assert check_layers.main([str(tmp_path)]) == 1


@pytest.mark.parametrize(
    ("name", "include"),
    [
        ("spatial/a.h", "base/b.h"),
        ("domain/a.h", "spatial/b.h"),
        ("operators/a.h", "base/b.h"),
        ("sources/a.h", "domain/b.h"),
        ("methods/heat/signed_heat.cpp", "solve/poisson/poisson.h"),
        ("methods/geodesic/fast_marching.cpp", "domain/mesh/surface_mesh.h"),
        ("methods/geodesic/exact_polyhedral.h", "domain/mesh/surface_mesh.h"),
        ("methods/cutting.cpp", "domain/mesh/surface_mesh.h"),
        ("io/a.cpp", "domain/b.h"),
        ("api/a.h", "contour/b.h"),
        ("cli/main.cpp", "api/b.h"),
        ("cli/main.cpp", "cli/b.h"),
    ],
)
def test_an_include_pointing_down_is_none(tmp_path: Path, name: str, include: str) -> None:
    write(tmp_path, name, include)
    assert check_layers.violations(tmp_path) == []
    assert check_layers.main([str(tmp_path)]) == 0


def test_a_folder_that_is_no_layer_is_a_violation(tmp_path: Path) -> None:
    write(tmp_path, "helpers/a.h")
    (found,) = check_layers.violations(tmp_path)
    assert "'helpers' is not a layer" in found


@pytest.mark.parametrize("name", ["base/a.h", "methods/heat/a.cpp", "io/a.cpp"])
def test_only_plain_public_headers_are_for_every_layer(tmp_path: Path, name: str) -> None:
    write(tmp_path, name, "littoral/types.h", "littoral/surface.h")
    (found,) = check_layers.violations(tmp_path)
    assert found.startswith(f"src/{name}:2: ")


def test_api_and_cli_may_include_every_public_header(tmp_path: Path) -> None:
    write(tmp_path, "api/surface/a.cpp", "littoral/surface.h")
    write(tmp_path, "cli/a.cpp", "littoral/surface.h")
    assert check_layers.violations(tmp_path) == []


def test_public_headers_include_public_ones_the_standard_library_and_eigen(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    header = tmp_path / "include" / "littoral" / "a.h"
    header.parent.mkdir(parents=True)
    lines = ['"littoral/types.h"', "<vector>", "<Eigen/Core>", '"api/method.h"', "<png.h>"]
    header.write_text("".join(f"#include {line}\n" for line in lines))
    found = check_layers.violations(tmp_path)
    assert [line.split(": ")[0] for line in found] == [
        "include/littoral/a.h:4",
        "include/littoral/a.h:5",
    ]


@pytest.mark.parametrize("header", ["unistd.h", "sys/wait.h", "dlfcn.h", "csignal", "poll.h"])
def test_what_belongs_to_one_system_stands_in_the_platform_folder(
    tmp_path: Path, header: str
) -> None:
    for name in ("base/platform/a.cpp", "io/a.cpp"):
        path = tmp_path / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#include <vector>\n#include <{header}>\n")
    (found,) = check_layers.violations(tmp_path)
    assert found == f"src/io/a.cpp:2: <{header}> belongs in src/base/platform/"
