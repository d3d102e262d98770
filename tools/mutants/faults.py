"""The list of faults: what each replaces, and which tests should notice."""

import dataclasses
import pathlib

COLUMNS = ("name", "file", "text", "replacement", "tests")


@dataclasses.dataclass(frozen=True)
class Fault:
    name: str         # a few words joined by -
    file: str         # below src
    text: str         # occurs exactly once in the file
    replacement: str
    tests: tuple      # of (program without "test_", filter of GoogleTest)


def tests_of(cell, file):
    """"simulate:Meters.* bake" -> (("simulate", "Meters.*"), ("bake", "*")); the file's folder when empty."""
    words = cell.split() or [pathlib.PurePosixPath(file).parts[0]]
    pairs = (word.partition(":") for word in words)
    return tuple((program, wanted or "*") for program, _, wanted in pairs)


def read_faults(path):
    """The faults of a table of five columns separated by tabs; lines that begin with # and empty ones are left out.

    ValueError where a line is not a fault, or a name comes twice.
    """
    faults = []
    for number, line in enumerate(pathlib.Path(path).read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        cells = line.split("\t")
        if len(cells) == len(COLUMNS) - 1:
            cells.append("")
        if len(cells) != len(COLUMNS) or not all(cells[:3]) or cells[2] == cells[3]:
            raise ValueError(f"{path}:{number}: a fault is {', '.join(COLUMNS)}, separated by tabs")
        if any(fault.name == cells[0] for fault in faults):
            raise ValueError(f"{path}:{number}: '{cells[0]}' is the name of two faults")
        faults.append(Fault(*cells[:4], tests_of(cells[4], cells[1])))
    return faults


def stale_reason(fault, repository):
    """Why the fault cannot be planted; empty when it can."""
    path = pathlib.Path(repository) / "src" / fault.file
    if not path.is_file():
        return "the file is gone"
    times = path.read_text(encoding="utf-8").count(fault.text)
    return "" if times == 1 else f"its text is found {times} times: {fault.text}"
