"""Bytes of a text file as text, in the encodings that measuring programs write."""

from __future__ import annotations

import codecs
from dataclasses import dataclass
from pathlib import Path

from flexspline.geometry.listed import joined
from flexspline.pipeline.diagnosis.measurement.errors import MeasurementError

MARKS = (
    (codecs.BOM_UTF8, "utf-8", "UTF-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le", "UTF-32"),  # begins as UTF-16's does: it comes first
    (codecs.BOM_UTF32_BE, "utf-32-be", "UTF-32"),
    (codecs.BOM_UTF16_LE, "utf-16-le", "UTF-16"),
    (codecs.BOM_UTF16_BE, "utf-16-be", "UTF-16"),
)
"""Byte order mark, codec, name."""
BINARY = (
    (b"\xd0\xcf\x11\xe0", "an old Excel file (.xls); save it as .xlsx or as CSV"),
    (b"TDSm", "a TDMS file; export it as CSV"),
    (b"MDF ", "an MDF file; export it as CSV"),
    (b"UnFinMF", "an MDF file; export it as CSV"),
    (b"MATLAB", "a MATLAB file; export it as CSV"),
    (b"\x89HDF", "an HDF5 file; export it as CSV"),
    (b"\x89PNG", "a picture (PNG); save the readings as CSV"),
    (b"\xff\xd8\xff", "a picture (JPEG); save the readings as CSV"),
    (b"%PDF", "a PDF file; save the readings as CSV"),
    (b"\x1f\x8b", "compressed; unpack it first"),
)
"""How other files begin, and what to do with them."""
SAMPLE_BYTES = 4096
"""Bytes that show whether every second one is 0."""
SIXTEEN_BIT = 0.9
"""Share of zero bytes at odd or even places: figures and separators of UTF-16 have one each."""


@dataclass(frozen=True)
class FileText:
    """Text of a file, and the name of its encoding."""

    text: str
    encoding: str


CODE_PAGES = ("cp1252", "cp1250", "gb18030", "cp932")
"""Of Windows in western and central Europe, China and Japan; nearly any bytes are text in the first two."""


def texts_of(path: Path, raw: bytes) -> tuple[FileText, ...]:
    """UTF-8 with or without mark, UTF-16 and UTF-32; else each of `CODE_PAGES` that the bytes are text in.

    Raises
    ------
    MeasurementError : another kind of file, or bytes that are text in none of these.
    """
    for begin, what in BINARY:
        if raw.startswith(begin):
            raise MeasurementError(path, None, f"is {what}")
    decoded = _decoded(path, raw)
    text = decoded[0].text
    if "\0" in text:
        line = text[: text.index("\0")].count("\n") + 1
        raise MeasurementError(path, line, "holds a NUL byte; save the file as CSV in UTF-8")
    return decoded


def _decoded(path: Path, raw: bytes) -> tuple[FileText, ...]:
    for mark, codec, name in MARKS:
        if raw.startswith(mark):
            return (_strict(path, raw[len(mark) :], codec, name),)
    begin = raw[:SAMPLE_BYTES]
    for place, codec in ((1, "utf-16-le"), (0, "utf-16-be")):
        half = begin[place::2]
        if len(raw) % 2 == 0 and half and half.count(0) >= SIXTEEN_BIT * len(half):
            return (_strict(path, raw, codec, "UTF-16"),)
    try:
        return (FileText(raw.decode("utf-8"), "UTF-8"),)
    except UnicodeDecodeError:
        pass
    texts, unread = [], 0
    for codec in CODE_PAGES:
        try:
            texts.append(FileText(raw.decode(codec), codec))
        except UnicodeDecodeError as error:
            unread = max(unread, error.start)
    if not texts:
        byte, line = raw[unread], raw[:unread].count(b"\n") + 1
        known = joined(CODE_PAGES, "or")
        reason = f"byte {byte:#04x} is not text in UTF-8, {known}; save the file as UTF-8"
        raise MeasurementError(path, line, reason)
    return tuple(texts)


def _strict(path: Path, raw: bytes, codec: str, name: str) -> FileText:
    try:
        return FileText(raw.decode(codec), name)
    except UnicodeDecodeError as error:
        line = raw[: error.start].decode(codec, "replace").count("\n") + 1
        reason = f"begins as {name} and is not; save the file as UTF-8"
        raise MeasurementError(path, line, reason) from None
