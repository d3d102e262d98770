"""A copy of the sources to plant faults in, its build and its tests."""

import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import time

from faults import stale_reason

COPIED = ("CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "CHANGELOG.md", "assets", "src", "tests", "tools")
WITHOUT = ("node_modules", "__pycache__")
SLOWEST = 5.0    # a test that takes so many times longer than without a fault is stopped
PATIENCE_S = 60  # and this on top


class BrokenTree(Exception):
    """The sources do not build, or their tests do not pass, without any fault."""


@dataclasses.dataclass(frozen=True)
class Outcome:
    state: str  # killed, survived, stale, or broken: does not compile
    note: str


@dataclasses.dataclass(frozen=True)
class Run:
    passed: bool
    count: int      # tests that ran
    first: str      # that failed
    seconds: float


def files_below(folder, name):
    """Relative paths of the files of a file or folder."""
    if (folder / name).is_file():
        return [pathlib.Path(name)]
    found = []
    for place, folders, files in os.walk(folder / name):
        folders[:] = [each for each in folders if each not in WITHOUT]
        found += [(pathlib.Path(place) / each).relative_to(folder) for each in files]
    return found


def copy_changed(source, target):
    """Makes `target` the same as `source`; what is the same already keeps its time, so that it is not built again."""
    wanted = {path for name in COPIED for path in files_below(source, name)}
    present = {path for name in COPIED for path in files_below(target, name)}
    for path in present - wanted:
        (target / path).unlink()
    for path in wanted:
        old, new = target / path, source / path
        if path in present and old.read_bytes() == new.read_bytes():
            continue
        old.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(new, old)
        shutil.copymode(new, old)


def last_lines(text, count=15):
    return "\n".join(text.strip().splitlines()[-count:])


class Tree:
    def __init__(self, repository, folder, jobs):
        self.repository = repository
        self.root = folder / "tree"
        self.binaries = self.root / "build" / "release"
        self.jobs = jobs
        self.usual_s = {}  # of (program, filter)

    def prepare(self, faults):
        """Builds the tests that the faults name and sees them pass. BrokenTree where they do not."""
        self.root.mkdir(parents=True, exist_ok=True)
        copy_changed(self.repository, self.root)
        tests = sorted({test for fault in faults for test in fault.tests})
        configured = subprocess.run(["cmake", "--preset", "release"], cwd=self.root, capture_output=True, text=True)
        if configured.returncode != 0:
            raise BrokenTree("cannot configure the copy:\n" + last_lines(configured.stderr))
        problem = self.build(sorted({program for program, _ in tests}))
        if problem:
            raise BrokenTree("the copy does not build:\n" + problem)
        for test in tests:
            run = self.run(test, None)
            if run.count == 0:
                raise BrokenTree(f"no test of test_{test[0]} matches {test[1]}")
            if not run.passed:
                raise BrokenTree(f"test_{test[0]} fails without a fault: {run.first}")
            self.usual_s[test] = run.seconds

    def build(self, programs):
        """What the compiler says where it does not build; else nothing."""
        command = ["cmake", "--build", str(self.binaries), "--parallel", str(self.jobs), "--target"]
        done = subprocess.run(command + [f"test_{each}" for each in programs], capture_output=True, text=True)
        return "" if done.returncode == 0 else last_lines(done.stdout + done.stderr)

    def run(self, test, limit_s):
        """One test program, up to its first failure. limit_s: None for as long as it takes."""
        program, wanted = test
        command = [str(self.binaries / f"test_{program}"), "--gtest_brief=1", "--gtest_fail_fast"]
        command.append(f"--gtest_filter={wanted}{':' if '-' in wanted else '-'}*Golden*")
        start = time.monotonic()
        try:
            done = subprocess.run(command, cwd=self.binaries, capture_output=True, timeout=limit_s)
        except subprocess.TimeoutExpired:
            return Run(False, 0, "takes too long", time.monotonic() - start)
        output = done.stdout.decode(errors="replace")
        count = re.search(r"\[==========\] (\d+) tests? from", output)
        failed = re.search(r"\[  FAILED  \] (\S+?),? ", output)
        first = failed.group(1) if failed else "the program crashes"
        return Run(done.returncode == 0, int(count.group(1)) if count else 0, first, time.monotonic() - start)

    def try_fault(self, fault):
        reason = stale_reason(fault, self.root)
        if reason:
            return Outcome("stale", reason)
        path = self.root / "src" / fault.file
        text = path.read_text(encoding="utf-8")
        path.write_text(text.replace(fault.text, fault.replacement), encoding="utf-8")
        try:
            return self.outcome_of(fault)
        finally:
            path.write_text(text, encoding="utf-8")

    def outcome_of(self, fault):
        """Of the fault that is planted: its tests, the quick ones first."""
        for test in sorted(fault.tests, key=self.usual_s.get):
            problem = self.build([test[0]])
            if problem:
                return Outcome("broken", "does not compile: " + " ".join(re.findall(r"error: .*", problem)[:1]))
            run = self.run(test, PATIENCE_S + SLOWEST * self.usual_s[test])
            if not run.passed:
                return Outcome("killed", f"{test[0]}: {run.first}")
        return Outcome("survived", " ".join(program for program, _ in fault.tests))
