"""Plain replacements for letters that a terminal or a file cannot show."""

from __future__ import annotations

import codecs
import json
import re
import unicodedata

PLAIN = "flexspline-plain"
"""Name of the errors handler: a letter that an encoding lacks becomes plain ones."""
ASCII = "flexspline-ascii"
"""Name of the codec: ASCII, letters beyond it as `PLAIN` writes them.

The command line's library takes a stream called "ascii" for a mistake and writes UTF-8 to it.
"""
STAND_INS = {
    "·": "*", "×": "x", "−": "-", "–": "-", "—": "-", "±": "+-", "≈": "~", "∝": "~", "≤": "<=",
    "≥": ">=", "≠": "!=", "√": "sqrt ", "∫": "integral ", "∞": "inf", "→": "->", "°": "deg", "′": "'",
    "″": "''", "“": "'", "”": "'", "„": "'", "‘": "'", "’": "'", "…": "...", "•": "*", "½": "1/2",
    "¹": "^1", "²": "^2", "³": "^3", "⁻": "^-", "ᵀ": "^T", "µ": "u", "Ø": "O", "ø": "o", "ß": "ss",
    "æ": "ae", "Æ": "AE", "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon",
    "θ": "theta", "ϑ": "theta", "κ": "kappa", "λ": "lambda", "μ": "u", "ν": "nu", "π": "pi", "ρ": "rho",
    "σ": "sigma", "τ": "tau", "φ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega", "Γ": "Gamma",
    "Δ": "Delta", "Θ": "Theta", "Σ": "Sigma", "Φ": "Phi", "Ω": "Ohm",
}  # fmt: skip
"""No double quote and no backslash among them: inside a string of a TOML file they end nothing."""


def plain(text: str) -> str:
    """The text in ASCII: stand-ins, letters without their accents, escapes for what has neither.

    >>> plain("±0.5 µm at 20 °C, Prüfstand")
    '+-0.5 um at 20 degC, Prufstand'
    """
    return "".join(c if c.isascii() else _plain(c) for c in text)


def escaped(json_text: str) -> str:
    """JSON in ASCII that says the same."""
    return re.sub(r"[^\x00-\x7f]", lambda match: json.dumps(match[0])[1:-1], json_text)


def _plain(letter: str) -> str:
    if letter in STAND_INS:
        return STAND_INS[letter]
    parts = unicodedata.normalize("NFKD", letter)
    kept = "".join(STAND_INS.get(c, c) for c in parts if not unicodedata.combining(c))
    return kept if kept.isascii() else letter.encode("ascii", "backslashreplace").decode()


def _handler(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return plain(error.object[error.start : error.end]), error.end


class _Encoder(codecs.IncrementalEncoder):
    def encode(self, text: str, final: bool = False) -> bytes:
        return plain(text).encode("ascii")


def _codec(name: str) -> codecs.CodecInfo | None:
    if name.replace("_", "-") != ASCII:
        return None
    return codecs.CodecInfo(
        lambda text, errors="strict": (plain(text).encode("ascii"), len(text)),
        codecs.lookup("ascii").decode,
        incrementalencoder=_Encoder,
        incrementaldecoder=codecs.lookup("ascii").incrementaldecoder,
        name=ASCII,
    )


codecs.register_error(PLAIN, _handler)
codecs.register(_codec)
