#!/usr/bin/env python3
"""`vibrissa convert` of a CSV of a million rows and three columns to .npy, beside numpy.loadtxt: processor time, and
memory beyond that of the start as a multiple of the numbers, as JSON.

Usage: benchmarks/reading.py [build/vibrissa]
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

N_ROWS, N_COLUMNS, N_RUNS = 1_000_000, 3, 3
NAMES = "time_s,base_acceleration_m_s2,base_moment_N_m\n"
LOADTXT = "import numpy, sys; numpy.loadtxt(sys.argv[1], delimiter=',', skiprows=1)"


def run(*command):
    """Least processor time [s] and largest memory [bytes] of several runs."""
    times, memories = [], []
    for _ in range(N_RUNS):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        if status != 0:
            sys.exit(f"{' '.join(map(str, command))}: status {status}")
        times.append(usage.ru_utime + usage.ru_stime)
        memories.append(1024 * usage.ru_maxrss)
    return min(times), max(memories)


def write(file, n_rows, jitter_s):
    values = random.Random(1)
    with open(file, "w") as out:
        out.write(NAMES)
        for i in range(n_rows):
            time_s = i / 1000 + jitter_s * values.gauss(0, 1)
            out.write(f"{time_s:.5f},{values.gauss(0, 1):.6f},{values.gauss(0, 1e-4):.6e}\n")


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "build/vibrissa"
    found = {}
    with tempfile.TemporaryDirectory(prefix="vibrissa_reading_") as scratch:
        folder = pathlib.Path(scratch)
        short, long, out = folder / "short.csv", folder / "long.csv", folder / "out.npy"
        for stamps, jitter_s in (("even", 0.0), ("jittering", 1e-4)):
            write(short, 200, jitter_s)
            write(long, N_ROWS, jitter_s)
            start_s, start_bytes = run(program, "convert", "-q", short, out)
            whole_s, whole_bytes = run(program, "convert", "-q", long, out)
            numpy_start_s, _ = run(sys.executable, "-c", LOADTXT, short)
            numpy_s, _ = run(sys.executable, "-c", LOADTXT, long)
            seconds, peer = whole_s - start_s, numpy_s - numpy_start_s
            found[stamps] = {"vibrissa_s": seconds, "loadtxt_s": peer, "ratio": seconds / peer,
                             "memory": (whole_bytes - start_bytes) / (8 * N_ROWS * N_COLUMNS)}
    print(json.dumps(found))


if __name__ == "__main__":
    main()
