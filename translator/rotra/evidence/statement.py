"""Bind the files of a bundle to each other, and to a person: an in-toto statement, signed in a DSSE envelope.

In: digests of files, which tests passed, a key file.  Out: the statement's and the envelope's bytes; is a signature good?
Errors: EV101 for a key that cannot be read, EV102 for one that would be overwritten.  Left to others: what the files say.
The arithmetic of Ed25519 is the library's (decisions/0006).
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

from rotra.diagnostics import Rejected, problem
from rotra.origins import Origin

STATEMENT_TYPE = "https://in-toto.io/Statement/v1"
PREDICATE_TYPE = "https://in-toto.io/attestation/test-result/v0.1"
PAYLOAD_TYPE = "application/vnd.in-toto+json"


def as_bytes(document: Any) -> bytes:
    """The one way in which a document of a bundle is written: sorted keys, a line end at the end."""
    return (json.dumps(document, indent=1, sort_keys=True, ensure_ascii=False) + "\n").encode()


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def statement(digests: Mapping[str, str], passed: Sequence[str], failed: Sequence[str], inputs: str) -> dict[str, Any]:
    """An in-toto statement over all files; `inputs` is the start of the names of those that were tested."""
    return {
        "_type": STATEMENT_TYPE,
        "subject": [_descriptor(name, digests[name]) for name in sorted(digests)],
        "predicateType": PREDICATE_TYPE,
        "predicate": {
            "result": "FAILED" if failed else "PASSED",
            "configuration": [_descriptor(name, digests[name]) for name in sorted(digests) if name.startswith(inputs)],
            "passedTests": sorted(passed),
            "failedTests": sorted(failed),
            "warnedTests": [],
        },
    }


def _descriptor(name: str, sha256: str) -> dict[str, Any]:
    return {"name": name, "digest": {"sha256": sha256}}


def envelope(payload: bytes, key: Ed25519PrivateKey) -> dict[str, Any]:
    """The payload and its signature, as DSSE 1.0 has them."""
    signature = {"keyid": key_id(key.public_key()), "sig": _text(key.sign(_to_sign(payload)))}
    return {"payloadType": PAYLOAD_TYPE, "payload": _text(payload), "signatures": [signature]}


def signature_fault(document: Any, payload: bytes, key: Ed25519PublicKey | None) -> str:
    """Why the envelope does not bind this payload to this key; "" where it does.  Without a key only its payload is looked at."""
    match document:
        case {"payloadType": str(kind), "payload": str(held), "signatures": [{"sig": str(sig), "keyid": str(by)}], **more} if not more:
            pass
        case _:
            return "is not an envelope with one signature"
    if kind != PAYLOAD_TYPE:
        return "its payload is of another type"
    try:
        content, signed = base64.b64decode(held, validate=True), base64.b64decode(sig, validate=True)
    except binascii.Error:
        return "is not an envelope: its base 64 cannot be read"
    if content != payload:
        return "signs another statement than the one beside it"
    if key is None:
        return ""
    try:
        key.verify(signed, _to_sign(content))
    except InvalidSignature:
        return "the signature is bad" if by == key_id(key) else "is signed with another key"
    return "" if by == key_id(key) else "names another key than the one that signed"


def _to_sign(payload: bytes) -> bytes:
    """DSSE's pre-authentication encoding: the type is signed with the payload."""
    kind = PAYLOAD_TYPE.encode()
    return b"DSSEv1 %d %s %d %s" % (len(kind), kind, len(payload), payload)


def _text(content: bytes) -> str:
    return base64.b64encode(content).decode("ascii")


def key_id(key: Ed25519PublicKey) -> str:
    return digest(key.public_bytes(serialization.Encoding.Raw, serialization.PublicFormat.Raw))


def new_key(path: Path) -> tuple[Path, Path]:
    """Make a pair of keys: the private one in `path`, readable by its owner alone, the public one beside it as `.pub`."""
    public = path.with_name(path.name + ".pub")
    there = [p for p in (path, public) if p.exists() or p.is_symlink()]
    if there:
        raise Rejected([problem("EV102", Origin(str(p)), "a key would be overwritten", "name a file that does not exist yet") for p in there])
    key = Ed25519PrivateKey.generate()
    secret = key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption())
    shown = key.public_key().public_bytes(serialization.Encoding.PEM, serialization.PublicFormat.SubjectPublicKeyInfo)
    try:
        with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
            file.write(secret)
        public.write_bytes(shown)
    except OSError as error:
        raise Rejected([problem("EV102", Origin(str(path)), f"the key cannot be written: {error.strerror}", "name a file in a folder of yours")]) from error
    return path, public


def load_private(path: Path) -> Ed25519PrivateKey:
    try:
        key = serialization.load_pem_private_key(path.read_bytes(), password=None)
    except (OSError, ValueError, TypeError, UnsupportedAlgorithm) as error:
        raise _no_key(path, "private") from error
    if not isinstance(key, Ed25519PrivateKey):
        raise _no_key(path, "private")
    return key


def load_public(path: Path) -> Ed25519PublicKey:
    try:
        key = serialization.load_pem_public_key(path.read_bytes())
    except (OSError, ValueError, TypeError, UnsupportedAlgorithm) as error:
        raise _no_key(path, "public") from error
    if not isinstance(key, Ed25519PublicKey):
        raise _no_key(path, "public")
    return key


def _no_key(path: Path, kind: str) -> Rejected:
    return Rejected([problem("EV101", Origin(str(path)), f"there is no {kind} Ed25519 key in this file", "rotra certify --new-key --key FILE makes FILE and FILE.pub; sign with the first, verify with the second")])
