"""How long `littoral` goes on after Ctrl-C, and what it leaves behind, at points all along a run.

usage: interrupts.py PROGRAM [--times 12] -- ARGUMENTS of littoral, with OUT/ before output files

Runs the command once to its end, then again with an interrupt after 1/13, 2/13, ... of that time;
prints the stage that was shown last and the seconds until the process was gone, as Markdown.
"""

import argparse
import os
import re
import signal
import statistics
import subprocess
import tempfile
import time
from pathlib import Path


def run(command: list[str], folder: Path, after: float | None) -> tuple[float, str, int]:
    """Seconds (of the whole run, or after the interrupt), the last stage, and the status."""
    with (
        (folder / "stderr").open("w+") as errors,
        subprocess.Popen(
            command,
            stderr=errors,
            stdout=subprocess.DEVNULL,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        ) as process,
    ):
        begin = time.perf_counter()
        if after is not None:
            try:
                process.wait(after)
            except subprocess.TimeoutExpired:
                begin = time.perf_counter()
                os.kill(process.pid, signal.SIGINT)
        status = process.wait()
        seconds = time.perf_counter() - begin
        errors.seek(0)
        stages = re.findall(r"\] +\d+ % ([^\r\n\x1b]*)", errors.read())
    stage = stages[-1].split("littoral:")[0] if stages else "reading"
    return seconds, stage, status


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--times", type=int, default=12)
    parser.add_argument("arguments", nargs="+")
    given = parser.parse_args()
    took = []
    with tempfile.TemporaryDirectory() as name:
        folder, out = Path(name), Path(name) / "out"
        out.mkdir()
        words = [re.sub("^OUT/", f"{out}/", word) for word in given.arguments]
        command = [given.program, *words, "--progress", "always"]
        whole, _, status = run(command, folder, None)
        if status != 0:
            raise SystemExit((folder / "stderr").read_text())
        print(f"whole run {whole:.1f} s, load {os.getloadavg()[0]:.0f}\n")
        print("| interrupted in | after, s | gone after, s |\n|---|---|---|")
        for k in range(1, given.times + 1):
            for old in out.iterdir():
                old.unlink()
            after = whole * k / (given.times + 1)
            seconds, stage, status = run(command, folder, after)
            if status != 130:
                print(f"| had ended, status {status} | {after:.1f} | |", flush=True)
                continue
            left = [file.name for file in out.iterdir() if file.name.startswith(".")]
            if left:
                raise SystemExit(f"left behind: {left}")
            took.append(seconds)
            print(f"| {stage} | {after:.1f} | {seconds:.3f} |", flush=True)
    print(f"\nmedian {statistics.median(took):.3f}, largest {max(took):.3f}")


if __name__ == "__main__":
    main()
