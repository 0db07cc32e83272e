"""Every code of docs/guides/messages.md, provoked by the program, or the reason why not."""

import os
import re
import subprocess
from pathlib import Path

import provoked_errors  # noqa: F401
import provoked_warnings  # noqa: F401
import pytest
from conftest import PROGRAM, square
from provoking import MADE, Words
from test_messages import PAGE, codes

# What only happens inside other programs, on other machines, or never.
NOT_BY_THE_PROGRAM = {
    "internal": "no input is known that gives it",
    "cancelled": "Ctrl-C ends the program with status 130; Python and JavaScript raise it",
    "io-error": "OpenVDB's own errors, in a module that not every build has",
    "system": "the system has to run out of processes or ports",
    "solve-failed": "no input is known that gives it",
    "diverged": "no input is known that gives it",
    "pieces-lost": "no curve is known that loses pieces",
    "curve-crosses-itself": "no curve is known that gives it",
    "constraints-unmet": "no small input is known",
    "directions-misaligned": "no small input is known",
    "free-edges": "no small input is known",
    "result-unsound": "no small input is known",
    "time-scale-raised": "meshes are large on which heat is lost in round-off",
    "sizes-differ": "arrays are given by Python and JavaScript",
}


def run_in(folder: Path, words: Words) -> subprocess.CompletedProcess[str]:
    (folder / "square.obj").write_text(square(10))
    environment = os.environ | {"PATH": ""}  # no tetgen
    call = [PROGRAM, *map(str, words)]
    return subprocess.run(
        call, cwd=folder, capture_output=True, text=True, env=environment, timeout=60
    )


@pytest.mark.parametrize("code", sorted(MADE))
def test_a_code_is_provoked(tmp_path: Path, code: str) -> None:
    done = run_in(tmp_path, MADE[code](tmp_path))
    assert f"[{code}]" in done.stderr, done.stderr
    is_error = code in codes("Errors")
    assert (done.returncode in (1, 2)) == is_error
    assert is_error == any(
        line.endswith(f" [{code}]") for line in done.stderr.splitlines() if " error: " in line
    )


def test_options_of_the_page_exist() -> None:
    verbs = (PAGE.parents[1] / "reference/verbs.md").read_text()
    for verb in ("distance", "winding", "sdf", "pairs"):
        call = [PROGRAM, verb, "--help-all"]
        verbs += subprocess.run(call, capture_output=True, text=True).stdout
    known = set(re.findall(r"--[a-z][a-z-]*", verbs))
    assert set(re.findall(r"`(--[a-z-]+)", PAGE.read_text())) <= known


def test_every_code_has_its_place() -> None:
    known = set(codes("Errors") + codes("Warnings"))
    assert set(MADE) | set(NOT_BY_THE_PROGRAM) == known
    assert not set(MADE) & set(NOT_BY_THE_PROGRAM)
