#!/usr/bin/env python3
"""A record of an hour at 1 kHz in eight channels: separated in streaming within 200 MB of memory, diagnosed
within 4 GB and rightly: the sensor is a fifth softer than simulated.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

# Blocks are written anew after N_BLOCKS: pieces a quarter of an hour apart hold different noise.
RATE_HZ, BLOCK_S, N_BLOCKS, HOUR_S = 1000, 60, 7, 3600
N = RATE_HZ * BLOCK_S
GAIN_KG_M, FREQUENCY_HZ, DAMPING_RATIO, RMS_M_S2 = 6e-5, 37.3, 0.05, 3.0
COLUMNS = ["time_s", "base_acceleration_m_s2", "base_moment_N_m", "cross_acceleration_m_s2", "cross_moment_N_m",
           "base_acceleration_2_m_s2", "wind_speed_m_s", "coil_current_A", "temperature_C"]
MEGABYTE = 1e6


class Bench:
    """One mode; the drive, of 600 lines, repeats with every block, the noise does not."""

    def __init__(self, stiffness_ratio, noise, seed):
        self.random = numpy.random.default_rng(seed)
        self.frequency_hz = FREQUENCY_HZ * stiffness_ratio**0.5
        self.noise = noise
        drive = numpy.random.default_rng(1)  # the same on every bench
        lines = drive.choice(numpy.arange(2 * BLOCK_S, 200 * BLOCK_S), 600, replace=False)
        self.base = numpy.zeros(N // 2 + 1, complex)
        self.base[lines] = RMS_M_S2 * N / (2 * lines.size)**0.5 * numpy.exp(2j * numpy.pi * drive.random(lines.size))

    def block(self, level):
        """Values of all channels but time."""
        ratio = numpy.fft.rfftfreq(N, 1 / RATE_HZ) / self.frequency_hz
        response = -GAIN_KG_M / (1 - ratio**2 + 2j * DAMPING_RATIO * ratio)
        acceleration = level * numpy.fft.irfft(self.base, N)
        moment = level * numpy.fft.irfft(self.base * response, N)
        zero = numpy.zeros(N)

        def noisy(values, size):
            return values + self.noise * size * self.random.standard_normal(N)

        return numpy.column_stack([noisy(acceleration, 0.03), noisy(moment, 2e-6), noisy(zero, 0.03),
                                   noisy(zero, 2e-6), noisy(acceleration, 0.03), zero, zero, noisy(20 + zero, 0.1)])

    def record(self, file, duration_s, level):
        row_format = ",%.6g" * (len(COLUMNS) - 1) + "\n"
        blocks = [[row_format % tuple(row) for row in self.block(level).tolist()]
                  for _ in range(min(N_BLOCKS, duration_s // BLOCK_S))]
        with open(file, "w") as out:
            out.write(",".join(COLUMNS) + "\n")
            for b in range(duration_s // BLOCK_S):
                out.write("".join("%.3f%s" % (i / RATE_HZ, rest)
                                  for i, rest in enumerate(blocks[b % len(blocks)], b * N)))


def write_dataset(folder, bench, duration_s):
    folder.mkdir()
    records = [("quiet.csv", "none", 0.0, "fit", BLOCK_S), ("base.csv", "base", 1.0, "fit", duration_s),
               ("held_out.csv", "base", 1.5, "held_out", BLOCK_S)]
    for file, _, level, _, seconds in records:
        bench.record(folder / file, seconds, level)
    (folder / "dataset.json").write_text(json.dumps(
        {"schema": "vibrissa-dataset-1", "sampling_rate_hz": RATE_HZ,
         "records": [{"file": file, "excitation": excitation, "period_samples": 0, "split": split}
                     for file, excitation, _, split, _ in records]}))


def run(*command):
    """What was printed, and the largest memory of that process in bytes."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=sys.stderr, text=True)
    printed = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))}: status {status}")
    return printed, 1024.0 * usage.ru_maxrss


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="vibrissa_load_") as scratch:
        folder = pathlib.Path(scratch)
        write_dataset(folder / "sim", Bench(1.0, 0.0, 2), BLOCK_S)
        write_dataset(folder / "real", Bench(0.8, 1.0, 3), HOUR_S)
        wrong = []

        def within(what, bytes_, limit):
            print(f"{what}: {bytes_ / MEGABYTE:.0f} MB of {limit / MEGABYTE:.0f}", flush=True)
            if bytes_ > limit:
                wrong.append(what)

        hour, separated = folder / "real" / "base.csv", folder / "separated.csv"
        _, memory = run(options.program, "separate", hour, "--stream", "--quiet", "-o", separated)
        within("separated", memory, 200 * MEGABYTE)
        with open(hour, "rb") as given, open(separated, "rb") as made:
            if sum(1 for _ in given) != sum(1 for _ in made):
                wrong.append("rows of the separated record")
        printed, memory = run(options.program, "diagnose", "--sim", folder / "sim", "--real", folder / "real", "--json")
        within("diagnosed", memory, 4000 * MEGABYTE)
        verdict = json.loads(printed)["verdict"]
        print(f"verdict: {verdict}")
        if verdict != "stiffness":
            wrong.append("verdict")
        sys.exit(f"wrong: {', '.join(wrong)}" if wrong else 0)


if __name__ == "__main__":
    main()
