"""A file is written whole or not at all."""

import os
import signal

import pytest

from flexspline.pipeline.cache import Cache
from flexspline.results.atomic import write_bytes, write_together


def test_written_file_replaces_the_old_one(tmp_path):
    path = tmp_path / "new folder" / "file"
    write_bytes(path, b"one")
    write_bytes(path, b"two")
    assert path.read_bytes() == b"two"
    assert [p.name for p in path.parent.iterdir()] == ["file"]


def test_interrupt_leaves_the_old_file_and_no_other(tmp_path, monkeypatch):
    path = tmp_path / "file"
    path.write_bytes(b"old")

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_bytes(path, b"new")
    assert path.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


def test_a_stop_before_the_last_file_is_made_leaves_none(tmp_path, monkeypatch):
    made = []

    def stopped(path, mode):
        made.append(path)
        if len(made) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(os, "chmod", stopped)
    with pytest.raises(KeyboardInterrupt):
        write_together(tmp_path, {"one": b"1", "two": b"2", "three": b"3"})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_request_to_end_waits_until_all_files_are_in_place(tmp_path, monkeypatch, number):
    def ends(_number, _frame):
        raise KeyboardInterrupt

    move, before = os.replace, signal.signal(number, ends)

    def moved(part, path):
        move(part, path)
        os.kill(os.getpid(), number)

    monkeypatch.setattr(os, "replace", moved)
    try:
        with pytest.raises(KeyboardInterrupt):
            write_together(tmp_path, {"one": b"1", "two": b"2"})
    finally:
        signal.signal(number, before)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["one", "two"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    "write",
    [
        lambda folder: write_together(folder, {"one": b"1", "two": b"2"}),
        lambda folder: Cache(folder).get("stage", {}, lambda: 1),
    ],
    ids=["answer", "cache"],
)
def test_a_request_to_end_as_soon_as_a_file_is_made_leaves_none(
    tmp_path, monkeypatch, write, number
):
    """Before whoever asked for the file has its handle."""

    def ends(_number, _frame):
        raise KeyboardInterrupt

    make, before = os.open, signal.signal(number, ends)
    made = []

    def opened(path, *how, **more):
        handle = make(path, *how, **more)
        if str(path).endswith(".part"):
            made.append(path)
            os.close(handle)
            signal.raise_signal(number)
        return handle

    monkeypatch.setattr(os, "open", opened)
    try:
        with pytest.raises(KeyboardInterrupt):
            write(tmp_path)
    finally:
        signal.signal(number, before)
    assert len(made) == 1
    assert [p for p in tmp_path.rglob("*") if p.is_file()] == []


def test_a_request_to_end_as_soon_as_a_file_is_written_leaves_none(tmp_path, monkeypatch):
    """Between its writing and whatever comes next."""

    def written(path, data):
        path.write_bytes(data)
        signal.raise_signal(signal.SIGINT)

    monkeypatch.setattr("flexspline.results.atomic.write_unfinished", written)
    with pytest.raises(KeyboardInterrupt):
        write_together(tmp_path, {"one": b"1", "two": b"2"})
    assert list(tmp_path.iterdir()) == []
