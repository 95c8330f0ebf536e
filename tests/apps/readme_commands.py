"""Runs every command of README's code blocks, in order, in a folder of its own: readme_commands.py ROOT

./run and ./check, which build, and commands on recordings that are not here (../shared) are left out.
"""
import pathlib
import re
import subprocess
import sys
import tempfile


def commands(page):
    for block in re.findall(r"```\n(.*?)```", page, re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines():
            line = re.sub(r"\s+# .*", "", line).strip()
            if line and not line.startswith(("./run", "./check")):
                yield line


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    wrong = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "project"
        folder.mkdir()
        for name in ("build", "cases", "examples"):
            (folder / name).symlink_to(root / name)
        if (root / "../shared").exists():
            (folder.parent / "shared").symlink_to((root / "../shared").resolve())
        for command in commands((root / "README.md").read_text(encoding="utf-8")):
            if "../shared/" in command and not (folder / "../shared").exists():
                print(f"left out, no recordings: {command}")
                continue
            done = subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True)
            print(f"{done.returncode} {command}", flush=True)
            if done.returncode != 0:
                wrong += 1
                print(done.stderr[-2000:])
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
