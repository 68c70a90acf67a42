"""A part of the bench that is not about what a K costs: its own tables, limits and data."""

from dataclasses import dataclass

from limits import Check

Table = tuple[str, list[str], list[list[str]]]  # title, column heads, rows


@dataclass(frozen=True)
class Extra:
    """One such part."""

    key: str  # in bench.json
    note: str  # Markdown, before its tables
    tables: list[Table]
    checks: list[Check]
    data: dict[str, object]
