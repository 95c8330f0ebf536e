#!/usr/bin/env python3
"""Runs the blocks of docs/notebook.md, one after the other, in a folder of their own.

usage: notebook_test.py PROJECT
"""
import os
import pathlib
import re
import sys
import tempfile

project = pathlib.Path(sys.argv[1])
blocks = re.findall(r"```python\n(.*?)```", (project / "docs/notebook.md").read_text(), re.DOTALL)
assert len(blocks) >= 4
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.symlink(project / "cases", "cases")
    names = {}
    for block in blocks:
        print(block)
        exec(compile(block, "docs/notebook.md", "exec"), names)
