"""Distribution of a study's designs among processes, updated from the changes in the database.

To claim a design costs as much in a study of 100,000 designs as in one of 100.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field

from flexspline.pipeline.study.evaluate import Outcome, outcome_of
from flexspline.pipeline.study.trial_tables import StoredTrial, Values

CLAIM, ROW = "claim", "row"


@dataclass(frozen=True)
class Claim:
    """A claim: which design, which attempt at it, by which process."""

    slot: int
    attempt: int
    owner: str


@dataclass(frozen=True)
class Row:
    """One finished design: values of the varied keys and what came out."""

    slot: int
    values: Values
    outcome: Outcome


@dataclass(frozen=True)
class Try:
    """A trial without a row: a design claimed. `outcome` is there where its process died between
    storing it and closing the trial."""

    trial_id: int
    number: int
    claim: Claim
    values: Values
    finished: bool
    outcome: Outcome | None = None

    @property
    def slot(self) -> int:
        """Which design."""
        return self.claim.slot


@dataclass
class Claims:
    """The trials of a study, as far as one process knows them.

    Attributes
    ----------
    tries : by slot and then trial, of the slots that have no row.
    held : trials that this process works at: nobody else closes them, so they need not be read again.
    last_id, last_number : of the newest trial that was read; -1 before the first.
    """

    tries: dict[int, dict[int, Try]] = field(default_factory=dict)
    held: set[int] = field(default_factory=set)
    last_id: int = -1
    last_number: int = -1
    _rows: dict[int, tuple[int, Row]] = field(default_factory=dict)
    """With their trials' numbers."""
    _fresh: int = 0
    """No slot below was never claimed."""

    def rows(self) -> list[Row]:
        """Finished designs by slot; should a slot have two, the first."""
        return [self._rows[slot][1] for slot in sorted(self._rows)]

    @property
    def finished(self) -> int:
        """Number of designs that have a row."""
        return len(self._rows)

    def open(self) -> Iterator[Try]:
        """Tries of any process that are not closed."""
        return (t for tries in self.tries.values() for t in tries.values() if not t.finished)

    def to_read_again(self) -> list[int]:
        """Trials that another process may have closed since."""
        return [t.trial_id for t in self.open() if t.trial_id not in self.held]

    def take_in(self, trials: Iterable[StoredTrial]) -> None:
        """Take in the database's new trials, and those read again."""
        for trial in trials:
            self.last_id = max(self.last_id, trial.trial_id)
            self.last_number = max(self.last_number, trial.number)
            if CLAIM not in trial.attributes:
                continue
            claim = Claim(**trial.attributes[CLAIM])
            row = trial.attributes.get(ROW)
            outcome = outcome_of(row) if row else None
            if outcome and trial.finished:
                self.add_row(trial.number, Row(claim.slot, trial.values, outcome))
            else:
                self.add_try(
                    Try(trial.trial_id, trial.number, claim, trial.values, trial.finished, outcome)
                )

    def add_try(self, one: Try) -> None:
        if one.slot not in self._rows:
            self.tries.setdefault(one.slot, {})[one.trial_id] = one

    def add_row(self, number: int, row: Row) -> None:
        known = self._rows.get(row.slot)
        if known is None or number < known[0]:
            self._rows[row.slot] = number, row
        self.tries.pop(row.slot, None)

    def free(self, size: int, dead: Collection[str]) -> Iterator[int]:
        """Return slots below `size` without a row and with nobody alive at them; `dead`: ended owners.

        First those that were claimed before, then new ones.
        """
        for slot in sorted(self.tries):
            tries = self.tries[slot].values()
            if slot < size and all(t.finished or t.claim.owner in dead for t in tries):
                yield slot
        while self._fresh in self.tries or self._fresh in self._rows:
            self._fresh += 1
        yield from (
            s for s in range(self._fresh, size) if s not in self.tries and s not in self._rows
        )
