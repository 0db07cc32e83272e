"""Batches one after the other: soak.py LITTORAL DATA OUT SECONDS.

Each round makes 200 damaged inputs of the surfaces in DATA with another seed and does them by
`littoral batch`. Ends with status 1 where an input has no line, has two, or crashed, or where the
parent or the server of a batch is larger than 1.5 times what it was in the first round.
"""

import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

from measure import children, resident


def one_round(program: str, data: str, out: Path, seed: int) -> tuple[int, float]:
    shutil.rmtree(out, ignore_errors=True)
    inputs, results = out / "in", out / "results"
    maker = Path(__file__).with_name("make_inputs.py")
    subprocess.run([sys.executable, maker, data, "200", inputs, str(seed), "6000"], check=True,
                   stdout=subprocess.DEVNULL)  # fmt: skip
    command = [program, "batch", inputs, "--resolution", "16", "-o", results, "--quiet",
               "--time-limit", "60", "--memory-limit", "2GB"]  # fmt: skip
    largest = 0.0
    with subprocess.Popen(command) as process:
        while process.poll() is None:
            pids = [process.pid, *children(process.pid)]
            largest = max(largest, *map(resident, pids))
            time.sleep(0.2)
    lines = [json.loads(line) for line in (results / "status.jsonl").open()]
    names = [line["input"] for line in lines]
    if len(names) != 200 or len(set(names)) != 200:
        sys.exit(f"seed {seed}: {len(names)} lines of {len(set(names))} inputs, not 200")
    crashed = [line["input"] for line in lines if line["status"] in ("crash", "internal")]
    if crashed:
        sys.exit(f"seed {seed}: crashed: {crashed}")
    return sum(line["status"] == "done" for line in lines), largest


def main() -> None:
    program, data, out, seconds = sys.argv[1], sys.argv[2], Path(sys.argv[3]), float(sys.argv[4])
    begin, seed, first = time.monotonic(), 0, 0.0
    while time.monotonic() - begin < seconds:
        done, largest = one_round(program, data, out, seed)
        first = first or largest
        print(f"seed {seed}: {done} of 200 done, {largest:.1f} MB", flush=True)
        if largest > 1.5 * first:
            sys.exit(f"memory grew from {first:.1f} MB to {largest:.1f} MB")
        seed += 1


if __name__ == "__main__":
    main()
