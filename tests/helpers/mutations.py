"""What happens to files on their way: flipped bits, wrong encodings, malice. Bytes in, bytes out."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np

Mutation = Callable[[bytes, np.random.Generator], bytes]

HUGE = (
    b"1e999",
    b"1" * 400,
    b"1" * 5000,
    b"1e308",
    b"-1e308",
    b"9e-999",
    b"0x" + b"f" * 5000,
    b"nan",
    b"-inf",
)
CONTROL = [chr(c) for c in range(32)] + [
    "\x7f",
    "\x85",
    "\x9b31m",
    "\u2028",
    "\u2029",
    "\u202e",
    "\x1b]0;owned\x07",
]
INJECTIONS = (
    "../../../etc/passwd", "/dev/zero", "/proc/self/mem", "C:\\\\con", "file:///etc/passwd", "..", ".",
    '#read(\\"/etc/passwd\\")', "#import sys: exit", "$\\\\frac$", "{{7*7}}", "${HOME}", "$(id > owned)",
    "`id > owned`", "%s%n%x", "{0.__class__}", "<script>alert(1)</script>", "=1+cmd|'/C calc'!A0",
    "'; DROP TABLE trials; --", "sqlite:////dev/full", "postgresql://127.0.0.1:1/x", "\\u001b[2J",
    "\\u0000", "-o",
)  # fmt: skip
"""Paths, templates, formulas, shells, terminals; backslashes as TOML escapes them."""
DEEP = 10_000


def flipped(data: bytes, rng: np.random.Generator) -> bytes:
    """One to eight bits turned."""
    out = bytearray(data)
    for at in rng.integers(0, len(out), int(rng.integers(1, 9))):
        out[at] ^= 1 << int(rng.integers(8))
    return bytes(out)


def truncated(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: int(rng.integers(0, len(data)))]


def recoded(data: bytes, rng: np.random.Generator) -> bytes:
    """Another program's idea of text: other encodings, marks at the start, other line ends."""
    text = data.decode()
    ways: tuple[Callable[[], bytes], ...] = (
        lambda: text.encode("utf-16"),
        lambda: text.encode("utf-16-be"),
        lambda: text.encode("utf-32"),
        lambda: b"\xef\xbb\xbf" + data,
        lambda: b"\xef\xbb\xbf\xef\xbb\xbf" + data,
        lambda: ("# Prüfstand, 20 °C\n" + text).encode("latin-1", "replace"),
        lambda: ("# “quoted”\n" + text).encode("cp1252", "replace"),
        lambda: text.replace("\n", "\r\n").encode(),
        lambda: text.replace("\n", "\r").encode(),
        lambda: data + b"\x1a",
        lambda: b"\x1f\x8b\x08\x00" + data,
        lambda: text.replace(",", ";").encode(),
    )
    return ways[int(rng.integers(len(ways)))]()


def huge(data: bytes, rng: np.random.Generator) -> bytes:
    """A number replaced by one that no double, or no gear, holds."""
    found = [*re.finditer(rb"(?<![\w.])-?\d+(\.\d+)?", data)]
    hit = found[int(rng.integers(len(found)))]
    return data[: hit.start()] + HUGE[int(rng.integers(len(HUGE)))] + data[hit.end() :]


def controlled(data: bytes, rng: np.random.Generator) -> bytes:
    """Control characters put in anywhere."""
    text = data.decode()
    for _ in range(int(rng.integers(1, 4))):
        at = int(rng.integers(len(text)))
        text = text[:at] + CONTROL[int(rng.integers(len(CONTROL)))] + text[at:]
    return text.encode()


def deep(data: bytes, rng: np.random.Generator) -> bytes:
    """Nested far deeper than any reader's stack, or lines and keys far longer than any screen."""
    ways: tuple[bytes, ...] = (
        b"x = " + b"[" * DEEP + b"]" * DEEP + b"\n" + data,
        b"x = " + b"[" * DEEP + b"\n" + data,
        b"x = " + b"{a=" * DEEP + b"1" + b"}" * DEEP + b"\n" + data,
        b".".join([b"a"] * DEEP) + b" = 1\n" + data,
        data + b"\n[" + b".".join([b"a"] * DEEP) + b"]\n",
        b"k" * 300_000 + b" = 1\n" + data,
        b'"' + b"k\\n" * 100_000 + b'" = 1\n' + data,
        data + b"\n" + b"x," * 300_000 + b"\n",
        b"x," * 5_000 + b"\n" + data,
        b"#" + b" " * 800_000 + b"\n" + data,
        data + b'\n"' + b"y\n" * 100_000,
        data * 40,
    )
    return ways[int(rng.integers(len(ways)))]


def injected(data: bytes, rng: np.random.Generator) -> bytes:
    """One string, or the first field of every row, replaced by a path, template, formula or command."""
    payload = INJECTIONS[int(rng.integers(len(INJECTIONS)))]
    text = data.decode()
    strings = [*re.finditer(r'"([^"\n]*)"', text)]
    if strings:
        hit = strings[int(rng.integers(len(strings)))]
        return (text[: hit.start(1)] + payload + text[hit.end(1) :]).encode()
    plain = (
        payload.replace('\\"', "'")
        .replace("\\\\", "\\")
        .replace("\\u001b", "\x1b")
        .replace(",", "")
    )
    lines = [s for s in text.splitlines() if not s.startswith("#")]
    if "unit" not in lines[0]:  # a sweep without units gets one
        rows = [f"unit,{lines[0]}", *(f'"{plain}",{s}' for s in lines[1:])]
    else:
        at = lines[0].split(",").index("unit")
        rows = [lines[0]]
        for s in lines[1:]:
            fields = s.split(",")
            rows.append(",".join([*fields[:at], f'"{plain}"', *fields[at + 1 :]]))
    if rng.random() < 0.3:
        rows[0] = rows[0].replace("torque_Nm", plain, 1)
    return ("\n".join(rows) + "\n").encode()


def shuffled(data: bytes, rng: np.random.Generator) -> bytes:
    """Lines lost, doubled or out of order."""
    lines = data.splitlines(keepends=True)
    i, j = (int(k) for k in rng.integers(len(lines), size=2))
    ways: tuple[Callable[[], list[bytes]], ...] = (
        lambda: lines[:i] + lines[i + 1 :],
        lambda: lines[: i + 1] + lines[i:],
        lambda: lines[:i] + lines[i:][::-1],
        lambda: [*lines[:i], lines[j], *lines[i:]],
    )
    return b"".join(ways[int(rng.integers(len(ways)))]())


MUTATIONS: dict[str, Mutation] = {
    "bit flips": flipped,
    "truncation": truncated,
    "wrong encodings, line ends": recoded,
    "huge numbers": huge,
    "control characters": controlled,
    "deep nesting, long lines and keys": deep,
    "path and template injection": injected,
    "lines lost, doubled, reversed": shuffled,
}


def mutated(data: bytes, seed: int) -> tuple[str, bytes]:
    """Mutation number `seed` of a file, and its name."""
    rng = np.random.default_rng([7, seed])
    name = [*MUTATIONS][seed % len(MUTATIONS)]
    return name, MUTATIONS[name](data, rng)
