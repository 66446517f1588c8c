# SPDX-License-Identifier: GPL-3.0-or-later
"""A table of tasks, CSV or JSON Lines. A row that cannot be read is kept with its reason; the others are not its victims."""
from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from .tasks import Task, Unit, read_task, units_of


@dataclass(frozen=True)
class BadRow:
    id: str
    reason: str


def read_table(path: Path) -> list[Task | BadRow]:
    """The rows in their order. ValueError when the file is no table at all."""
    if path.suffix.lower() not in {".csv", ".jsonl"}:
        raise ValueError(f"The table '{path}' must end in .csv or .jsonl")
    try:
        rows = list((_csv_rows if path.suffix.lower() == ".csv" else _json_rows)(path))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise ValueError(f"The table '{path}' cannot be read: {error}") from error
    if not rows:
        raise ValueError(f"The table '{path}' has no rows")
    read: list[Task | BadRow] = []
    taken: set[str] = set()
    for number, row in enumerate(rows, 1):
        task = _read(row, number)
        ids = {unit.id for unit in units_of(task)} if isinstance(task, Task) else set()
        if doubles := ids & taken:
            task = BadRow(min(doubles), f"row {number}: the id '{min(doubles)}' is taken by an earlier row")
        taken |= ids
        read.append(task)
    return read


def units_in(rows: list[Task | BadRow]) -> list[Unit | BadRow]:
    """All motions, in the table's order."""
    return [unit for row in rows for unit in (units_of(row) if isinstance(row, Task) else [row])]


def _read(row: object, number: int) -> Task | BadRow:
    try:
        if not isinstance(row, dict):
            raise ValueError(str(row) if isinstance(row, json.JSONDecodeError) else "it is no JSON object")
        return read_task(row, number)
    except (ValueError, TypeError) as error:
        name = row.get("id") if isinstance(row, dict) else None
        return BadRow(str(name or f"row-{number:05d}"), f"row {number}: {error}")


def _csv_rows(path: Path) -> Iterator[dict[str, object]]:
    with path.open(encoding="utf-8-sig", newline="") as file:
        for row in csv.DictReader(file):
            more = row.pop(None, None)
            if more:
                row["more cells than the header has"] = more  # refused as a column that does not exist
            yield row


def _json_rows(path: Path) -> Iterator[object]:
    with path.open(encoding="utf-8") as file:
        for line in file:
            if line.strip():
                try:
                    yield json.loads(line)
                except json.JSONDecodeError as error:
                    yield error
