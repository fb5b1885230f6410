"""report.html: the PDF's content, names as data, nothing from outside, the same bytes again."""

import json
import re

import pytest
from blank_pictures import blank_pictures
from hand_made_gear import content, design
from page_text import letters, pdf_letters, read_page, spans, strings
from written_report import payload, write_report

from flexspline.results.report.content import ExtendedSum
from flexspline.results.report.document import Document, Heading, Paragraph
from flexspline.results.report.page import page_of, png
from flexspline.results.report.payload import payload_of
from flexspline.results.report.sections import run_document
from flexspline.results.report.spans import ref

NASTY = [
    '#read("/etc/passwd")',
    "<script>alert(1)</script>",
    "</script><img src=x onerror=alert(1)>",
    "{{7*7}} {% raw %} ${7*7} #{7*7}",
    '"); #panic("x") // \' --> <!--',
    "&lt;b&gt; &amp; K_b",
]
VIEW = {
    "title": "Flexspline", "subtitle": "torque", "note": "", "camera": {}, "scene": "AAAA",
    "bar": {"label": "von Mises", "beyond": True, "ticks": [{"at": 0.0, "text": "0"}]},
    "mark": {"text": "peak", "at": [0, 0, 0], "normal": [0, 0, 1]},
}  # fmt: skip


def page(made, views=None):
    return page_of(
        run_document(made), {n: png(p) for n, p in made.pictures.items()}, views
    ).decode()


def test_pdf_and_page_say_the_payload(tmp_path):
    made = content(
        pictures=blank_pictures(tmp_path),
        warnings=("the wall is thin",),
        extended=ExtendedSum("m.toml", 90.0),
    )
    write_report(tmp_path / "r.pdf", made)
    printed = pdf_letters(tmp_path / "r.pdf")
    shown, _, _ = read_page(page(made))
    said = payload(made)
    found = [t for t in strings(said) if t.strip()]
    assert len(found) > 150  # a payload that shrank to nothing would agree with anything
    for text in found:
        assert letters(text) in shown, text
        assert letters(text) in printed, text
    numbers = {n for t in found for n in re.findall(r"\d+(?:[.\u202f]\d+)*", t)}
    assert len(numbers) > 60
    for number in numbers:
        assert letters(number) in printed
        assert letters(number) in shown
    symbols = [s["text"] for s in spans(said) if s["style"] == "symbol"]
    for symbol in symbols:
        assert letters(symbol.replace("_", "")) in shown, symbol


@pytest.mark.parametrize(
    "name", [" ".join(NASTY), *(pytest.param(n, marks=pytest.mark.long) for n in NASTY)]
)
def test_names_print_as_their_letters(name, tmp_path):
    plain = content(
        pictures=blank_pictures(tmp_path), warnings=("x",), extended=ExtendedSum("x", 90.0)
    )
    nasty = content(
        pictures=plain.pictures, design=design(name=name, material=name), warnings=("x",),
        extended=ExtendedSum(name, 90.0), stage_seconds={name: 1.0},
    )  # fmt: skip
    shown, tags, _ = read_page(page(nasty))
    # running head, title, facts, budget's caption, stages; warnings are the program's words, with symbols
    assert shown.count(letters(name)) >= 5
    assert tags == read_page(page(plain))[1]  # not a tag more
    write_report(tmp_path / "r.pdf", nasty)
    printed = pdf_letters(tmp_path / "r.pdf")
    assert printed.count(letters(name)) >= 6
    assert "root:" not in printed


@pytest.mark.parametrize("name", NASTY)
def test_words_of_a_view_stay_in_their_json(name, tmp_path):
    view = VIEW | {"title": name, "mark": VIEW["mark"] | {"text": name}}
    made = content(pictures=blank_pictures(tmp_path))
    nasty = page(made, {"flexspline_torque": json.dumps(view).encode()})
    plain = page(made, {"flexspline_torque": json.dumps(VIEW).encode()})
    assert read_page(nasty)[1] == read_page(plain)[1]
    found = re.search(r'<script type="application/json" id="views">(.*?)</script>', nasty, re.S)
    assert json.loads(found.group(1))["views"]["flexspline_torque"]["mark"]["text"] == name


def test_nothing_comes_from_outside(tmp_path):
    made = content(pictures=blank_pictures(tmp_path))
    for text in (page(made), page(made, {"flexspline_torque": json.dumps(VIEW).encode()})):
        _, tags, attributes = read_page(text)
        assert not {"link", "iframe", "object", "embed", "base", "form"} & set(tags)
        for tag, name, value in attributes:
            assert not name.startswith("on"), (tag, name)
            if name in ("src", "href", "srcset", "data", "action", "poster"):
                own = ("data:image/", "data:application/toml;base64,", "#")
                assert value.startswith(own), (tag, name, value[:60])
        style = "".join(re.findall(r"<style>(.*?)</style>", text, re.S))
        assert "url(" not in style
        assert "@import" not in style
        policy = policy_of(attributes)
        assert policy["default-src"] == ["'none'"]
        assert policy["img-src"] == ["data:"]
        assert not {"connect-src", "font-src", "frame-src", "worker-src"} & set(policy)
        assert not any("unsafe" in value for values in policy.values() for value in values)
        # what turns the views; without one no script at all
        views = 'id="views"' in text
        assert [s[:8] for s in policy["script-src"]] == (["'sha256-"] if views else ["'none'"])


def test_views_in_any_order_give_the_same_page(tmp_path):
    made = content(pictures=blank_pictures(tmp_path))
    names = ("shaft_torque", "flexspline_torque", "wave_generator")
    one, other = (
        page(made, {n: json.dumps(VIEW).encode() for n in order}) for order in (names, names[::-1])
    )
    assert one == other


def policy_of(attributes):
    text = next(v for t, n, v in attributes if t == "meta" and v.startswith("default-src"))
    return {name: values for name, *values in (rule.split() for rule in text.split(";"))}


def test_tables_and_pictures_can_be_heard(tmp_path):
    pictures = blank_pictures(tmp_path)
    _, tags, attributes = read_page(page(content(pictures=pictures)))
    alts = [v for t, n, v in attributes if t == "img" and n == "alt"]
    assert len(alts) == tags.count("img") == len(pictures)
    assert all(len(a) > 10 for a in alts)
    assert tags.count("caption") == 5
    assert {v for t, n, v in attributes if (t, n) == ("th", "scope")} == {"col", "row"}
    assert ("html", "lang", "en") in attributes
    ids = [v for _, n, v in attributes if n == "id"]
    assert len(ids) == len(set(ids))
    for tag, name, value in attributes:
        if tag == "a" and name == "href":
            assert value[1:] in ids


def test_same_content_gives_the_same_bytes(tmp_path):
    made = content(pictures=blank_pictures(tmp_path))
    views = {"flexspline_torque": json.dumps(VIEW).encode()}
    assert page(made, views) == page(made, views)


def test_a_reference_to_nothing_is_a_bug():
    broken = Document("t", "r", "n", "v", (Heading("One"), Paragraph(ref("nowhere"))))
    with pytest.raises(KeyError, match="nowhere"):
        payload_of(broken)
