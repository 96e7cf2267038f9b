"""Build NuSMV 2.5.4 from source, once a machine (see decisions/0001).

In: the source distribution of pynusmv 1.0rc8, fetched with pip and refused unless its hash is the pinned one; only the
NuSMV, CUDD and MiniSat sources inside it are used, never the Python binding.  Out: <target>/bin/NuSMV, tried on a small
model before it is put there.  Left to others: running it (engines/nusmv.py), what packages the build needs (packages.sh).

A finished build is kept in the user's cache, keyed by everything that shapes it, so a fresh clone copies it in a moment.

    python -m rotra.toolchain.nusmv .build/nusmv
"""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import sys
import tarfile
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from rotra.engines.process import Outcome, run

SOURCE = "pynusmv==1.0rc8"
SOURCE_SHA256 = "35af7cdd25dfc8dc357770f0764b2cb726aed219200bba2e58c25318b2425aa1"
# pip reads the metadata of what it downloads with this version of setuptools.
BUILD_CONSTRAINT = "setuptools==84.2.1"
VERSION = "2.5.4"
# The sources are older than the compilers: C of 1989 with common symbols, C++ of 1998.
C_FLAGS = "-O2 -std=gnu89 -fcommon -w"
CUDD_FLAGS = "-O3 -std=gnu89 -fcommon -w"
CXX = "g++ -std=gnu++98 -w"
STEP_SECONDS = 900


class BuildFailed(Exception):
    """A step of the build failed; the text says which and where its log is."""


def main(arguments: Sequence[str]) -> int:
    if len(arguments) != 1:
        print("usage: python -m rotra.toolchain.nusmv TARGET", file=sys.stderr)
        return 2
    try:
        install(Path(arguments[0]))
    except BuildFailed as reason:
        print(f"nusmv: {reason}", file=sys.stderr)
        return 3
    return 0


def install(target: Path) -> None:
    """Put a working NuSMV into `target`: the one there, else the cached one, else a new build."""
    if (target / "key").is_file() and (target / "key").read_text() == key() and not smoke(target / "bin" / "NuSMV"):
        print(f"nusmv: {target} is up to date")
        return
    cached = cache_folder() / f"nusmv-{VERSION}-{key()}"
    if (cached / "bin" / "NuSMV").is_file():
        fault = smoke(cached / "bin" / "NuSMV")
        if not fault:
            print(f"nusmv: reusing the build of {time.strftime('%Y-%m-%d', time.gmtime(cached.stat().st_mtime))} from the user's cache")
            _put(cached, target)
            return
        print(f"nusmv: the cached build does not work here ({fault}); building again")
    with tempfile.TemporaryDirectory(prefix="rotra-nusmv-") as workshop:
        built = _build(Path(workshop), target.with_name("nusmv-build.log"))
        try:
            _put(built, cached)
        except OSError as reason:
            print(f"nusmv: not kept in the user's cache: {reason}")
        _put(built, target)


def key() -> str:
    """What a build depends on, in sixteen digits: this recipe (with the source's hash in it) and the system."""
    system = ""
    release = Path("/etc/os-release")
    if release.is_file():
        system = "".join(sorted(line for line in release.read_text().splitlines(True) if line.startswith(("ID=", "VERSION_ID="))))
    recipe = Path(__file__).read_bytes() + f"{platform.system()} {platform.machine()} {system}".encode()
    return hashlib.sha256(recipe).hexdigest()[:16]


def cache_folder() -> Path:
    """Where builds are kept for every clone of one user."""
    home = os.environ.get("XDG_CACHE_HOME")
    return (Path(home) if home else Path.home() / ".cache") / "rotra"


SMOKE_MODEL = """\
MODULE main
VAR light : {red, amber, green};
    waited : 0..3;
ASSIGN init(light) := red;
       next(light) := case light = red : {red, green}; light = green : amber; TRUE : red; esac;
       init(waited) := 0;
       next(waited) := case light = green : 0; waited < 3 : (waited + 1) mod 4; TRUE : 3; esac;
INVARSPEC NAME bounded := waited <= 3;
INVARSPEC NAME never_green := light != green;
LTLSPEC NAME amber_after_green := G (light = amber -> Y light = green);
LTLSPEC NAME always_green_again := G F light = green;
LTLSPEC NAME always_green_by_sat := G F light = green;
"""
SMOKE_COMMANDS = """\
go
check_fsm
check_invar -P bounded
check_invar -P never_green
check_ltlspec -P amber_after_green
check_ltlspec -P always_green_again
set sat_solver MiniSat
go_bmc
check_ltlspec_bmc -k 4 -P always_green_by_sat
quit
"""
SMOKE_ANSWERS = (
    "The transition relation is total",
    "invariant waited <= 3  is true",
    "invariant light != green  is false",
    "-- Loop starts here",
    "-- no counterexample found with bound 0",
)


def smoke(program: Path) -> str:
    """Try `program` on a model with known answers; "" where all is right, else what is wrong."""
    with tempfile.TemporaryDirectory(prefix="rotra-smoke-") as folder:
        model, commands = Path(folder) / "smoke.smv", Path(folder) / "smoke.cmd"
        model.write_text(SMOKE_MODEL)
        commands.write_text(SMOKE_COMMANDS)
        outcome = run([program, "-source", commands.name, model.name], cwd=Path(folder), timeout=30)
    return smoke_fault(outcome)


