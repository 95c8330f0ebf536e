#!/usr/bin/env python3
"""Kills one of the processes that share `vibrissa run`, at times spread over the job.

After each: the others are ended and it is said once, the status is not 0, and no file with a final name is half.
A kill that came when all was done, so that nothing is missing, is none.
"""
import argparse
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

from visit_fault_points import files, half_file

N_PROCESSES = 2
END_WITHIN_S = 60.0


def start(options, folder):
    command = [options.mpirun, "-np", str(N_PROCESSES), "--oversubscribe", "--allow-run-as-root", "--mca",
               "mpi_yield_when_idle", "1", options.program, "run", options.case, "-q", "-o", str(folder)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def children(parent):
    """Processes of the job, in the order in which they were started."""
    found = []
    for status in pathlib.Path("/proc").glob("[0-9]*/status"):
        try:
            fields = dict(line.split(":", 1) for line in status.read_text().splitlines() if ":" in line)
        except (FileNotFoundError, ProcessLookupError):
            continue
        if int(fields["PPid"]) == parent:
            found.append(int(fields["Pid"]))
    return sorted(found)


def half_files(folder, whole):
    for name, file in (files(folder) if folder.exists() else {}).items():
        wrong = None if file.name.startswith(".unfinished") else half_file(name, file, whole)
        if wrong:
            yield f"{name} {wrong}"


def is_complete(folder, whole):
    return folder.exists() and files(folder).keys() == whole.keys() and not list(half_files(folder, whole))


def said_at_the_end(job):
    """What the job said until it ended; nothing when it goes on."""
    try:
        return job.communicate(timeout=END_WITHIN_S)[0]
    except subprocess.TimeoutExpired:
        job.kill()
        return None


def complaints(job, said, folder, whole):
    if said is None:
        yield f"the others go on for more than {END_WITHIN_S:.0f} s"
        return
    if job.returncode == 0:
        yield "status 0"
    if said.count("signal 9") != 1:
        yield f"does not say once what happened: {said[-600:]!r}"
    yield from half_files(folder, whole)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("mpirun")
    parser.add_argument("program")
    parser.add_argument("case")
    parser.add_argument("--kills", type=int, default=4)
    options = parser.parse_args()
    n_killed = n_wrong = 0
    with tempfile.TemporaryDirectory(prefix="vibrissa_faults_") as scratch:
        folder = pathlib.Path(scratch) / "reference"
        began = time.monotonic()
        job = start(options, folder)
        said, _ = job.communicate(timeout=600)
        took_s = time.monotonic() - began
        if job.returncode != 0:
            sys.exit(f"the undisturbed run failed: {said}")
        whole = files(folder)
        for kill in range(options.kills):
            folder = pathlib.Path(scratch) / f"killed-{kill}"
            job = start(options, folder)
            time.sleep(took_s * (kill + 0.5) / options.kills)
            processes = children(job.pid)
            if job.poll() is not None or len(processes) < N_PROCESSES:
                job.communicate()
                continue
            os.kill(processes[kill % N_PROCESSES], signal.SIGKILL)
            said = said_at_the_end(job)
            if job.returncode == 0 and is_complete(folder, whole):
                continue
            n_killed += 1
            for complaint in complaints(job, said, folder, whole):
                n_wrong += 1
                print(f"process {kill % N_PROCESSES} killed at {took_s * (kill + 0.5) / options.kills:.1f} s: {complaint}")
    print(f"{n_killed} processes killed in a job of {took_s:.1f} s, {n_wrong} complaints")
    sys.exit(1 if n_wrong or n_killed < options.kills / 2 else 0)


if __name__ == "__main__":
    main()
