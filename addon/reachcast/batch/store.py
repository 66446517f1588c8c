# SPDX-License-Identifier: GPL-3.0-or-later
"""Where results lie: `tasks/ID/`, which appears by one rename when all of it is written, and the table made of them."""
from __future__ import annotations

import csv
import errno
import json
import os
import shutil
import socket
from collections.abc import Iterable
from pathlib import Path

from .table import BadRow
from .tasks import Unit

RESULT = "result.json"
COLUMNS = ("id", "status", "reason", "landing_error_mm", "grip_error_mm", "foot_slip_mm", "duration_s", "durations",
           "outside_data", "neighbours", "corrections", "files")
LEAST_ROOM = 256 * 1024  #: bytes; with less than this left, what Blender wrote may have been cut short unnoticed
ROOM_TO_FAIL = 4 * 1024 * 1024  #: bytes; what fails with less left is put down to the disk: Blender does not say why


class DiskFull(Exception):
    """One sentence; the whole run stops."""


class Store:
    """The results in a folder. Several processes may use one; each works in a draft folder of its own."""

    def __init__(self, out: Path) -> None:
        self.out, self.tasks = out, out / "tasks"
        self.drafts = out / "drafts"
        self.own = self.drafts / f"{socket.gethostname()}-{os.getpid()}"
        try:
            self.tasks.mkdir(parents=True, exist_ok=True)
            self.drafts.mkdir(exist_ok=True)
            self.drop_orphans()
            self.own.mkdir(exist_ok=True)
        except OSError as error:
            self.refuse_full(error)
            raise ValueError(f"The folder '{out}' cannot be written to: {error.strerror}") from error

    def close(self) -> None:
        shutil.rmtree(self.own, ignore_errors=True)
        try:
            self.drafts.rmdir()
        except OSError:
            pass  # another process works there

    def drop_orphans(self) -> None:
        """Drafts of processes of this machine that are no more."""
        for folder in self.drafts.iterdir():
            host, _, process = folder.name.rpartition("-")
            if host == socket.gethostname() and not Path(f"/proc/{process}").exists():
                shutil.rmtree(folder, ignore_errors=True)

    def result(self, unit: Unit) -> dict[str, object] | None:
        """What is finished under this unit's id, whatever it was made of."""
        try:
            return json.loads((self.tasks / unit.id / RESULT).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None

    def is_done(self, unit: Unit, checksum: str) -> bool:
        """Whether it was finished as it is asked for now; what went wrong unexpectedly is to be tried again."""
        result = self.result(unit)
        return result is not None and result.get("checksum") == checksum and result.get("status") in ("done", "refused")

    def draft(self, unit: Unit) -> Path:
        """An empty folder to work in."""
        folder = self.own / unit.id
        try:
            folder.mkdir()
        except FileExistsError:
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
        return folder

    def finish(self, unit: Unit, draft: Path, result: dict[str, object]) -> None:
        """The draft becomes the unit's folder. Until the last rename nothing of it is seen."""
        (draft / RESULT).write_text(json.dumps(result) + "\n", encoding="utf-8")
        self.refuse_full()
        final, old = self.tasks / unit.id, self.own / f"{unit.id}.old"
        while True:
            try:
                os.rename(draft, final)
                return
            except OSError as error:
                if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                    raise
            try:
                os.rename(final, old)
            except FileNotFoundError:
                pass  # another process, whose run was killed, is finishing the same unit
            shutil.rmtree(old, ignore_errors=True)

    def refuse_full(self, error: Exception | None = None) -> None:
        """DiskFull when `error` says so or next to nothing is left; after a failure, a little more may be."""
        try:
            free = shutil.disk_usage(self.out).free
        except FileNotFoundError:
            free = shutil.disk_usage(self.out.parent).free
        says_so = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
        if says_so or free < (ROOM_TO_FAIL if error else LEAST_ROOM):
            raise DiskFull(f"The disk of '{self.out}' is full ({free // 1024} KiB left); what was finished is kept: "
                           f"make room and start again")

    def rows(self, units: Iterable[Unit | BadRow], world: str) -> list[dict[str, object]]:
        """Of `results.csv`, in the order of `units`. world: what besides its row a motion depends on."""
        return [self._row(unit, world) for unit in units]

    def write_results(self, rows: Iterable[dict[str, object]], name: str = "results.csv") -> None:
        part = self.own / name
        with part.open("w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, COLUMNS, restval="", extrasaction="ignore", lineterminator="\n")
            table.writeheader()
            table.writerows(rows)
        os.replace(part, self.out / name)

    def _row(self, unit: Unit | BadRow, world: str) -> dict[str, object]:
        if isinstance(unit, BadRow):
            return {"id": unit.id, "status": "bad row", "reason": unit.reason}
        result = self.result(unit)
        if result is None:
            return {"id": unit.id, "status": "missing", "reason": "it has not been worked on"}
        if result.get("checksum") != unit.checksum(world):
            return {"id": unit.id, "status": "missing", "reason": "what is there is of another row, scene or corpus"}
        return {"id": unit.id, **result}
