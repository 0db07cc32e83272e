"""Arrays of all kinds through the Python package.

    PYTHONPATH=build/release/python build/venv/bin/python fuzz/arrays.py CASES [FIRST_SEED]
    ... fuzz/arrays.py atheris [OPTION_OF_LIBFUZZER...]     where PyPI's atheris is installed

A case makes the arguments of one call, then disguises or damages its arrays. Disguised ones
(another type, order, stride, byte order, container) hold the same numbers, so the answer must be
the same to the last bit. Damaged ones must give an answer without NaN, or raise an error that says
what was expected.
"""

from __future__ import annotations

import contextlib
import random
import sys
from collections.abc import Callable
from typing import Any

import numpy as np

BY_ATHERIS = sys.argv[1:2] == ["atheris"]
if BY_ATHERIS:
    import atheris

with atheris.instrument_imports(["littoral"]) if BY_ATHERIS else contextlib.nullcontext():
    import littoral
    from littoral.compat import igl


class Seeded:
    """Choices by a seed; atheris makes them from its bytes."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)

    def up_to(self, last: int) -> int:
        return self._random.randint(0, last)


class FromBytes:
    def __init__(self, data: bytes) -> None:
        self._data = atheris.FuzzedDataProvider(data)

    def up_to(self, last: int) -> int:
        chosen: int = self._data.ConsumeIntInRange(0, last)
        return chosen


def pick(choices: Any, options: Any) -> Any:
    return options[choices.up_to(len(options) - 1)]


# ------------------------------------------------------------------ calls


def disc(choices: Any) -> tuple[np.ndarray, np.ndarray]:
    """A square or a sphere, with whole numbers times 1/4 for coordinates: any floating type holds
    them."""
    made = pick(choices, [littoral.examples.square, littoral.examples.quads])(4)
    if choices.up_to(2) == 0:
        made = littoral.examples.cube()
    return np.array(made.points), np.array(made.faces, np.int64)


def points_around(choices: Any) -> np.ndarray:
    n = choices.up_to(5)
    return np.array([[choices.up_to(16) / 8 - 0.5 for _ in range(3)] for _ in range(n)]).reshape(
        -1, 3
    )


def distance(V: Any, F: Any, at: Any) -> Any:
    return littoral.distance((V, F), points=at, method="unsigned-heat").values


def along(V: Any, F: Any, at: Any) -> Any:
    return littoral.distance((V, F), curves=at, method="signed-heat").values


def matrix(V: Any, F: Any, at: Any) -> Any:
    return littoral.distance_matrix((V, F), at, method="exact")


def cloud(V: Any, F: Any, at: Any) -> Any:
    del F
    return littoral.distance(littoral.PointCloud(V), points=at, method="unsigned-heat").values


def surface(V: Any, F: Any, at: Any) -> Any:
    mesh = littoral.Mesh(V, F)
    return np.concatenate([mesh.positions(at).ravel(), mesh.corners, mesh.face_offsets])


def winding(V: Any, F: Any, at: Any) -> Any:
    return littoral.winding((V, F), at).region


def space(V: Any, F: Any, X: Any) -> Any:
    sdf = littoral.SDF(V, F)
    near = sdf.closest(X)
    parts = [sdf(X), sdf.winding_number(X), sdf.confidence(X), near.distance, near.point.ravel()]
    return np.concatenate([*parts, sdf.gradient(X).ravel()])


def oriented(V: Any, N: Any, X: Any) -> Any:
    return littoral.SDF(V, N)(X)


def theirs(V: Any, F: Any, X: Any) -> Any:
    return np.asarray(igl.signed_distance(X, V, F)[0])


def volume(values: Any, spacing: Any, X: Any) -> Any:
    sdf = littoral.sdf_of_volume(littoral.Volume(values, spacing))
    return sdf(X)


def voxels(inside: Any, spacing: Any, X: Any) -> Any:
    del X
    return littoral.Voxels(inside, spacing).points.ravel()


def isolines(V: Any, F: Any, values: Any) -> Any:
    return np.concatenate([np.empty(0), *map(np.ravel, littoral.isolines((V, F), values, 0.3))])


def tets(V: Any, T: Any, at: Any) -> Any:
    return littoral.tet_distance(littoral.TetMesh(V, T), vertices=at).values


def case_of(choices: Any) -> tuple[Callable[..., Any], list[Any]]:
    """A call and right arguments for it."""
    call = pick(
        choices,
        [distance, along, matrix, cloud, surface, winding, space, oriented, theirs, volume, voxels,
         isolines, tets],
    )  # fmt: skip
    if call in (volume, voxels):
        shape = [2 + choices.up_to(2) for _ in range(3)]
        values = np.array([choices.up_to(8) for _ in range(int(np.prod(shape)))]).reshape(shape)
        return call, [values + (call is voxels), np.full(3, 0.25), points_around(choices)]
    if call is tets:
        return call, [np.eye(4, 3), np.array([[0, 1, 2, 3]]), np.array([choices.up_to(3)])]
    V, F = disc(choices)
    if call in (matrix, winding, space, theirs) and F.shape[1] == 4:  # of triangles
        F = np.concatenate([F[:, [0, 1, 2]], F[:, [0, 2, 3]]])
    if call in (space, theirs):
        return call, [V, F, points_around(choices)]
    if call is oriented:
        return call, [V, V - V.mean(axis=0) + [0, 0, 0.25], points_around(choices)]
    if call is isolines:
        return call, [V, F, V[:, 0] + V[:, 1]]
    if call in (along, winding):
        first = choices.up_to(len(F) - 1)
        return call, [V, F, np.append(F[first], F[first][0])]
    return call, [V, F, np.array([choices.up_to(len(V) - 1) for _ in range(1 + choices.up_to(3))])]


# ------------------------------------------------------------------ arrays


class OnlyDlpack:
    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __dlpack__(self, **options: Any) -> Any:
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self) -> Any:
        return self.array.__dlpack_device__()


class OnlyArray:
    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return self.array


def disguised(array: np.ndarray, choices: Any) -> Any:
    """The same numbers in another type, layout or container."""
    kinds = "fd" if array.dtype.kind == "f" else "bhilqBHILQ"
    fitting = [k for k in kinds if np.array_equal(array.astype(k).astype(array.dtype), array)]
    if array.dtype.kind == "f":  # float32 in means float32 out
        fitting = ["d"]
    out = array.astype(pick(choices, fitting))
    for _ in range(choices.up_to(2)):
        how = choices.up_to(6)
        if how == 0:
            out = np.asfortranarray(out)
        elif how == 1:
            axis = choices.up_to(out.ndim - 1)
            out = np.flip(np.flip(out, axis).copy(), axis)
        elif how == 2:
            wide = np.full((*out.shape[:-1], 2 * out.shape[-1]), 77, out.dtype)
            wide[..., ::2] = out
            out = wide[..., ::2]
        elif how == 3:
            shifted = np.empty(out.nbytes + 1, np.uint8)[1:].view(out.dtype).reshape(out.shape)
            shifted[...] = out
            out = shifted  # not aligned
        elif how == 4:
            out = out.astype(out.dtype.newbyteorder())
        elif how == 5:
            out = out.view()
            out.flags.writeable = False
        elif out.ndim > 1:
            out = np.moveaxis(np.ascontiguousarray(np.moveaxis(out, 0, -1)), -1, 0)
    container = choices.up_to(5)
    if container == 0 and out.size:
        return out.tolist()
    if container == 1:
        return OnlyArray(out)
    if container == 2 and out.flags.writeable and out.dtype.isnative:
        return OnlyDlpack(out)
    if container == 3:
        return np.ma.masked_array(out)
    return out


# What is no array of numbers.
ODD = [None, "text", b"\0", 3, 2.5, [], {}, [[]], object(), np.array(7), -1, [1, [2]], True, ...]
ODD += [float("nan"), 2**70, [None], np.ma.masked, [True], {1, 2}, range(3), [0.5, None], "0"]


def damaged(array: np.ndarray, choices: Any) -> Any:
    """The array with something wrong, or at least odd, about it."""
    out = array.copy()
    how = choices.up_to(11)
    odd = [np.nan, np.inf, -np.inf, 1e300, -1e300, 5e-324, -0.0, 1e17]
    whole = [-1, -2, len(array), 2**31 - 1, 2**31, -(2**31), 2**62, 10**6]
    if how <= 3 and out.size:
        flat = out.reshape(-1)
        for _ in range(1 + choices.up_to(2)):
            flat[choices.up_to(flat.size - 1)] = pick(
                choices, odd if out.dtype.kind == "f" else whole
            )
        return out
    if how == 4:
        return out[: choices.up_to(len(out))]
    if how == 5:
        return out[..., :-1]
    if how == 6:
        return out[..., None]
    if how == 7:
        kinds = ["c16", "f4", "f2", "?", "O", "S4", "U4", "M8[s]", "m8[s]", "V4", "u8", "i1"]
        with np.errstate(all="ignore"):
            try:
                return out.astype(pick(choices, kinds))
            except (TypeError, ValueError):
                return None
    if how == 8:
        return np.broadcast_to(out.reshape(-1)[:1], out.shape) if out.size else None
    if how == 9:
        return pick(choices, ODD)
    if how == 10:
        return np.concatenate([out, out])
    return out.T


# ------------------------------------------------------------------ what must be so


def check(choices: Any) -> str:
    """Runs one case; returns "same", "answered" or "refused", and raises what should not be."""
    call, arguments = case_of(choices)
    if choices.up_to(1):
        expected = call(*arguments)
        hidden = [disguised(each, choices) for each in arguments]
        np.testing.assert_array_equal(call(*hidden), expected, err_msg=call.__name__)
        return "same"
    which = choices.up_to(len(arguments) - 1)
    arguments[which] = damaged(arguments[which], choices)
    try:
        answer = call(*arguments)
    except littoral.Error as error:
        assert len(str(error)) > 8, f"{call.__name__}: {error!r} says nothing"
        return "refused"
    if call not in (surface, volume, voxels):  # which repeat what they are given
        assert not np.isnan(answer).any(), f"{call.__name__}{arguments}: {answer}"
    return "answered"


def main() -> None:
    if BY_ATHERIS:
        atheris.Setup([sys.argv[0], *sys.argv[2:]], lambda data: check(FromBytes(data)) and None)
        atheris.Fuzz()
        return
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    outcomes: dict[str, int] = {}
    for seed in range(first, first + count):
        try:
            outcome = check(Seeded(seed))
        except BaseException as error:
            error.add_note(f"seed {seed}") if hasattr(error, "add_note") else None
            print(f"seed {seed}: {type(error).__name__}: {error}", file=sys.stderr)
            outcome = "FAILED"
        outcomes[outcome] = outcomes.get(outcome, 0) + 1
    print(", ".join(f"{n} {name}" for name, n in sorted(outcomes.items())), f"of {count} cases")
    sys.exit("FAILED" in outcomes)


if __name__ == "__main__":
    main()
