# SPDX-License-Identifier: GPL-3.0-or-later
"""One recorded file: what it is, and the reaches that are in it."""
from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import ModuleType

KINDS = (".bvh", ".c3d", ".trc", ".amc", ".csv")
_CHUNK = 1 << 20


@dataclass(frozen=True)
class ReadingOptions:
    """What is known about recordings beside what they say themselves; None is found from the file."""

    stature: float | None = None          #: metres, 0.5 to 2.6
    sex: str | None = None                #: "female" or "male"
    age: float | None = None              #: years
    mass: float | None = None             #: kilograms
    map: str | None = None                #: name of a joint map, or a .json file
    metres_per_unit: float | None = None
    up: str | None = None                 #: the file's axis that points up: "y", "-z", ...
    rate: float | None = None             #: frames per second
    facing: str | None = None             #: the file's axis that becomes forward
    skeleton: str | None = None           #: the .asf of .amc files
    object: str | None = None             #: name of the recorded point that is the object
    longest_gap: float = 0.2              #: seconds: shorter gaps are filled
    mirror: bool = True                   #: each motion also as its mirror image
    backwards: bool = False               #: each motion also played backwards, as the opposite phase


@dataclass(frozen=True)
class Recording:
    """What a file gave. `failed`: it could not be read at all; its reason is the only rejection."""

    path: str
    checksum: str                         #: "sha256:..." of its bytes
    bytes: int
    note: str                             #: how it was understood, for people
    settings: str                         #: what else decided the result, as JSON
    reaches: Sequence[object] = ()        #: Reach of reachcast_core
    rejections: Sequence[tuple[str, str]] = field(default=())  #: what was left out, and why
    failed: bool = False


def find_files(paths: Iterable[str | Path]) -> list[Path]:
    """The recordings among files and in folders, below them too, sorted; ValueError names a path that is not there."""
    found: list[Path] = []
    for path in map(Path, paths):
        if path.is_dir():
            found += sorted(file for file in path.rglob("*") if file.is_file() and file.suffix.lower() in KINDS)
        elif path.is_file():
            found.append(path)
        else:
            raise ValueError(f"there is no file or folder '{path}'")
    return list(dict.fromkeys(found))


def checksum_of(path: Path) -> str:
    """"sha256:" and the digest of a file's bytes. OSError when it cannot be read."""
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(_CHUNK):
            digest.update(block)
    return f"sha256:{digest.hexdigest()}"


def settings_of(options: ReadingOptions, labels: Sequence[object]) -> str:
    """What decides the result beside the file, always spelt alike: options, labels, and files that options name."""
    known = {key: value for key, value in asdict(options).items() if value != getattr(ReadingOptions(), key)}
    for key in ("map", "skeleton"):
        named = Path(str(known.get(key, "")))
        if named.is_file():
            known[key] = f"{named.name} {checksum_of(named)}"
    if labels:
        known["labels"] = [repr(label) for label in labels]
    return json.dumps(known, sort_keys=True, ensure_ascii=False)


def read_recording(core: ModuleType, path: Path, options: ReadingOptions, labels: Sequence[object] = ()) -> Recording:
    """Reads a file and cuts it into reaches: at its labels, or where it finds them. OSError when it cannot be opened.

    A file that makes no sense is no error: the recording says so in `failed` and its one rejection.
    """
    checksum = checksum_of(path)
    size, settings = path.stat().st_size, settings_of(options, labels)
    try:
        clip = core.read_motion(str(path), metres_per_unit=options.metres_per_unit, up=options.up, rate=options.rate,
                                facing=options.facing, skeleton=options.skeleton)
        found = _reaches_of(core, clip, options, labels, f"{path.name}#{checksum[7:15]}")
    except ValueError as why:
        return Recording(str(path), checksum, size, "", settings, (), (("the whole file", str(why)),), failed=True)
    reaches = list(found.reaches)
    if options.backwards:
        reaches += [reach.reversed() for reach in found.reaches]
    rejections = [(rejection.what, rejection.reason) for rejection in found.rejections]
    note = " ".join(part for part in (f"{clip.guess}.", clip.note) if part)
    return Recording(str(path), checksum, size, note, settings, reaches, rejections)


def _reaches_of(core: ModuleType, clip: object, options: ReadingOptions, labels: Sequence[object],
                origin: str) -> object:
    filled = core.fill_gaps(clip, options.longest_gap)
    body = core.canonical(filled, options.map)
    subject = _subject_of(core, options, clip.guess.stature)
    if labels:
        return core.cut_labelled(body, labels, subject, recorded=filled, object=options.object, origin=origin)
    if subject is None:
        raise ValueError(f"the stature of the person in '{origin}' is not known and cannot be seen in the recording; "
                         "give it with --stature or in a table of labels")
    return core.find_reaches(body, subject, recorded=filled, object=options.object, origin=origin)


def _subject_of(core: ModuleType, options: ReadingOptions, seen: float) -> object | None:
    stature = options.stature if options.stature is not None else seen
    if math.isnan(stature):
        return None
    return core.Subject(stature, sex=options.sex, age=options.age, mass=options.mass)
