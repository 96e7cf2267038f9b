"""The layout of a bundle of evidence, and what follows from its verdicts: JUnit, SARIF, the statement over all files.

In: the document `verdicts.json`, the bytes of the files.  Out: bytes.  Left to others: proving and collecting
(pipeline/certify.py), judging a bundle (check.py), signing (statement.py).  Names of files and properties are the
user's: they get into XML and JSON as text, by the libraries.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any
from urllib.parse import quote
from xml.etree import ElementTree

from rotra.evidence.statement import as_bytes, digest, statement

INPUTS = "inputs/"
VERDICTS, REPLAYS, ASSUMPTIONS, TOOLS = "verdicts.json", "replays.json", "assumptions.json", "tools.json"
JUNIT, SARIF = "junit.xml", "results.sarif"
STATEMENT, ENVELOPE, RUN = "statement.json", "statement.dsse.json", "run.json"
# bound by nothing: what is signed cannot name its own signature, and time and machine differ from run to run
UNBOUND = frozenset({STATEMENT, ENVELOPE, RUN})
NEEDED = frozenset({VERDICTS, REPLAYS, ASSUMPTIONS, TOOLS, JUNIT, SARIF})
TOP = UNBOUND | NEEDED | {"inputs", "models", "logs", "traces"}
_NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def title(row: Mapping[str, Any]) -> str:
    return f"{row['agent']} in {row['scenario']}: {row['property']}"


def passed(row: Mapping[str, Any]) -> bool:
    """Is the verdict what was expected; where nothing is expected, is there one?"""
    return row["as_expected"] is not False and row["verdict"] != "unknown"


def derived(verdicts: Mapping[str, Any]) -> dict[str, bytes]:
    """The files that say the verdicts again, for other tools."""
    return {JUNIT: _junit(verdicts["verdicts"]), SARIF: as_bytes(_sarif(verdicts["verdicts"]))}


def statement_of(files: Mapping[str, bytes], verdicts: Mapping[str, Any]) -> bytes:
    """The statement over all bound files."""
    rows = verdicts["verdicts"]
    digests = {name: digest(content) for name, content in files.items() if name not in UNBOUND}
    return as_bytes(statement(digests, [title(r) for r in rows if passed(r)], [title(r) for r in rows if not passed(r)], INPUTS))


def _junit(rows: list[Any]) -> bytes:
    root = ElementTree.Element("testsuites")
    suites: dict[tuple[str, str], list[Any]] = {}
    for row in rows:
        suites.setdefault((row["agent"], row["scenario"]), []).append(row)
    for (agent, scenario), cases in suites.items():
        failures = sum(not passed(r) for r in cases)
        suite = ElementTree.SubElement(root, "testsuite", name=_xml(f"{agent} in {scenario}"), tests=str(len(cases)), failures=str(failures), errors="0")
        for row in cases:
            case = ElementTree.SubElement(suite, "testcase", classname=_xml(f"{agent}.{scenario}"), name=_xml(row["property"]))
            if not passed(row):
                ElementTree.SubElement(case, "failure", message=_xml(_message(row))).text = _xml(row["says"])
    ElementTree.indent(root, " ")
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"


def _xml(text: str) -> str:
    """Characters that XML cannot hold show as the sign for what cannot be shown."""
    return _NOT_XML.sub("\ufffd", str(text))


def _message(row: Mapping[str, Any]) -> str:
    expected = f", {row['expected']} was expected" if row["as_expected"] is False else ""
    return f"{title(row)} is {row['verdict']}{expected}" + (f": {row['reason']}" if row["reason"] else "")


def _sarif(rows: list[Any]) -> dict[str, Any]:
    rules = {r["property"]: {"id": r["property"], "shortDescription": {"text": r["says"]}} for r in rows}
    results = [_result(r) for r in rows if r["verdict"] != "holds" or not passed(r)]
    driver = {"name": "RoTRA", "rules": [rules[name] for name in sorted(rules)]}
    return {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [{"tool": {"driver": driver}, "results": results}]}


def _result(row: Mapping[str, Any]) -> dict[str, Any]:
    """Where the property, the rules that it cites and the last plan of the counterexample stand; expected findings are notes."""
    first, *others = [_location(p) for p in row["places"]]
    level = "note" if passed(row) else "error"
    return {"ruleId": row["property"], "level": level, "message": {"text": _message(row)}, "locations": [first], "relatedLocations": others}


def _location(place: Mapping[str, Any]) -> dict[str, Any]:
    where = {"artifactLocation": {"uri": quote(place["file"])}, "region": {"startLine": max(1, place["line"])}}
    return {"physicalLocation": where, "message": {"text": place["what"]}}
