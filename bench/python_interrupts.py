"""How long a call from Python goes on after Ctrl-C, at points all along it.

usage: python_interrupts.py SURFACE [--nodes 256] [--method signed-heat] [--times 20]

Samples the distance to a surface on a grid in a process of its own, once to the end, then again
with an interrupt after equal shares of its processor time, on one thread. Prints the
processor seconds from the signal to where KeyboardInterrupt is caught, as Markdown. Linux.
"""

import argparse
import signal
import subprocess
import sys
import time

import littoral


def sampled(surface: str, nodes: int, method: str) -> None:
    """The call; prints its processor seconds, from the signal on where it was stopped."""
    mesh = littoral.read(surface)
    print("ready", flush=True)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        littoral.SDF(mesh, method=method).sample(nodes, threads=1)
        print("ended", time.process_time(), flush=True)
    except KeyboardInterrupt:
        print("stopped", time.process_time(), flush=True)


def processor_clock(process: int) -> int:
    """The clock of another process's processor time, for time.clock_gettime."""
    return ~process << 3 | 2


def stopped_after(command: list[str], share: float) -> tuple[float, float]:
    """Seconds of the call and, where it was stopped, from the signal to the exception."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        clock = processor_clock(process.pid)
        process.stdout.readline()
        begin = time.clock_gettime(clock)
        asked = 0.0
        if share > 0:
            while process.poll() is None and time.clock_gettime(clock) - begin < share:
                time.sleep(0.002)
            asked = time.clock_gettime(clock)
            process.send_signal(signal.SIGINT)
        word, seconds = process.stdout.readline().split()
    if share > 0 and word == "ended":
        return float(seconds) - begin, 0.0
    return float(seconds) - begin, float(seconds) - asked


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("surface")
    parser.add_argument("--nodes", type=int, default=256)
    parser.add_argument("--method", default="signed-heat")
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--call", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.call:
        return sampled(given.surface, given.nodes, given.method)
    command = [sys.executable, __file__, given.surface, "--call", "--nodes", str(given.nodes),
               "--method", given.method]  # fmt: skip
    whole, _ = stopped_after(command, 0)
    print(f"{whole:.1f} processor seconds\n\n| after, s | on for, s |\n|---|---|")
    waits = []
    for k in range(given.times):
        share = whole * (k + 0.5) / given.times
        waits.append(stopped_after(command, share)[1])
        print(f"| {share:.2f} | {waits[-1]:.3f} |", flush=True)
    print(f"\nlargest {max(waits):.3f}, median {sorted(waits)[len(waits) // 2]:.3f}")


if __name__ == "__main__":
    main()