def smoke_fault(outcome: Outcome) -> str:
    """What is wrong with the answers of a smoke test; "" for nothing."""
    if not outcome.ok:
        return outcome.why()
    text = outcome.stdout
    if f"This is NuSMV {VERSION}" not in text:
        return f"it does not say that it is NuSMV {VERSION}"
    for answer in SMOKE_ANSWERS:
        if answer not in text:
            return f"it does not say '{answer}'"
    verdicts = [line.rsplit(None, 1)[-1] for line in text.splitlines() if line.startswith(("-- specification", "-- invariant"))]
    if verdicts != ["true", "false", "true", "false", "false"]:
        return f"its verdicts are {' '.join(verdicts)}"
    return ""


def _build(workshop: Path, log: Path) -> Path:
    """Fetch, build and try; the finished folder."""
    log.parent.mkdir(parents=True, exist_ok=True)
    log.write_text("")
    jobs = f"-j{os.cpu_count() or 1}"

    def step(words: str, command: Sequence[str | Path], cwd: Path) -> None:
        print(f"nusmv: {words} ...", flush=True)
        # CUDD's makefiles do not stand the flags of the make that runs us (jobs, no built-in rules).
        outcome = run(command, cwd=cwd, timeout=STEP_SECONDS, environment={"MAKEFLAGS": "", "MFLAGS": ""})
        with log.open("a") as record:
            record.write(f"== {words}: {' '.join(outcome.command)}\n{outcome.stdout}{outcome.stderr}")
        if not outcome.ok:
            raise BuildFailed(f"{words} failed ({outcome.why()}); all of it is in {log}")

    wanted, constraint = workshop / "wanted.txt", workshop / "constraint.txt"
    wanted.write_text(f"{SOURCE} --hash=sha256:{SOURCE_SHA256}\n")
    constraint.write_text(BUILD_CONSTRAINT + "\n")
    print("nusmv: fetching the source ...", flush=True)
    fetched = run(
        [sys.executable, "-m", "pip", "download", "--disable-pip-version-check", "--no-deps", "--no-binary", ":all:", "--require-hashes",
         "-r", wanted.name, "-d", "source"],
        cwd=workshop,
        environment={"PIP_CONSTRAINT": str(constraint)},
        timeout=STEP_SECONDS,
    )  # fmt: skip
    log.write_text(fetched.stdout + fetched.stderr)
    archives = list((workshop / "source").glob("*.tar.gz"))
    if not archives or hashlib.sha256(archives[0].read_bytes()).hexdigest() != SOURCE_SHA256:
        raise BuildFailed(f"the source could not be fetched ({fetched.why()}); all of it is in {log}")
    with tarfile.open(archives[0]) as archive:
        archive.extractall(workshop, filter="data") if hasattr(tarfile, "data_filter") else archive.extractall(workshop)
    sources = next(workshop.glob("pynusmv-*/dependencies"))

    minisat = sources / "MiniSat"
    step("unpacking MiniSat", ["unzip", "-q", "minisat2-070721.zip"], minisat)
    for patch in ("nusmv.patch", "pynusmv.patch", "makefiles.patch"):
        step(f"patching MiniSat ({patch})", ["patch", "-p0", "-N", "-i", patch], minisat)
    step("building MiniSat", ["make", f"CXX={CXX}"], minisat / "minisat")

    step("unpacking NuSMV", ["tar", "-xzf", "NuSMV-2.5.4.tar.gz"], sources / "NuSMV")
    tree = sources / "NuSMV" / "NuSMV-2.5.4"
    cudd, nusmv = next(tree.glob("cudd-*")), tree / "nusmv"
    pipefork = cudd / "util" / "pipefork.c"
    pipefork.write_text(pipefork.read_text().replace("union wait", "int"))
    step("building CUDD", ["make", "-f", "Makefile_64bit", f"ICFLAGS={CUDD_FLAGS}"], cudd)
    solver = minisat / "minisat"
    step(
        "configuring NuSMV",
        ["./configure", "--enable-minisat", f"--with-minisat-libdir={solver}", f"--with-minisat-incdir={solver}", f"CFLAGS={C_FLAGS}"],
        nusmv,
    )
    step("building NuSMV", ["make", jobs], nusmv)

    built = workshop / "built"
    (built / "bin").mkdir(parents=True)
    shutil.copy2(nusmv / "NuSMV", built / "bin" / "NuSMV")
    for licence, name in (
        (nusmv / "LGPL-2.1", "LGPL-2.1"),
        (nusmv / "COPYING", "COPYING"),
        (cudd / "LICENSE", "CUDD"),
        (solver / "LICENSE", "MiniSat"),
    ):
        if licence.is_file():
            shutil.copy2(licence, built / name)
    (built / "SOURCE").write_text(f"NuSMV {VERSION} with CUDD and MiniSat, from {SOURCE} sha256:{SOURCE_SHA256}\n")
    (built / "key").write_text(key())
    print("nusmv: trying it ...", flush=True)
    fault = smoke(built / "bin" / "NuSMV")
    if fault:
        raise BuildFailed(f"the new binary does not work: {fault}")
    return built


def _put(source: Path, target: Path) -> None:
    """Copy a folder so that `target` is the old one or the whole new one, never half of it."""
    target.parent.mkdir(parents=True, exist_ok=True)
    fresh = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    try:
        shutil.copytree(source, fresh, dirs_exist_ok=True)
        fresh.chmod(0o755)
        if target.exists():
            old = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
            target.rename(old / "old")
            fresh.rename(target)
            shutil.rmtree(old, ignore_errors=True)
        else:
            fresh.rename(target)
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
