# SPDX-License-Identifier: GPL-3.0-or-later
"""`index.html` of a batch: the table of results with thumbnails, one page that needs neither network nor server."""
from __future__ import annotations

import csv
import json
import os
from pathlib import Path

TEMPLATE = Path(__file__).with_name("gallery.html")
PAGE = "index.html"


def write_gallery(out: Path) -> Path:
    """Of `out`/results.csv. The same results give the same bytes. ValueError when there are no results."""
    try:
        with (out / "results.csv").open(encoding="utf-8", newline="") as file:
            table = csv.DictReader(file)
            rows = list(table)
            columns = list(table.fieldnames or ())
    except FileNotFoundError as error:
        raise ValueError(f"The folder '{out}' has no results.csv, so there is nothing to show") from error
    page = TEMPLATE.read_text(encoding="utf-8").replace("@DATA@", _in_a_script({"columns": columns, "rows": rows}))
    part = out / f".{PAGE}.{os.getpid()}.part"
    try:
        part.write_text(page, encoding="utf-8")
        os.replace(part, out / PAGE)
    finally:
        part.unlink(missing_ok=True)
    return out / PAGE


def _in_a_script(value: object) -> str:
    """JSON in which nothing ends or begins a tag; ASCII, so that no character is read in another way."""
    return json.dumps(value, separators=(",", ":")).replace("<", "\\u003c").replace(">", "\\u003e")
