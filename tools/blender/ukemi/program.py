# SPDX-License-Identifier: GPL-3.0-or-later
"""The ukemi program: where it is, which it is, what its settings are, and running it."""

import json
import os
import re
import shutil
import subprocess
import tempfile

VERSIONS = (0, 2)  # major and minor that this add-on speaks with


class ProgramError(Exception):
    """`str()`: what went wrong and what to do, for the artist."""


def _executable(path):
    return path if path and os.path.isfile(path) and os.access(path, os.X_OK) else None


def find(preference=""):
    """The program's path: by preference, UKEMI in the environment, the path, bin/ in this add-on."""
    for named, where in ((preference, "the add-on's preferences"), (os.environ.get("UKEMI", ""), "UKEMI")):
        if not named:
            continue
        found = _executable(os.path.expanduser(named)) or shutil.which(named)
        if found:
            return found
        raise ProgramError(f"{where} names '{named}', which is no program: correct it")
    name = "ukemi.exe" if os.name == "nt" else "ukemi"
    found = shutil.which("ukemi") or _executable(os.path.join(os.path.dirname(__file__), "bin", name))
    if found:
        return found
    raise ProgramError("the program ukemi is not installed: build it, and name build/release/ukemi in the add-on's preferences")


def _hidden():
    """Keeps a console window from appearing on Windows."""
    return {"creationflags": subprocess.CREATE_NO_WINDOW} if os.name == "nt" else {}


def _answer(path, *arguments):
    try:
        done = subprocess.run([path, *arguments], capture_output=True, text=True, timeout=60, encoding="utf-8", errors="replace", **_hidden())
    except (OSError, subprocess.TimeoutExpired) as error:
        raise ProgramError(f"{path} does not run: {error}") from error
    return done


_known = {}  # (path, time of change): settings


def settings(preference=""):
    """What `ukemi recipe --json` says, as a list of dictionaries."""
    path = find(preference)
    key = (path, os.path.getmtime(path))
    if key not in _known:
        version = _answer(path, "--version").stdout.split()
        if len(version) != 2 or version[0] != "ukemi":
            raise ProgramError(f"{path} is not ukemi: name the right program in the add-on's preferences")
        numbers = tuple(int(part) for part in version[1].split(".")[:2])
        if numbers != VERSIONS:
            wanted = ".".join(map(str, VERSIONS))
            raise ProgramError(f"{path} is ukemi {version[1]}, this add-on needs {wanted}: install the add-on that came with the program")
        done = _answer(path, "recipe", "--json")
        if done.returncode != 0:
            raise ProgramError(f"{path} does not tell its settings (ukemi recipe --json): build it anew")
        _known[key] = json.loads(done.stdout)["settings"]
    return _known[key]


def help_page(preference=""):
    return _answer(find(preference), "help", "blender").stdout


def inspect(path, preference=""):
    """What `ukemi inspect --json` says of a file."""
    done = _answer(find(preference), "inspect", str(path), "--json")
    try:
        return json.loads(done.stdout)
    except ValueError as error:
        raise ProgramError(_reason(done.stderr)) from error


def _reason(text):
    """The program's error and what it says to do, without its name."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    wanted = [i for i, line in enumerate(lines) if line.startswith("ukemi: error:")]
    if not wanted:
        return lines[-1] if lines else "the program said nothing"
    error = re.sub(r"^\S*[/\\\\]rig\.glb: ", "", lines[wanted[0]][len("ukemi: error:") :].strip())
    fix = [line[len("fix:") :].strip() for line in lines[wanted[0] + 1 :] if line.startswith("fix:")]
    return f"{error}. {fix[0][:1].upper()}{fix[0][1:]}" if fix else error


class Run:
    """A run of the program that goes on beside Blender."""

    def __init__(self, arguments, preference=""):
        self._errors = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen(
                [find(preference), *map(str, arguments)],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=self._errors,
                **_hidden(),
            )
        except OSError as error:
            raise ProgramError(f"the program does not run: {error}") from error

    def running(self):
        return self._process.poll() is None

    def stop(self):
        """Ends the program, workers of a batch included."""
        if not self.running():
            return
        self._process.terminate()
        try:
            self._process.wait(5)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def progress(self):
        """The last line that the program said, or nothing."""
        self._errors.seek(0)
        lines = self._errors.read().decode("utf-8", "replace").replace("\r", "\n").split("\n")
        return next((line.strip() for line in reversed(lines) if line.strip()), "")

    def finish(self):
        """Waits for the end. Raises ProgramError with the program's own words where it failed."""
        self._process.wait()
        if self._process.returncode != 0:
            self._errors.seek(0)
            raise ProgramError(_reason(self._errors.read().decode("utf-8", "replace")))
