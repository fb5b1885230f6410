"""How a measured file was read: the first thing to check before a diagnosis is believed."""

from __future__ import annotations

from dataclasses import dataclass

from flexspline.pipeline.diagnosis.measurement.columns import ReadColumn


@dataclass(frozen=True)
class ReadAs:
    """How a file was understood.

    Attributes
    ----------
    columns : those that are read, in the file's order. ignored : heads of the others. empty : heads of
        columns without any value. heads : of all columns, in the file's order.
    encoding : "UTF-8", "UTF-16", "xlsx" or a code page.
    separator : in words.
    decimal_mark : "." or ",". head_line : of the file. unit_row : whether units stand below the head.
    began : the first row's date and time, "" where time is no date. sha256 : of the file's bytes.
    footer : lines of words below the last row. heads_again : lines that repeat the head, or say data types.
    """

    columns: tuple[ReadColumn, ...] = ()
    ignored: tuple[str, ...] = ()
    empty: tuple[str, ...] = ()
    encoding: str = "UTF-8"
    separator: str = "comma"
    decimal_mark: str = "."
    head_line: int = 1
    unit_row: bool = False
    began: str = ""
    sha256: str = ""
    footer: tuple[int, ...] = ()
    heads_again: tuple[int, ...] = ()
    heads: tuple[str, ...] = ()

    def column(self, quantity: str) -> ReadColumn | None:
        """The first column of a quantity, such as torque; None where no file has one."""
        return next((c for c in self.columns if c.name.startswith(quantity)), None)

    @property
    def as_ours(self) -> bool:
        """Whether the file is written as docs/contract.md, section 3, says: nothing had to be understood."""
        plain = all(
            c.head in (c.name, f"{c.name.partition('_')[0]}_{c.unit}") for c in self.columns
        )
        form = (self.separator, self.decimal_mark, self.unit_row) == ("comma", ".", False)
        return plain and form and not (self.empty or self.footer or self.heads_again)


AS_OURS = ReadAs()
"""Of a record that no file holds."""
