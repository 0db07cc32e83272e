"""Help by verb, completion scripts, and runs that take too long."""

import json
import subprocess
from pathlib import Path

import pytest
from conftest import PROGRAM, Run, square


def test_help_leaves_the_options_of_methods_to_help_all(run: Run) -> None:
    short, full = run("distance", "--help").stdout, run("distance", "--help-all").stdout
    assert "--time-scale" not in short
    assert "--help-all adds" in short
    assert "--time-scale" in full
    assert "--sources" in short
    assert "--sources" in full
    assert run("help", "distance").stdout == short
    assert "--help-all" not in run("formats", "--help").stdout.splitlines()[-1]


@pytest.mark.parametrize("verb", ["query", "samples", "view", "render"])
def test_help_names_the_methods_that_a_verb_runs(run: Run, verb: str) -> None:
    text = " ".join(run(verb, "--help").stdout.split())
    full = run(verb, "--help-all").stdout
    assert "closest-point, hopf-cole, planar, log-sum-exp, tori [default auto]" in text
    assert "signed-heat" not in text
    assert "--time-scale" not in full  # of signed-heat, which needs a grid
    assert "--noisy" not in text
    assert "--noisy" in full
    assert "--help-all adds" in text


def test_options_of_methods_go_with_trace(run: Run, mesh: Path) -> None:
    failed = run("render", "square.obj", "--noisy", "-o", "a.png", status=2)
    assert "option --noisy goes with --trace" in failed.stderr


def test_help_shows_no_inner_marks(run: Run) -> None:
    text = run("help", "--markdown").stdout
    assert "{" not in text
    assert "| `--no-resume` | do everything again |" in text
    assert "`BESIDE`" in text


def completed(tmp_path: Path, script: str, words: str) -> list[str]:
    """What bash offers for the last of the words."""
    (tmp_path / "complete.sh").write_text(script)
    last = len(words.split(" ")) - 1
    command = (
        f"source complete.sh; COMP_WORDS=({words}); [ '{words[-1]}' = ' ' ] && COMP_WORDS+=(''); "
        f'COMP_CWORD={last}; _littoral; printf "%s\\n" "${{COMPREPLY[@]}}"'
    )
    result = subprocess.run(
        ["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    return result.stdout.split()


def test_completion(run: Run, mesh: Path) -> None:
    script = run("completion", "bash").stdout
    assert completed(mesh.parent, script, "littoral di") == ["distance"]
    assert completed(mesh.parent, script, "littoral query --poi") == ["--points"]
    assert completed(mesh.parent, script, "littoral info squ") == ["square.obj"]
    assert completed(mesh.parent, script, "littoral distance squ") == ["square.obj"]
    assert completed(mesh.parent, script, "littoral distance --method exa") == ["exact"]
    assert completed(mesh.parent, script, "littoral distance m --constraint lev") == ["level-sets"]
    assert completed(mesh.parent, script, "littoral completion z") == ["zsh"]
    assert completed(mesh.parent, script, "littoral help r") == ["repair", "render"]
    for shell in ("zsh", "fish"):
        assert "curve-vertices" in run("completion", shell).stdout
    assert "bash" in run("completion", "bas", status=2).stderr


def test_a_time_limit_ends_the_run(tmp_path: Path) -> None:
    (tmp_path / "large.obj").write_text(square(300))
    arguments = ["distance", "large.obj", "--vertex=0", "--json", "-o", "a.ply"]
    for limit, status in (("0.05", 1), ("1000", 0)):
        result = subprocess.run(
            [PROGRAM, *arguments, "--time-limit", limit],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert result.returncode == status, result.stderr
        assert (tmp_path / "a.ply").exists() == (status == 0)
        if status == 1:
            assert "stopped after the time limit of 0.05 s" in result.stderr
            assert json.loads(result.stdout)["error"]["kind"] == "time"


@pytest.mark.parametrize("limit", ["-1", "nan", "x"])
def test_bad_time_limits(run: Run, mesh: Path, limit: str) -> None:
    failed = run(
        "distance", "square.obj", "--vertex=0", f"--time-limit={limit}", "-o", "a.txt", status=2
    )
    assert "--time-limit" in failed.stderr


def test_help_lists_the_verbs(run: Run) -> None:
    text = run("help").stdout
    assert text == run("--help").stdout
    for verb in ("distance", "sdf", "repair", "render", "help"):
        assert any(line.split()[:1] == [verb] for line in text.splitlines()), verb
