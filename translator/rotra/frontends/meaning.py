"""The two small languages of directives.yaml: act patterns, and conditions over percepts.

    forward(N)        change_lane(left, _)        stop_line(0, A) & A >= 0 & not car(0, 1)

In: text.  Out: what is wrong with it in words, "" where nothing is.  Left to others: its meaning; the text goes into the
AgentSpeak rules as it stands, so nothing that could end the rule or call an internal action is let through.
"""

from __future__ import annotations

import re

ACTS = {"wait": 0, "forward": 1, "change_lane": 2, "turn": 2}
PERCEPTS = {"road": 3, "car": 2, "light": 3, "stop_line": 2, "speed": 1, "limit": 1, "heading": 1, "drives": 1, "task": 1}
_TOKEN = re.compile(r"\s*(?:(?P<number>\d+)|(?P<atom>[a-z][A-Za-z0-9_]*)|(?P<var>[A-Z_][A-Za-z0-9_]*)|(?P<op>==|\\==|<=|>=|<|>|=|[-+*(),&|]))")
_RELATIONS = ("==", "\\==", "<=", ">=", "<", ">", "=")
_WORDS = frozenset(["not", "true", "false", "div", "mod"])


def pattern_fault(text: str) -> str:
    """Why a text is not a pattern of an act."""
    found = re.fullmatch(r"\s*([a-z_][A-Za-z0-9_]*)\s*(?:\(([^()]*)\))?\s*", text)
    if found is None:
        return f"`{text}` is not an act"
    name, inside = found.groups()
    args = [a.strip() for a in inside.split(",")] if inside is not None else []
    if name not in ACTS:
        return f"there is no act {name}"
    if ACTS[name] != len(args):
        return f"{name} takes {ACTS[name]} argument{'s' if ACTS[name] != 1 else ''}"
    variable = re.compile(r"[A-Z_][A-Za-z0-9_]*")
    if args and not (variable.fullmatch(args[-1]) or re.fullmatch(r"[1-9]\d*", args[-1])):
        return f"{args[-1]!r} is not a number of cells"
    if len(args) == 2 and not (variable.fullmatch(args[0]) or args[0] in ("left", "right")):
        return f"{args[0]!r} is no side"
    return ""


def formula_fault(text: str) -> str:
    """Why a text is not a condition over percepts."""
    tokens: list[tuple[str, str]] = []
    at = 0
    while at < len(text.rstrip()):
        found = _TOKEN.match(text, at)
        if found is None:
            return f"{text[at:].strip()[:1]!r} does not belong in a condition"
        at = found.end()
        tokens.append((found.lastgroup or "", found.group(found.lastgroup or 0)))
    try:
        end = _alternatives(tokens, 0)
    except _Fault as fault:
        return str(fault)
    return "" if end == len(tokens) else f"{tokens[end][1]!r} is one too many"


class _Fault(Exception):
    pass


def _peek(tokens: list[tuple[str, str]], at: int) -> tuple[str, str]:
    return tokens[at] if at < len(tokens) else ("end", "the end")


def _alternatives(tokens: list[tuple[str, str]], at: int) -> int:
    at = _both(tokens, at)
    while _peek(tokens, at)[1] == "|":
        at = _both(tokens, at + 1)
    return at


def _both(tokens: list[tuple[str, str]], at: int) -> int:
    at = _condition(tokens, at)
    while _peek(tokens, at)[1] == "&":
        at = _condition(tokens, at + 1)
    return at


def _condition(tokens: list[tuple[str, str]], at: int) -> int:
    kind, word = _peek(tokens, at)
    if word == "not":
        return _condition(tokens, at + 1)
    if word in ("true", "false"):
        return at + 1
    if kind == "atom":
        if word in PERCEPTS and _peek(tokens, at + 1)[1] == "(":
            return _arguments(tokens, at + 2, word)
        if _peek(tokens, at + 1)[1] not in _RELATIONS:
            raise _Fault(f"{word} is not a percept" if word not in PERCEPTS else f"{word} takes {PERCEPTS[word]} arguments")
    if word == "(":
        try:  # a condition in brackets; else a sum in brackets, of a comparison
            end = _alternatives(tokens, at + 1)
            if _peek(tokens, end)[1] == ")" and _peek(tokens, end + 1)[1] not in (*_RELATIONS, "+", "-", "*"):
                return end + 1
        except _Fault:
            pass
    at = _sum(tokens, at)
    if _peek(tokens, at)[1] not in _RELATIONS:
        raise _Fault(f"a comparison is expected before {_peek(tokens, at)[1]!r}")
    return _sum(tokens, at + 1)


def _arguments(tokens: list[tuple[str, str]], at: int, name: str) -> int:
    count = 1
    at = _sum(tokens, at)
    while _peek(tokens, at)[1] == ",":
        count += 1
        at = _sum(tokens, at + 1)
    if _peek(tokens, at)[1] != ")":
        raise _Fault(f"{_peek(tokens, at)[1]!r} where the bracket of {name} should close")
    if count != PERCEPTS[name]:
        raise _Fault(f"{name} takes {PERCEPTS[name]} arguments, not {count}")
    return at + 1


def _sum(tokens: list[tuple[str, str]], at: int) -> int:
    at = _operand(tokens, at)
    while _peek(tokens, at)[1] in ("+", "-", "*", "div", "mod"):
        at = _operand(tokens, at + 1)
    return at


def _operand(tokens: list[tuple[str, str]], at: int) -> int:
    kind, word = _peek(tokens, at)
    if word == "-":
        return _operand(tokens, at + 1)
    if word == "(":
        at = _sum(tokens, at + 1)
        if _peek(tokens, at)[1] != ")":
            raise _Fault("a bracket is not closed")
        return at + 1
    if kind in ("number", "var") or (kind == "atom" and word not in _WORDS):
        return at + 1
    raise _Fault(f"a value is expected before {word!r}")
