"""Checks of a study beyond its schema: keys of the design, ranges, figures, and needs of the methods."""

from __future__ import annotations

from flexspline.geometry.errors import MISSING
from flexspline.geometry.keys import has_table_of, leaves, location_of, value_at
from flexspline.geometry.near_key import nearest_key
from flexspline.geometry.ranges import is_number
from flexspline.geometry.schema import allowed, dotted, node_at
from flexspline.pipeline.backlash import STD_KEY
from flexspline.pipeline.study.figures import FIGURES, not_a_figure
from flexspline.pipeline.study.schema import WORDS, Spread, VariedSpan
from flexspline.pipeline.study.study import Study, StudyError

SMALLEST_SPREAD = 1e-6
"""Of the value: no gauge tells a part in a million, and differences of K drown in rounding."""


def check(study: Study) -> None:
    """Raise StudyError where the study is impossible."""
    file, method = study.file, study.file.run.method
    for key, span in file.vary.items():
        _check_design_key(study, "vary", key)
        _check_span(study, key, span)
    for key, link in file.link.items():
        _check_design_key(study, "link", key)
        if link.of not in {**file.vary, **file.tolerance}:
            raise StudyError(f'link."{key}".of', link.of, "must be a key of [vary] or [tolerance]")
        if key in file.vary:
            raise StudyError(f'link."{key}"', link.of, "the same key stands in [vary]; keep one")
    for key, spread in file.tolerance.items():
        _check_design_key(study, "tolerance", key)
        if (spread.plus_minus is None) == (spread.std is None):
            raise StudyError(f'tolerance."{key}"', {}, f"must be {WORDS['tolerance.*']}")
        _check_spread(study, key, spread)
    for table in ("objective", "constraint"):
        for key in getattr(file, table):
            if key not in FIGURES:
                value = getattr(file, table)[key] if table == "objective" else {}
                raise StudyError(f'{table}."{key}"', value, not_a_figure(key))
            if key == STD_KEY and not _always_stated(study):
                reason = "needs a standard deviation above 0 in the design's [uncertainty]"
                raise StudyError(f'{table}."{key}"', {}, reason)
    for key, limit in file.constraint.items():
        low, high = limit.min, limit.max
        if low is None and high is None:
            raise StudyError(f'constraint."{key}"', {}, f"must be {WORDS['constraint.*']}")
        if low is not None and high is not None and low > high:
            raise StudyError(f'constraint."{key}".min', low, f"must be at most max = {high:g}")
    if method == "tolerance":
        if file.vary:
            key = next(iter(file.vary))
            raise StudyError(
                f'vary."{key}"', {}, 'method "tolerance" takes [tolerance] instead of [vary]'
            )
    elif not file.vary:
        raise StudyError("vary", MISSING, "give at least one design key to vary")
    elif file.tolerance:
        key = next(iter(file.tolerance))
        raise StudyError(f'tolerance."{key}"', {}, 'needs method = "tolerance"')
    if file.run.verify and not file.objective:
        reason = "must be 0 without an [objective], which says what is best"
        raise StudyError("run.verify", file.run.verify, reason)
    if method == "optimize" and not file.objective:
        raise StudyError("objective", MISSING, 'method "optimize" needs at least one figure')


def _always_stated(study: Study) -> bool:
    """Whether some source of doubt is above 0 in every design of the study."""
    file = study.file
    for key, std in study.design.uncertainty:
        name = f"uncertainty.{key}"
        least = file.vary[name].ends[0] if name in file.vary else std
        if name not in file.link and least > 0:
            return True
    return False


def _check_design_key(study: Study, table: str, key: str) -> None:
    kind = study.design.flexspline.kind
    location = location_of(key)
    node = node_at(location, kind)
    # one spelling: a key is looked for in [vary], [link] and [tolerance]
    holds_number = dotted(location) == key and node.get("type") in ("number", "integer")
    if holds_number and has_table_of(study.design, key):
        if table != "tolerance" or value_at(study.design, key) is not None:
            return
        reason = "has no value in the design file that could scatter; state it there"
        raise StudyError(f'tolerance."{key}"', {}, reason)
    known = [name for name, value in leaves("", study.design.tables) if is_number(value)]
    near = nearest_key(key, known)
    reason = f"did you mean {near}?" if near and near != key else f"e.g. {known[0]}"
    raise StudyError(f'{table}."{key}"', {}, f"is not a number in the design file; {reason}")


def _check_spread(study: Study, key: str, spread: Spread) -> None:
    """Neither lost in rounding beside the value, nor beyond all that the key may hold."""
    name, amount = (
        ("std", spread.std) if spread.plus_minus is None else ("plus_minus", spread.plus_minus)
    )
    lowest, most = study.range_of(key)
    size = max(abs(value_at(study.design, key) or 0.0), lowest)
    least = SMALLEST_SPREAD * size or SMALLEST_SPREAD
    if amount is None or not least <= amount <= most:
        reason = f"must be a number from {least:g} to {most:g}"
        raise StudyError(f'tolerance."{key}".{name}', amount, reason)


def _check_span(study: Study, key: str, span: VariedSpan) -> None:
    name = f'vary."{key}"'
    listed = span.values is not None
    if listed and (span.min, span.max, span.steps) != (None, None, None):
        raise StudyError(name, span.model_dump(exclude_none=True), f"must be {WORDS['vary.*']}")
    if not listed and (span.min is None or span.max is None):
        missing = "min" if span.min is None else "max"
        raise StudyError(f"{name}.{missing}", MISSING, f"give {WORDS['vary.*']}")
    low, high = span.ends
    if not listed and low >= high:
        raise StudyError(f"{name}.min", low, f"must be below max = {high:g}")
    least, most = study.range_of(key)
    for value in span.values or span.ends:
        if key in study.whole and value != int(value):
            raise StudyError(name, value, "must hold whole numbers")
        if not least <= value <= most:
            words = allowed(location_of(key), study.design.flexspline.kind)
            raise StudyError(name, value, f"must be {words}")
