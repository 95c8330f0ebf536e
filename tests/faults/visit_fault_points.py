#!/usr/bin/env python3
"""Fails every open, write, rename, large allocation and fork of `vibrissa run` in turn.

After each: no crash, an error in words, and in the run folder no half file and no leftover.
Each point takes seconds and all of them hours; --every N visits each Nth.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

KINDS = ["open", "write", "rename", "memory", "fork"]
TAILS = {".html": b"</html>", ".svg": b"</svg>", ".png": b"IEND\xaeB`\x82", ".vtu": b"</VTKFile>",
         ".pvtu": b"</VTKFile>", ".pvd": b"</VTKFile>"}


class Job:
    def __init__(self, program, shim, case, scratch):
        self.program, self.shim, self.case = program, shim, case
        self.scratch = pathlib.Path(scratch)

    def run(self, name, **fault):
        out = self.scratch / name
        environment = dict(os.environ, LD_PRELOAD=self.shim, FAULT_FOLDER=str(self.scratch),
                           FAULT_PROGRAM=pathlib.Path(self.program).name, **fault)
        done = subprocess.run([self.program, "run", self.case, "-q", "-o", str(out / "run")],
                              env=environment, capture_output=True, text=True, timeout=600)
        return done, out


def files(folder):
    return {str(f.relative_to(folder)): f for f in folder.rglob("*") if f.is_file()}


def half_file(name, file, whole):
    """What is wrong with a file, beside the one that an undisturbed run wrote; or nothing."""
    if name not in whole:
        return "is none of the files of an undisturbed run"
    content = file.read_bytes()
    if file.suffix == ".json":
        try:
            json.loads(content)
        except ValueError as error:
            return f"is no JSON: {error}"
    elif file.suffix in TAILS:
        if not content.rstrip().endswith(TAILS[file.suffix]):
            return "has no end"
    elif content.count(b"\n") != whole[name].read_bytes().count(b"\n"):
        return "has other lines than that of an undisturbed run"
    return None


def complaints(done, out, whole):
    found = files(out) if out.exists() else {}
    if done.returncode not in (0, 1, 2):
        yield f"status {done.returncode}: {done.stderr[-300:]}"
    if done.returncode != 0 and not done.stderr.lstrip().startswith("vibrissa: "):
        yield f"status {done.returncode} without an error in words: {done.stderr[-300:]!r}"
    for name, file in found.items():
        wrong = half_file(name, file, whole)
        if wrong:
            yield f"{name} {wrong}"
    missing = sorted(set(whole) - set(found))
    if done.returncode == 0 and missing and "CSV only" not in done.stdout + done.stderr:
        yield f"status 0, but {', '.join(missing[:5])} missing"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("shim")
    parser.add_argument("case")
    parser.add_argument("--kind", action="append", choices=KINDS)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--first", type=int, help="default: half of --every, else 1")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="vibrissa_faults_") as scratch:
        job = Job(options.program, options.shim, options.case, scratch)
        counts_file = pathlib.Path(scratch) / "counts"
        done, reference = job.run("reference", FAULT_COUNTS=str(counts_file))
        if done.returncode != 0:
            sys.exit(f"the undisturbed run failed: {done.stderr}")
        whole = files(reference)
        counts = dict(line.split() for line in counts_file.read_text().splitlines())
        n_visited = n_wrong = 0
        for kind in options.kind or KINDS:
            n = int(counts[kind])
            first = options.first or min(max(options.every // 2, 1), max(n, 1))
            for number in range(first, n + 1, options.every):
                done, out = job.run("faulty", FAULT_KIND=kind, FAULT_NUMBER=str(number))
                n_visited += 1
                for complaint in complaints(done, out, whole):
                    n_wrong += 1
                    print(f"{kind} {number}: {complaint}", flush=True)
                shutil.rmtree(out, ignore_errors=True)
        print(f"{n_visited} fault points visited of {counts}, {n_wrong} complaints")
        sys.exit(1 if n_wrong else 0)


if __name__ == "__main__":
    main()
