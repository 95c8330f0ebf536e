#!/usr/bin/env python3
"""Fails every open, write, rename, large allocation and fork of `vibrissa run` in turn, and those of its
child that draws the pictures.

After each: no crash, an error in words, and in the run folder no half file and no leftover. The points of
the job itself are visited in one run of it, each in a child process (fault_child.h); drawing, which has
threads and a display, is done anew for each point. --every N visits each Nth.
"""
import argparse
import concurrent.futures
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
SIGNALLED, SEVERAL_THREADS = 1000, 2000
TIME_LIMIT_S = 600
FEWER_PICTURES = ["CSV only", "not drawn", "then failure"]  # said where pictures are missing


def files(folder):
    return {str(f.relative_to(folder)): f for f in folder.rglob("*") if f.is_file()}


def spoken(file):
    return file.read_text(errors="replace") if file.exists() else ""


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


def complaints(status, said, out, whole):
    """What is wrong with the end of a run of which one call failed."""
    found = files(out) if out.exists() else {}
    if status == SEVERAL_THREADS:
        yield "not visited: the program has several threads"
        return
    if status not in (0, 1, 2, 74):
        how = f"ended by signal {status - SIGNALLED}" if status > SIGNALLED else f"status {status}"
        yield f"{how}: {said[-300:]}"
    if status != 0 and not any(line.startswith("vibrissa: ") for line in said.splitlines()):
        yield f"status {status} without an error in words: {said[-300:]!r}"
    for name, file in found.items():
        wrong = half_file(name, file, whole)
        if wrong:
            yield f"{name} {wrong}"
    missing = sorted(set(whole) - set(found))
    if status == 0 and missing and not any(words in said for words in FEWER_PICTURES):
        yield f"status 0, but {', '.join(missing[:5])} missing"


class Tally:
    def __init__(self):
        self.n_visited = self.n_wrong = 0

    def add(self, what, wrongs):
        self.n_visited += 1
        for wrong in wrongs:
            self.n_wrong += 1
            print(f"{what}: {wrong}", flush=True)


def fault_environment(program, shim, command, folder, **fault):
    return dict(os.environ, LD_PRELOAD=shim, FAULT_FOLDER=str(folder), FAULT_COMMAND=command,
                FAULT_PROGRAM=pathlib.Path(program).name, **fault)


def read_counts(file):
    return {kind: int(n) for kind, n in (line.split() for line in file.read_text().splitlines())}


def run_in_children(options, scratch, whole, tally):
    """All points of `vibrissa run`, in one run of it. Returns their numbers."""
    out, counts = scratch / "out", scratch / "counts"
    heard, to_judge = os.pipe()
    from_judge, answers = os.pipe()
    environment = fault_environment(options.program, options.shim, "run", out, FAULT_EVERY=str(options.every),
                                    FAULT_TALK=f"{from_judge},{to_judge}", FAULT_COUNTS=str(counts))
    job = subprocess.Popen(run_command(options, out), pass_fds=(from_judge, to_judge), env=environment,
                           stdout=subprocess.DEVNULL)
    os.close(from_judge)
    os.close(to_judge)
    with os.fdopen(heard) as lines, os.fdopen(answers, "wb", buffering=0) as answer:
        for line in lines:
            kind, number, status = line.split()
            said = spoken(out.with_name("out.said"))
            tally.add(f"run, {kind} {number}", complaints(int(status), said, out, whole))
            answer.write(b".")
    if job.wait() != 0:
        sys.exit(f"the job in whose children the faults happened failed with status {job.returncode}")
    return read_counts(counts)


def run_command(options, out):
    return [options.program, "run", options.case, "-q", "-o", str(out / "run")]


class Drawing:
    """`vibrissa draw`, whose child draws: what fails there must cost no more than pictures."""

    def __init__(self, options, scratch, whole):
        self.options, self.scratch, self.whole = options, scratch, whole

    def draw(self, name, **fault):
        """Folder, status and what was said."""
        out = self.scratch / name
        shutil.copytree(self.scratch / "reference", out, ignore=shutil.ignore_patterns("*.png", "*.svg"))
        environment = fault_environment(self.options.program, self.options.shim, "draw", out,
                                        FAULT_WITH="DISPLAY", **fault)
        environment.pop("DISPLAY", None)
        done = subprocess.run([self.options.program, "draw", str(out / "run")], env=environment, capture_output=True,
                              text=True, timeout=TIME_LIMIT_S)
        return out, done.returncode, done.stdout + done.stderr

    def counts(self):
        file = self.scratch / "drawing_counts"
        out, status, said = self.draw("drawn", FAULT_COUNTS=str(file))
        if status != 0:
            sys.exit(f"the undisturbed drawing failed: {said}")
        return read_counts(file)

    def complaints(self, point):
        kind, number = point
        out, status, said = self.draw(f"{kind}{number}", FAULT_KIND=kind, FAULT_NUMBER=str(number))
        wrongs = list(complaints(0 if status == 1 else status, said, out, self.whole))
        shutil.rmtree(out)
        return wrongs

    def visit(self, tally):
        counts = self.counts()
        every = self.options.every
        points = [(kind, number) for kind in KINDS for number in range(1, counts[kind] + 1)
                  if number % every == every // 2 % every]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for (kind, number), wrongs in zip(points, pool.map(self.complaints, points)):
                tally.add(f"draw, {kind} {number}", wrongs)
        return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("shim")
    parser.add_argument("case")
    parser.add_argument("--every", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="vibrissa_faults_") as folder:
        scratch = pathlib.Path(folder)
        reference = scratch / "reference"
        subprocess.run(run_command(options, reference), check=True, stdout=subprocess.DEVNULL)
        whole, tally = files(reference), Tally()
        running = run_in_children(options, scratch, whole, tally)
        print(f"vibrissa run: {tally.n_visited} fault points visited of {running}", flush=True)
        n_running = tally.n_visited
        drawing = Drawing(options, scratch, whole).visit(tally)
        print(f"vibrissa draw: {tally.n_visited - n_running} visited of {drawing}")
        print(f"{tally.n_wrong} complaints")
        sys.exit(1 if tally.n_wrong else 0)


if __name__ == "__main__":
    main()
