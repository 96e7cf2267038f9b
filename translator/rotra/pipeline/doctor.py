"""What of the tool chain is on this machine, which versions, and what installs the rest.

In: the machine.  Out: a tuple of `Finding`, in the order in which things are needed.  Left to others: printing, and that a
needed thing that is missing makes the command end with status 3 (cli.py).  Nothing is installed here.
"""

from __future__ import annotations

import importlib.metadata
import os
import platform
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rotra.engines import places
from rotra.engines.process import Outcome, run

_SECONDS = 30
_SETUP = "make setup"


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing the tool chain needs.

    `found`: its version, None where it is missing or does not work.  `wanted`: the version asked for, "" for any.
    `needed`: can nothing be proved or run without it?  (A compiler is not, once NuSMV is built.)
    `install`: the command that installs it.  `remark`: what is wrong, where more is to be said than "missing".
    """

    name: str
    found: str | None
    wanted: str
    needed: bool
    install: str
    remark: str = ""

    @property
    def ok(self) -> bool:
        return self.found is not None and not self.remark

    def as_json(self) -> dict[str, object]:
        return {
            "name": self.name,
            "found": self.found,
            "wanted": self.wanted,
            "needed": self.needed,
            "ok": self.ok,
            "install": None if self.ok else self.install,
            "remark": self.remark,
        }

    def text(self) -> str:
        """One line for the terminal."""
        state = self.found if self.found is not None else "missing"
        wanted = f" (wanted: {self.wanted})" if self.wanted and not self.ok else ""
        remark = f" {self.remark}" if self.remark else ""
        way_out = "" if self.ok else f"   -> {self.install}"
        return f"{'ok     ' if self.ok else 'MISSING' if self.needed else 'absent '} {self.name:<18} {state}{wanted}{remark}{way_out}"


@dataclass(frozen=True, slots=True)
class Program:
    """A program on the path: how it tells its version, the least major version, the Debian package that brings it."""

    name: str
    command: tuple[str, ...]
    least: tuple[int, ...]
    package: str


BUILD_PROGRAMS = (
    Program("gcc", ("gcc", "--version"), (), "gcc"),
    Program("g++", ("g++", "--version"), (), "g++"),
    Program("make", ("make", "--version"), (), "make"),
    Program("flex", ("flex", "--version"), (), "flex"),
    Program("bison", ("bison", "--version"), (), "bison"),
    Program("patch", ("patch", "--version"), (), "patch"),
    Program("unzip", ("unzip", "-v"), (), "unzip"),
)
# What the command imports; the lock holds their versions.
LIBRARIES = ("click", "Jinja2", "jsonschema", "lark", "python-sat", "PyYAML", "rich")
BUILD_HEADERS = (("expat headers", "expat.h", "libexpat1-dev"), ("readline headers", "readline/readline.h", "libreadline-dev"))


def examine() -> tuple[Finding, ...]:
    """Look at everything; the same order each time."""
    nusmv = examine_nusmv(places.nusmv())
    java_side = examine_java_side(places.classpath_file(), places.classes())
    build = not nusmv.ok
    java = Program("Java", (places.java(), "-version"), (17,), "openjdk-17-jdk-headless")
    compiler = Program("Java compiler", ("javac", "-version"), (17,), "openjdk-17-jdk-headless")
    maven = Program("Maven", ("mvn", "--version"), (3, 6), "maven")
    return (
        examine_python(sys.version_info[:3]),
        *examine_libraries(places.PROJECT / "requirements.txt"),
        examine_program(java, needed=True),
        examine_program(compiler, needed=not java_side[-1].ok),
        examine_program(maven, needed=not java_side[-1].ok),
        *java_side,
        nusmv,
        *(examine_program(program, needed=build) for program in BUILD_PROGRAMS),
        *(examine_header(*header, needed=build) for header in BUILD_HEADERS),
    )


def examine_python(version: Sequence[int]) -> Finding:
    text = ".".join(map(str, version))
    old = "is too old" if tuple(version) < (3, 11) else ""
    return Finding("Python", text, "3.11 or later", True, apt("python3"), old)


def examine_libraries(lock: Path) -> tuple[Finding, ...]:
    """Each library that the command itself names, one finding; what only tests or other libraries need, one in all."""
    if not lock.is_file():
        return (Finding("Python libraries", None, "requirements.txt", True, "git checkout requirements.txt", "the lock is gone"),)
    locked = re.findall(r"^([A-Za-z0-9_.-]+)==(\S+)", lock.read_text(encoding="utf-8"), re.MULTILINE)
    findings = tuple(_library(name, wanted) for name, wanted in locked)
    rest = [finding for finding in findings if finding.name not in LIBRARIES]
    wrong = [finding.name for finding in rest if not finding.ok]
    remark = f"not as locked: {', '.join(wrong)}" if wrong else ""
    summary = Finding("other libraries", f"{len(rest) - len(wrong)} of {len(rest)}", "requirements.txt", False, _SETUP, remark)
    return (*(finding for finding in findings if finding.name in LIBRARIES), summary)


def _library(name: str, wanted: str) -> Finding:
    try:
        found: str | None = importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        found = None
    return Finding(name, found, wanted, True, _SETUP, "is another version" if found not in (None, wanted) else "")


def examine_program(program: Program, *, needed: bool) -> Finding:
    """Ask a program for its version."""
    outcome = run(program.command, timeout=_SECONDS)
    wanted = ".".join(map(str, program.least)) + " or later" if program.least else ""
    found = version_in(outcome) if outcome.ok else None
    remark = ""
    if found is not None and tuple(int(part) for part in re.findall(r"\d+", found)) < program.least:
        remark = "is too old"
    return Finding(program.name, found, wanted, needed, apt(program.package), remark)


def examine_header(name: str, header: str, package: str, *, needed: bool) -> Finding:
    """Does the C compiler find a header?"""
    outcome = run(["gcc", "-E", "-"], stdin=f"#include <stdio.h>\n#include <{header}>\n", timeout=_SECONDS)
    return Finding(name, "present" if outcome.ok else None, "", needed, apt(package))


def examine_nusmv(binary: Path) -> Finding:
    """Start the binary that proofs would use."""
    wanted = "2.5.4"
    if not binary.is_file():
        return Finding("NuSMV", None, wanted, True, _SETUP)
    outcome = run([binary, "-h"], timeout=_SECONDS)
    said = re.search(r"This is NuSMV (\S+)", outcome.stdout + outcome.stderr)
    if said is None:
        return Finding("NuSMV", None, wanted, True, f"make distclean && {_SETUP}", f"does not start: {outcome.why()}")
    found = said.group(1)
    return Finding("NuSMV", found, wanted, True, _SETUP, "" if found == wanted else "is another version")


def examine_java_side(classpath: Path, classes: Sequence[Path]) -> tuple[Finding, Finding]:
    """Jason's jar, as the class path names it, and the project's own classes."""
    wanted = "3.2.1"
    jars = classpath.read_text(encoding="utf-8").strip().split(os.pathsep) if classpath.is_file() else []
    jason = [Path(jar) for jar in jars if Path(jar).name.startswith("jason-interpreter-")]
    if not jason:
        first = Finding("Jason", None, wanted, True, _SETUP)
    else:
        found = jason[0].name.removeprefix("jason-interpreter-").removesuffix(".jar")
        gone = "" if jason[0].is_file() else "its jar is no longer where it was"
        first = Finding(
            "Jason", found, wanted, True, f"make clean && {_SETUP}" if gone else _SETUP, gone or ("" if found == wanted else "is another version")
        )
    missing = [folder for folder in classes if not any(folder.rglob("*.class"))]
    second = Finding("Java side", None if missing or not jars else "built", "", True, _SETUP)
    return first, second


def version_in(outcome: Outcome) -> str | None:
    """The first thing in what a program said that looks like a version (some say it on the error stream)."""
    match = re.search(r"\d+(?:\.\d+)+", outcome.stdout + "\n" + outcome.stderr)
    return match.group(0) if match else None


def apt(package: str) -> str:
    """The command that installs a Debian package."""
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    command = f"apt-get install -y {package}" if root else f"sudo apt-get install -y {package}"
    return command if platform.system() == "Linux" else f"install {package} with the system's package manager"


def healthy(findings: Sequence[Finding]) -> bool:
    """Is all there that is needed?"""
    return all(finding.ok or not finding.needed for finding in findings)
