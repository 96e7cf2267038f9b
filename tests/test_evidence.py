"""A bundle of evidence: rebuilt byte for byte, and rejected however it was altered."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from click.testing import CliRunner, Result

from rotra.cli import main
from rotra.diagnostics import Rejected
from rotra.engines import places
from rotra.evidence import bundle
from rotra.evidence import statement as st
from rotra.evidence.check import check_bundle


def test_a_signature_binds_the_statement_to_the_key(tmp_path: Path) -> None:
    ours, shown = st.new_key(tmp_path / "key")
    _, foreign = st.new_key(tmp_path / "other")
    payload = st.as_bytes(st.statement({"a": st.digest(b"a")}, ["p"], [], "inputs/"))
    signed = st.envelope(payload, st.load_private(ours))
    assert st.signature_fault(signed, payload, st.load_public(shown)) == ""
    assert st.signature_fault(signed, payload, st.load_public(foreign)) == "is signed with another key"
    assert st.signature_fault(signed, payload + b" ", st.load_public(shown)) == "signs another statement than the one beside it"
    assert st.signature_fault({**signed, "signatures": []}, payload, st.load_public(shown)) == "is not an envelope with one signature"
    bad = {**signed["signatures"][0], "sig": "A" * 86 + "=="}
    assert st.signature_fault({**signed, "signatures": [bad]}, payload, st.load_public(shown)) == "the signature is bad"


def test_a_key_is_never_overwritten_and_its_owner_s_alone(tmp_path: Path) -> None:
    key, _ = st.new_key(tmp_path / "key")
    assert key.stat().st_mode & 0o077 == 0
    with pytest.raises(Rejected, match="EV102"):
        st.new_key(key)
    with pytest.raises(Rejected, match="EV101"):
        st.load_public(key)


PROPERTIES = ("never_crosses_on_red", "stops_at_white_line")


def rotra(*given: object) -> Result:
    return CliRunner().invoke(main, [str(g) for g in given])


def certified(folder: Path, *more: object) -> Path:
    asked = [word for name in PROPERTIES for word in ("--property", name)]
    answer = rotra("certify", "--agent", "reactive", "--scenario", "traffic_light", *asked, "-o", folder, *more)
    assert answer.exit_code == 0, answer.output
    return folder


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a signed bundle and two pairs of keys."""
    folder = tmp_path_factory.mktemp("evidence")
    st.new_key(folder / "other")
    certified(folder / "bundle", "--new-key", "--key", folder / "key")
    return folder


@pytest.fixture
def copy(made: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(made / "bundle", tmp_path / "bundle"))


def judged(folder: Path, *more: object) -> dict[str, Any]:
    answer = rotra("evidence", "verify", folder, "--json", *more)
    found = json.loads(answer.output)
    assert answer.exit_code == (0 if found["accepted"] else 1), answer.output
    return found


def names(folder: Path) -> list[str]:
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def rebound(folder: Path, key: Path | None) -> None:
    """What a forger does after altering files: derive, bind and sign everything anew."""
    verdicts = json.loads((folder / bundle.VERDICTS).read_text())
    for name, content in bundle.derived(verdicts).items():
        (folder / name).write_bytes(content)
    payload = bundle.statement_of({name: (folder / name).read_bytes() for name in names(folder)}, verdicts)
    (folder / bundle.STATEMENT).write_bytes(payload)
    (folder / bundle.ENVELOPE).unlink(missing_ok=True)
    if key is not None:
        (folder / bundle.ENVELOPE).write_bytes(st.as_bytes(st.envelope(payload, st.load_private(key))))


def edited(folder: Path, name: str, edit: Callable[[Any], None]) -> None:
    document = json.loads((folder / name).read_text())
    edit(document)
    (folder / name).write_bytes(st.as_bytes(document))


