# SPDX-License-Identifier: GPL-3.0-or-later
"""What a corpus holds, in words. Metres and seconds in the body frame: x right, y ahead, z up, from between the feet."""
from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

_COLUMNS = f"{'id':>7} {'phase':9} {'person':>22} {'s':>5}  {'from':20} {'to':20} origin"


def motion_lines(corpus: object, phase: str | None = None, source: int | None = None) -> Iterator[str]:
    """A heading, then one line per motion. ValueError for an unknown source."""
    only = None if source is None else set(ids_of_source(corpus, source))
    yield _COLUMNS
    for motion in corpus.motions():
        if (phase is None or motion.phase == phase) and (only is None or motion.id in only):
            yield (f"{motion.id:7d} {motion.phase:9} {person_text(motion.subject):>22} {motion.duration:5.2f}  "
                   f"{_point(motion.home):20} {_point(motion.target):20} {motion.origin}"
                   f"{' (mirror image)' if motion.mirrored else ''}")


def corpus_lines(corpus: object) -> list[str]:
    """Metadata, then each file with what came of it."""
    lines = [f"{corpus.path}: {len(corpus)} motions"]
    lines += [f"  {key}: {value}" for key, value in sorted(corpus.meta.items()) if value]
    for source in corpus.sources():
        lines.append(f"file {source.id}: {source.path}, {source.bytes} bytes, {source.checksum}, read by {source.tool}")
        lines += [f"  {text}" for text in (source.note, source.settings if source.settings != "{}" else "") if text]
        lines.append(f"  {source.motions} motions, {len(source.rejections)} rejected")
        lines += [f"  rejected {what}: {reason}" for what, reason in source.rejections]
    return lines


def motion_details(corpus: object, motion_id: int) -> list[str]:
    """All about one motion. ValueError for an unknown id."""
    (motion,) = chosen_motions(corpus, [motion_id])
    source = next((source for source in corpus.sources() if motion_id in corpus.motions_of(source.id)), None)
    rows = {
        "origin": motion.origin + (" (mirror image)" if motion.mirrored else ""),
        "file": f"{source.id}: {source.path}, {source.checksum}" if source else "none",
        "phase": motion.phase, "person": person_text(motion.subject), "duration": f"{motion.duration:.3f} s",
        "from": f"({_point(motion.home)}) m", "to": f"({_point(motion.target)}) m",
        "hands": f"both, {motion.grip_distance:.3f} m apart" if motion.hands == "both" else f"{motion.hands} alone",
    }
    return [f"motion {motion.id}"] + [f"  {name}: {value}" for name, value in rows.items()]


def statistics_lines(corpus: object) -> list[str]:
    """Counts and ranges by phase, and of the people."""
    motions = corpus.motions()
    sources = corpus.sources()
    rejected = sum(len(source.rejections) for source in sources)
    lines = [f"{len(motions)} motions ({sum(motion.mirrored for motion in motions)} of them mirror images), "
             f"{len({motion.subject_id for motion in motions})} people, {len(sources)} files, {rejected} rejected"]
    if not motions:
        return lines
    lines.append(f"stature {_range(motion.subject.stature for motion in motions)} m")
    sexes = Counter(motion.subject.sex or "not known" for motion in motions)
    lines.append("sex " + ", ".join(f"{sex}: {count}" for sex, count in sorted(sexes.items())))
    for phase in sorted({motion.phase for motion in motions}):
        of_phase = [motion for motion in motions if motion.phase == phase]
        places = "; ".join(f"{axis} {_range(motion.target[i] for motion in of_phase)}" for i, axis in enumerate("xyz"))
        lines.append(f"{phase}: {len(of_phase)}, {_range(motion.duration for motion in of_phase)} s, to {places} m")
    return lines


def chosen_motions(corpus: object, ids: Sequence[int]) -> list[object]:
    """The motions with these ids, all without any. ValueError names an id that there is not."""
    known = {motion.id: motion for motion in corpus.motions()}
    if unknown := [motion_id for motion_id in ids if motion_id not in known]:
        raise ValueError(f"the corpus {corpus.path} has no motion {unknown[0]}")
    return [known[motion_id] for motion_id in ids] if ids else list(known.values())


def ids_of_source(corpus: object, source: int) -> list[int]:
    """Ids of the motions of a file. ValueError for an unknown one."""
    if all(source != known.id for known in corpus.sources()):
        raise ValueError(f"the corpus {corpus.path} has no file {source}")
    return corpus.motions_of(source)


def person_text(subject: object) -> str:
    """"female 34 y 1.68 m 61 kg", as far as it is known."""
    parts = [subject.sex, f"{subject.age:.0f} y" if subject.age is not None else None, f"{subject.stature:.2f} m",
             f"{subject.mass:.0f} kg" if subject.mass is not None else None]
    return " ".join(part for part in parts if part)


def _point(point: Sequence[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in point)


def _range(values: Iterable[float]) -> str:
    known = list(values)
    return f"{min(known):.2f} to {max(known):.2f}"
