"""What every test shares: skips that fail where engines are required, and expected files that are rewritten on request."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest


# The published rule base is no part of the project (tests/reference.py): without it its tests are skipped, everywhere.
NOT_OURS = "ROTRA_REFERENCE"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--update-expected", action="store_true", help="rewrite the expected files; review the diff as code")


@pytest.fixture
def expected(request: pytest.FixtureRequest) -> Callable[[Path, str], None]:
    """`expected(file, text)`: the text is what the file holds; with --update-expected it becomes so."""

    def compare(file: Path, text: str) -> None:
        if request.config.getoption("--update-expected"):
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
            return
        assert file.is_file(), f"{file} does not exist; pytest --update-expected writes it"
        assert text == file.read_text(encoding="utf-8")

    return compare


def engines_required() -> bool:
    """Does a skipped test count as failed?  .ci/run says so."""
    return os.environ.get("ROTRA_REQUIRE_ENGINES", "") not in ("", "0")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
    report = yield
    return _refuse_skip(report)


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Iterator[None]:
    report = yield
    return _refuse_skip(report)


def _refuse_skip(report):  # type: ignore[no-untyped-def]
    if engines_required() and report.skipped and not hasattr(report, "wasxfail"):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else str(report.longrepr)
        if NOT_OURS in reason:
            return report
        report.outcome = "failed"
        report.longrepr = f"{report.nodeid}: {reason} -- a skip is a failure here: every engine is required"
    return report
