"""What a batch is told, and what it says: names, limits, options, reports."""

from __future__ import annotations

import gzip
import json
import math
import os
import shutil
from pathlib import Path
from typing import Any

import pytest

import littoral
from littoral._batch_verb import _words

CUBE = littoral.examples.cube()


def lines_of(folder: Path) -> dict[str, dict[str, Any]]:
    found = [json.loads(line) for line in (folder / "status.jsonl").read_text().splitlines()]
    return {line["name"]: line for line in found}


def nothing(item: Any, output: str) -> None:
    pass


def test_reports_hold_words_for_numbers_that_json_has_not(tmp_path: Path) -> None:
    def work(item: int, output: str) -> Any:
        return {"a": math.nan, "b": [math.inf, (1.5, -math.inf)], "c": "NaN"}

    littoral.batch({"x": 1}, work, tmp_path)
    expected = {"a": "nan", "b": ["inf", [1.5, "-inf"]], "c": "NaN"}
    assert lines_of(tmp_path)["x"]["report"] == expected


def test_messages_may_name_any_file(tmp_path: Path) -> None:
    def work(item: int, output: str) -> None:
        raise littoral.InputError(os.fsdecode(b"caf\xe9.obj") + " is bad")

    done = littoral.batch([1], work, tmp_path)
    assert done.failures == (littoral.BatchFailures("input", "caf\\udce9.obj is bad", "1", 1),)


@pytest.mark.parametrize("item", ["..", "", "/", "./"])
def test_items_name_files(item: str, tmp_path: Path) -> None:
    with pytest.raises(littoral.InputError, match="names no file"):
        littoral.batch([item], nothing, tmp_path)


@pytest.mark.parametrize(
    "words",
    [
        {"shard": (2**40, 2**41)},
        {"processes": -1},
        {"processes": 2**31},
        {"retries": 2**40},
        {"time_limit": math.nan},
        {"memory_limit": math.inf},
        {"memory_limit": -1},
    ],
)
@pytest.mark.parametrize("work", [nothing, "info"])
def test_numbers_out_of_range_are_named(words: dict[str, Any], work: Any, tmp_path: Path) -> None:
    with pytest.raises(littoral.InputError, match=f"{next(iter(words))}: expected"):
        littoral.batch([1] if work is nothing else ["a.obj"], work, tmp_path, **words)


def test_extensions_are_kept_as_far_as_needed(tmp_path: Path) -> None:
    for name in ("a.obj", "a.ply", "b.obj", "c.tar.obj"):
        CUBE.save(tmp_path / name)
    packed = gzip.compress((tmp_path / "a.obj").read_bytes())
    (tmp_path / "a.obj.gz").write_bytes(packed)
    littoral.batch(tmp_path, nothing, tmp_path / "out")
    names = {"a.obj", "a.ply", "a.obj.gz", "b", "c.tar"}
    assert set(lines_of(tmp_path / "out")) == names
    program = os.environ.get("LITTORAL", "littoral")
    if shutil.which(program):
        shutil.rmtree(tmp_path / "out")
        littoral.batch(tmp_path, "info", tmp_path / "out")
        assert set(lines_of(tmp_path / "out")) == names


def test_switches_can_be_off() -> None:
    options = {"sharpen": True, "insert_samples": False, "field": None, "vertex": [0, 5]}
    assert _words(options) == ["--sharpen", "--insert-samples=off", "--vertex=0", "--vertex=5"]


@pytest.mark.skipif(
    shutil.which(os.environ.get("LITTORAL", "littoral")) is None, reason="needs the program"
)
def test_switches_that_are_on_by_themselves_can_be_off(tmp_path: Path) -> None:
    CUBE.save(tmp_path / "cube.obj")
    how = {"vertex": 0, "method": "quadratic"}
    for given in ({}, {"insert_samples": False}, {"insert_samples": True}):
        out = tmp_path / str(len(given)) / str(given)
        littoral.batch([tmp_path / "cube.obj"], "distance", out, options=how | given)
        (line,) = lines_of(out).values()
        assert line["report"]["options"]["insert-samples"] is given.get("insert_samples", True)
