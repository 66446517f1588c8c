# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings into a corpus, one file and one transaction at a time."""
from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

from .recordings import ReadingOptions, checksum_of, read_recording, settings_of


@dataclass(frozen=True)
class FileReport:
    """What became of one file."""

    path: str
    state: str                                    #: "imported", "known" (nothing changed) or "failed"
    motions: int = 0                              #: in the corpus from this file, mirror images included
    phases: tuple[str, ...] = ()                  #: of the reaches found, in order
    note: str = ""
    rejections: tuple[tuple[str, str], ...] = ()  #: what was left out, and why

    def __str__(self) -> str:
        if self.state == "known":
            return f"{self.path}: in the corpus already"
        counts = ", ".join(f"{self.phases.count(name)} {name}" for name in dict.fromkeys(self.phases))
        head = f"{self.path}: {counts or 'nothing'} kept ({self.motions} motions), {len(self.rejections)} rejected"
        return "\n".join([head] + [f"    {self.note}"] * bool(self.note)
                         + [f"    rejected {what}: {reason}" for what, reason in self.rejections])


def open_or_create(core: ModuleType, path: str | Path, compact: bool = False, kind: str = "recorded") -> object:
    """The corpus at `path`, opened for writing; made there when there is none, as a whole or not at all."""
    path = Path(path)
    if not path.exists():
        draft = path.with_name(f"{path.name}.{os.getpid()}.new")
        draft.unlink(missing_ok=True)  # of a process of the same number that was killed
        try:
            with core.Corpus.create(str(draft), precision="compact" if compact else "exact") as corpus:
                corpus.set_meta("kind", kind)
        except (ValueError, RuntimeError) as why:
            raise type(why)(str(why).replace(str(draft), str(path))) from None
        os.replace(draft, path)
    return core.Corpus.open_for_writing(str(path))


def labels_by_file(core: ModuleType, table: str | Path | None) -> dict[str, list[object]]:
    """The rows of a table of labels by the name of the file that they speak of."""
    rows: dict[str, list[object]] = {}
    for label in core.read_labels(str(table)) if table else ():
        rows.setdefault(Path(label.file).name, []).append(label)
    return rows


def import_files(core: ModuleType, corpus: object, files: Sequence[Path], options: ReadingOptions,
                 labels: dict[str, list[object]] | None = None) -> Iterator[FileReport]:
    """Imports one file per step. Stop at any step: what was reported is stored, nothing else is.

    A file that is stored already, with the same options and labels, changes nothing. ValueError at the first step when
    labels name a file that is not among `files`.
    """
    labels = labels or {}
    if unknown := sorted(set(labels) - {file.name for file in files}):
        raise ValueError(f"the labels speak of '{unknown[0]}', which is not among the files to import")
    for file in files:
        yield import_file(core, corpus, file, options, labels.get(file.name, ()))


def import_file(core: ModuleType, corpus: object, file: Path, options: ReadingOptions,
                labels: Sequence[object] = ()) -> FileReport:
    """One file, all of it or nothing. RuntimeError of the core when the corpus cannot be written."""
    try:
        if corpus.has_source(checksum_of(file), settings_of(options, labels)):
            return FileReport(str(file), "known")
        recording = read_recording(core, file, options, labels)
    except OSError as why:
        return FileReport(str(file), "failed", rejections=(("the whole file", f"it cannot be read: {why.strerror}"),))
    stored = corpus.add_source(recording.path, recording.checksum, recording.bytes, list(recording.reaches),
                               list(recording.rejections), note=recording.note, settings=recording.settings,
                               mirror=options.mirror)
    if stored is None:
        return FileReport(str(file), "known")
    return FileReport(recording.path, "failed" if recording.failed else "imported", stored.motions,
                      tuple(reach.phase for reach in recording.reaches), recording.note, tuple(recording.rejections))
