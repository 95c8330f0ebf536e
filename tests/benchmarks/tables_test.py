"""tools/check_tables: the pages have the tables of benchmarks/results, and each way to differ is an error.

Usage: tables_test.py ROOT
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1]).resolve()
PAGE, RESULT = "benchmarks/README.md", "benchmarks/results/modes.json"
MARK = "<!-- table: modes -->"


def check(folder, *options):
    done = subprocess.run([ROOT / "tools/check_tables", *options, folder], capture_output=True, text=True)
    return done.returncode, done.stdout


def copied(scratch):
    folder = pathlib.Path(tempfile.mkdtemp(dir=scratch))
    shutil.copytree(ROOT / "benchmarks", folder / "benchmarks")
    shutil.copytree(ROOT / "docs", folder / "docs")
    for page in ROOT.glob("*.md"):
        shutil.copy(page, folder)
    return folder


def replaced(file, old, new):
    text = file.read_text(encoding="utf-8")
    assert old in text, f"{file} has no {old}"
    file.write_text(text.replace(old, new, 1), encoding="utf-8")


def row_of(folder):
    """A row of the table, which begins with what it is about."""
    return (folder / PAGE).read_text(encoding="utf-8").split(MARK)[1].splitlines()[3]


def changed_number_in_the_page(folder):
    row = row_of(folder)
    replaced(folder / PAGE, row, row[:-3] + "9" + row[-2:] if row[-3] != "9" else row[:-3] + "8" + row[-2:])


def changed_number_in_the_file(folder):
    replaced(folder / RESULT, '"ccx_s": ', '"ccx_s": 1')


def number_that_is_not_there(folder):
    replaced(folder / RESULT, '"ccx_s"', '"ccx"')


def no_revision(folder):
    replaced(folder / RESULT, '"revision"', '"version"')


def no_file(folder):
    (folder / RESULT).unlink()


def unknown_table(folder):
    replaced(folder / PAGE, MARK, "<!-- table: mods -->")


def file_without_a_table(folder):
    shutil.copy(folder / RESULT, folder / "benchmarks/results/more_modes.json")


def table_without_an_end(folder):
    page = folder / PAGE
    before, after = page.read_text(encoding="utf-8").rsplit("<!-- end of table -->", 1)
    page.write_text(before + after, encoding="utf-8")


FAULTS = {
    changed_number_in_the_page: "the table modes is not that of benchmarks/results/modes.json",
    changed_number_in_the_file: "the table modes is not that of benchmarks/results/modes.json",
    number_that_is_not_there: "modes.json: ccx_s is not there",
    no_revision: "modes.json: revision is not there",
    no_file: "benchmarks/results/modes.json is not there",
    unknown_table: "benchmarks/tables.py has no table mods",
    file_without_a_table: "more_modes.json: 0 pages have its table",
    table_without_an_end: "a table has no end",
}


def main():
    status, said = check(ROOT)
    print(said)
    wrong = status
    with tempfile.TemporaryDirectory() as scratch:
        for fault, message in FAULTS.items():
            folder = copied(scratch)
            fault(folder)
            status, said = check(folder)
            if status != 1 or message not in said:
                print(f"{fault.__name__}: status {status}, not '{message}' but:\n{said}")
                wrong = 1
        folder = copied(scratch)
        changed_number_in_the_page(folder)
        check(folder, "--write")
        if check(folder)[0] != 0 or row_of(folder) != row_of(ROOT):
            print("--write leaves a table that is not its file's")
            wrong = 1
    return wrong


if __name__ == "__main__":
    sys.exit(main())