def test_an_untouched_bundle_is_accepted_by_who_has_the_key(made: Path) -> None:
    assert judged(made / "bundle", "--key", made / "key.pub") == {"accepted": True, "faults": [], "signature": "good"}
    assert judged(made / "bundle")["signature"] == "not checked"


def test_proved_again_it_says_the_same(made: Path) -> None:
    assert judged(made / "bundle", "--key", made / "key.pub", "--rerun")["accepted"]


def test_it_is_rebuilt_byte_for_byte(made: Path, tmp_path: Path) -> None:
    again = certified(tmp_path / "again", "--key", made / "key")
    assert names(again) == names(made / "bundle")
    assert [n for n in names(again) if (again / n).read_bytes() != (made / "bundle" / n).read_bytes()] in ([], [bundle.RUN])


def test_no_path_of_this_machine_is_in_it(made: Path) -> None:
    for name in names(made / "bundle"):
        content = (made / "bundle" / name).read_bytes()
        assert str(places.PROJECT).encode() not in content and str(made).encode() not in content, name


def test_any_single_byte_is_noticed(made: Path, copy: Path) -> None:
    for name in names(copy):
        if name == bundle.RUN:
            continue
        whole = (copy / name).read_bytes()
        for at in {0, len(whole) // 2, len(whole) - 1}:
            (copy / name).write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
            report = check_bundle(copy, st.load_public(made / "key.pub"))
            assert name in {f.file for f in report.faults}, (name, at)
        (copy / name).write_bytes(whole)
    assert check_bundle(copy, st.load_public(made / "key.pub")).accepted


def test_a_file_added_removed_or_swapped_is_named(made: Path, copy: Path) -> None:
    (copy / "inputs" / "<b>more.yaml").write_text("more")
    (copy / "logs" / "reactive" / "link").symlink_to(copy / bundle.RUN)
    one, two = sorted((copy / "traces").rglob("*.json"))
    content = one.read_bytes()
    one.write_bytes(two.read_bytes())
    two.write_bytes(content)
    (copy / bundle.TOOLS).unlink()
    faults = {(f["file"], f["fault"]) for f in judged(copy, "--key", made / "key.pub")["faults"]}
    assert {("inputs/<b>more.yaml", "was added"), ("logs/reactive/link", "is not a plain file"), (bundle.TOOLS, "is missing")} <= faults
    assert {(p.relative_to(copy).as_posix(), "was changed") for p in (one, two)} <= faults


def test_another_key_is_not_the_user_s(made: Path, copy: Path) -> None:
    assert not judged(copy, "--key", made / "other.pub")["accepted"]
    rebound(copy, made / "other")
    assert judged(copy, "--key", made / "key.pub")["faults"] == [{"file": bundle.ENVELOPE, "fault": "is signed with another key"}]


def test_an_unsigned_bundle_is_called_that(made: Path, copy: Path) -> None:
    rebound(copy, None)
    assert judged(copy) == {"accepted": True, "faults": [], "signature": "unsigned"}
    assert judged(copy, "--key", made / "key.pub")["faults"] == [{"file": bundle.ENVELOPE, "fault": "is missing: the bundle is unsigned"}]
    assert "unsigned" in rotra("evidence", "verify", copy).output


@pytest.mark.parametrize("claimed", ["violated", "vacuous", "unknown"])
def test_an_edited_verdict_is_seen_through_even_when_all_is_bound_anew(made: Path, copy: Path, claimed: str) -> None:
    def edit(document: Any) -> None:
        document["verdicts"][0]["verdict"] = claimed
        document["verdicts"][0]["as_expected"] = False

    edited(copy, bundle.VERDICTS, edit)
    rebound(copy, made / "key")
    faults = judged(copy, "--key", made / "key.pub")["faults"]
    assert any(f["file"] == bundle.VERDICTS and f"is called {claimed}, but logs/" in f["fault"] for f in faults)


def test_a_log_that_says_otherwise_supports_nothing(made: Path, copy: Path) -> None:
    log = copy / "logs" / "reactive" / "traffic_light.log"
    log.write_text(log.read_text().replace("is true", "is false"))
    rebound(copy, made / "key")
    assert any("says violated" in f["fault"] for f in judged(copy, "--key", made / "key.pub")["faults"])


def test_a_model_without_a_start_supports_nothing(made: Path, copy: Path) -> None:
    log = copy / "logs" / "reactive" / "traffic_light.log"
    log.write_text(log.read_text() + "The set of initial states is EMPTY\n")
    rebound(copy, made / "key")
    assert any("says unknown" in f["fault"] for f in judged(copy, "--key", made / "key.pub")["faults"])


def test_a_trace_that_did_not_happen_supports_nothing(copy: Path) -> None:
    edited(copy, bundle.REPLAYS, lambda document: document[min(document)].update(happened=False))
    rebound(copy, None)
    assert [f["fault"] for f in judged(copy)["faults"]] == ["did not happen in Jason"]


def test_inputs_that_prove_otherwise_are_found_by_proving_again(made: Path, copy: Path) -> None:
    properties = copy / "inputs" / "properties" / "signals.yaml"
    text = properties.read_text()
    start = text.index("formula:", text.index("- id: never_crosses_on_red"))
    properties.write_text(text[:start] + "formula: always crashed" + text[text.index("\n", start) :])
    rebound(copy, made / "key")
    assert judged(copy, "--key", made / "key.pub")["accepted"]
    faults = judged(copy, "--key", made / "key.pub", "--rerun")["faults"]
    assert [f["fault"] for f in faults] == ["reactive in traffic_light: never_crosses_on_red is called holds, proved again it is violated"]


@pytest.mark.parametrize("document", ["[]", "{}", '{"subject": 1}', "[" * 100_000, "\udcff", '{"claim": {}, "verdicts": [1]}'])
@pytest.mark.parametrize("name", [bundle.STATEMENT, bundle.ENVELOPE, bundle.VERDICTS, bundle.REPLAYS])
def test_nonsense_is_a_fault_and_no_crash(copy: Path, name: str, document: str) -> None:
    (copy / name).write_bytes(document.encode("utf-8", "surrogateescape"))
    assert not judged(copy)["accepted"]


def test_hostile_names_are_text(copy: Path) -> None:
    hostile = "</failure><script>alert('1')</script>\"\x00\x1b[31m../../etc"
    row = {"agent": hostile, "scenario": hostile, "property": hostile, "says": hostile, "verdict": "violated", "expected": "holds", "as_expected": False, "reason": hostile, "places": [{"file": hostile, "line": 1, "what": hostile}]}
    found = bundle.derived({"verdicts": [row]})
    failure = ElementTree.fromstring(found[bundle.JUNIT]).find("testsuite/testcase/failure")
    assert failure is not None and failure.text == hostile.replace("\x00", "\ufffd").replace("\x1b", "\ufffd") and len(failure) == 0
    (result,) = json.loads(found[bundle.SARIF])["runs"][0]["results"]
    assert result["ruleId"] == hostile and "<" not in result["locations"][0]["physicalLocation"]["artifactLocation"]["uri"]
    (copy / "\x1b[31mred").write_text("")
    assert "\x1b" not in rotra("evidence", "verify", copy).output


def test_a_folder_that_is_no_bundle_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "inputs").mkdir()
    assert "IO104" in rotra("certify", "--agent", "reactive", "--scenario", "traffic_light", "-o", tmp_path).output
    assert [p.name for p in tmp_path.iterdir()] == ["inputs"]


def test_the_judge_uses_nothing_that_made_the_verdicts() -> None:
    program = "import sys, rotra.evidence.check; print(*sorted(m for m in sys.modules if m.startswith('rotra.')))"
    loaded = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout.split()
    assert "rotra.evidence.check" in loaded
    assert not [m for m in loaded if m.split(".")[1] in ("lowering", "emitters", "pipeline", "frontends", "system")]
