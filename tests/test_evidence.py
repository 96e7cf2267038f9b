"""A bundle of evidence: rebuilt byte for byte, and rejected however it was altered."""

from __future__ import annotations

from pathlib import Path

import pytest

from rotra.diagnostics import Rejected
from rotra.evidence import statement as st


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
