"""Checks that includes only point down the layers of the library.

A layer may include itself and everything below it along the arrows of BELOW. Methods are written
against operators, not meshes: they may not include domain, except for the few in NEEDS_DOMAIN whose
algorithms walk the mesh itself.

Public headers are include/littoral/*.h. Those in PLAIN hold types that every layer may include; the
others, only api, desk and cli. They include each other, the standard library and Eigen, nothing
else.

What belongs to one system (ONE_SYSTEM) is included in src/base/platform alone.

usage: check_layers.py [ROOT]    prints one line per violation; exit status 1 if there are any
"""

import re
import sys
from pathlib import Path

BELOW: dict[str, set[str]] = {
    "base": set(),
    "spatial": {"base"},
    "solve": {"base"},
    "domain": {"spatial", "solve"},
    "operators": {"domain"},
    "contour": {"domain"},
    "sources": {"operators", "contour"},
    "methods": {"sources"},
    "io": {"sources"},
    "api": {"methods", "io"},
    "desk": {"api"},
    "cli": {"desk"},
    "vdb": {"io"},  # a module that io loads, not linked with it
}
WITHOUT_DOMAIN = "methods"
NEEDS_DOMAIN = ("fast_marching", "marching_stencils", "exact_polyhedral", "cutting", "tet_paths")
PLAIN = {
    "context",
    "error",
    "methods",
    "options",
    "polygon_soup",
    "report",
    "sources",
    "surface_point",
    "tet_mesh",
    "types",
    "volume",
}
ABOVE_PUBLIC = ("api", "cli", "desk")
PLATFORM = "src/base/platform/"
ONE_SYSTEM = re.compile(
    r"^\s*#\s*include\s*<((?:sys|arpa|netinet)/.*|unistd\.h|dlfcn\.h|signal\.h|csignal|poll\.h"
    r"|fcntl\.h|malloc\.h|xmmintrin\.h|pthread\.h|spawn\.h|windows\.h)>"
)
PUBLIC_INCLUDE = re.compile(r'^\s*#\s*include\s*"littoral/(\w+)\.h"')
ANY_INCLUDE = re.compile(r"^\s*#\s*include\s*(\S+)")
ALLOWED_IN_PUBLIC = re.compile(r'"littoral/\w+\.h"|<[a-z_]+>|<Eigen/\w+>')
SUFFIXES = {".h", ".cpp"}
INCLUDE = re.compile(rf'^\s*#\s*include\s*"({"|".join(BELOW)})/')


def reachable(layer: str) -> set[str]:
    """The layer itself and all layers below it."""
    return {layer}.union(*(reachable(below) for below in BELOW[layer]))


def allowed(layer: str, stem: str) -> set[str]:
    """The layers that file `stem` of `layer` may include."""
    layers = reachable(layer)
    if layer == WITHOUT_DOMAIN and not stem.startswith(NEEDS_DOMAIN):
        layers.discard("domain")
    return layers


def layer_of(path: Path, src: Path) -> str:
    """src/io/surface/read_obj.cpp -> io."""
    return path.relative_to(src).parts[0]


def violations(root: Path) -> list[str]:
    """One line per include that does not point down, and per file outside the known layers."""
    src = root / "src"
    found = []
    for path in sorted(p for p in src.rglob("*") if p.suffix in SUFFIXES):
        where = path.relative_to(root)
        layer = layer_of(path, src)
        if layer not in BELOW:
            found.append(f"{where}: '{layer}' is not a layer; there are: {', '.join(BELOW)}")
            continue
        may = allowed(layer, path.stem)
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if (match := INCLUDE.match(line)) and (target := match[1]) not in may:
                names = ", ".join(name for name in BELOW if name in may)
                found.append(f"{where}:{number}: {layer} may not include {target} ({names})")
            elif (
                (match := PUBLIC_INCLUDE.match(line))
                and match[1] not in PLAIN
                and layer not in ABOVE_PUBLIC
            ):
                found.append(
                    f"{where}:{number}: {layer} may not include littoral/{match[1]}.h; only"
                    f" {' and '.join(ABOVE_PUBLIC)} may"
                )
            elif (match := ONE_SYSTEM.match(line)) and not where.as_posix().startswith(PLATFORM):
                found.append(f"{where}:{number}: <{match[1]}> belongs in {PLATFORM}")
    return found + public_violations(root)


def public_violations(root: Path) -> list[str]:
    """One line per include of a public header that is not public, standard or Eigen's."""
    found = []
    for path in sorted((root / "include").rglob("*.h")):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            if (match := ANY_INCLUDE.match(line)) and not ALLOWED_IN_PUBLIC.fullmatch(match[1]):
                found.append(
                    f"{path.relative_to(root)}:{number}: a public header may not include {match[1]}"
                )
    return found


def main(arguments: list[str]) -> int:
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    found = violations(root)
    print("\n".join(found) if found else "layers: every include points down")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
