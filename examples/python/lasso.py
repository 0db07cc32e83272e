"""The part of a model inside a sloppy lasso: the outline may have gaps, cross itself and shake.

usage: lasso.py MESH LASSO OUTPUT.obj
"""

import sys

import littoral


def main() -> None:
    mesh = littoral.read(sys.argv[1])
    lasso = littoral.read_sources(sys.argv[2], mesh)
    regions = littoral.winding(mesh, lasso)
    inside = mesh.faces[regions.region > 0]
    if len(inside) == 0:
        sys.exit("the lasso encloses nothing; is it drawn clockwise?")
    littoral.Mesh(mesh.points, inside).save(sys.argv[3])
    print(
        f"{len(inside)} of {mesh.n_faces} faces; {len(regions.completed)} gaps completed, "
        f"{len(regions.nonbounding)} curves bound nothing"
    )


if __name__ == "__main__":
    main()
