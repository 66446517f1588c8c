# SPDX-License-Identifier: GPL-3.0-or-later
"""The command: python3 -m reachcast_corpus import | list | show | check | merge | export | forget | stats."""
from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType

from . import exporting, importing, listing, merging
from .recordings import ReadingOptions, find_files

_OPTIONS = ReadingOptions()


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns 0, 1 where something could not be done, 2 for a wrong command line."""
    options = _parser().parse_args(arguments)
    try:
        import reachcast_core as core
    except ImportError as missing:
        print(f"{missing}. Build reachcast_core, set PYTHONPATH to the folder it lies in, and run this with the Python "
              f"that it was built for; this is {sys.executable}.", file=sys.stderr)
        return 1
    try:
        return options.run(core, options)
    except BrokenPipeError:  # whoever read the output wants no more of it
        sys.stdout = None
        return 1
    except (ValueError, RuntimeError, OSError) as why:
        print(f"reachcast_corpus {options.command}: {why}", file=sys.stderr)
        return 1


def _import(core: ModuleType, options: argparse.Namespace) -> int:
    files = find_files(options.files)
    if not files:
        raise ValueError("there is no recording among the files given; known kinds are .bvh, .c3d, .trc, .amc and .csv")
    labels = importing.labels_by_file(core, options.labels)
    reading = ReadingOptions(**{name: getattr(options, name) for name in vars(_OPTIONS)})
    totals = {"imported": 0, "known": 0, "failed": 0}
    kept = rejected = 0
    with importing.open_or_create(core, options.corpus, options.compact, options.kind) as corpus:
        for report in importing.import_files(core, corpus, files, reading, labels):
            print(report, flush=True)
            totals[report.state] += 1
            kept, rejected = kept + report.motions, rejected + len(report.rejections)
        print(f"{options.corpus}: {totals['imported']} files imported, {totals['known']} there already, "
              f"{totals['failed']} unreadable; {kept} motions added, {rejected} rejected, {len(corpus)} in all")
    return 1 if totals["failed"] == len(files) else 0


def _list(core: ModuleType, options: argparse.Namespace) -> int:
    with core.Corpus.open(options.corpus) as corpus:
        sys.stdout.writelines(f"{line}\n" for line in listing.motion_lines(corpus, options.phase, options.source))
    return 0


def _show(core: ModuleType, options: argparse.Namespace) -> int:
    with core.Corpus.open(options.corpus) as corpus:
        print("\n".join(listing.corpus_lines(corpus) if options.id is None
                        else listing.motion_details(corpus, options.id)))
    return 0


def _check(core: ModuleType, options: argparse.Namespace) -> int:
    with core.Corpus.open(options.corpus) as corpus:
        problems = corpus.check()
        print("\n".join(problems) or f"{options.corpus}: {len(corpus)} motions, nothing is wrong")
    return 1 if problems else 0


def _merge(core: ModuleType, options: argparse.Namespace) -> int:
    with importing.open_or_create(core, options.corpus, options.compact, options.kind) as corpus:
        for other in options.others:
            added = sum(count for _, count in merging.merge_into(core, corpus, other))
            print(f"{other}: {added} motions added", flush=True)
        print(f"{options.corpus}: {len(corpus)} motions")
    return 0


def _export(core: ModuleType, options: argparse.Namespace) -> int:
    options.out.mkdir(parents=True, exist_ok=True)
    failed = 0
    with core.Corpus.open(options.corpus) as corpus:
        for motion in listing.chosen_motions(corpus, options.ids):
            try:
                print(exporting.export_motion(core, corpus, motion, options.out, options.format, options.rate))
            except ValueError as why:
                print(why, file=sys.stderr)
                failed += 1
    return 1 if failed else 0


def _forget(core: ModuleType, options: argparse.Namespace) -> int:
    with core.Corpus.open_for_writing(options.corpus) as corpus:
        ids = list(options.ids)
        for source in options.source or ():
            ids += listing.ids_of_source(corpus, source)
        listing.chosen_motions(corpus, options.ids)
        print(f"{options.corpus}: {corpus.remove(ids)} motions forgotten, {len(corpus)} left")
    return 0


def _stats(core: ModuleType, options: argparse.Namespace) -> int:
    with core.Corpus.open(options.corpus) as corpus:
        print("\n".join(listing.statistics_lines(corpus)))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="reachcast_corpus", description="Recorded motions, kept in one file.")
    commands = parser.add_subparsers(dest="command", required=True)

    def command(name: str, run: Callable[[ModuleType, argparse.Namespace], int], text: str) -> argparse.ArgumentParser:
        added = commands.add_parser(name, help=text, description=text)
        added.set_defaults(run=run)
        added.add_argument("corpus", metavar="CORPUS", help="the corpus file")
        return added

    def writes(added: argparse.ArgumentParser) -> None:
        added.add_argument("--compact", action="store_true", help="a new corpus takes a fifth of the bytes")
        added.add_argument("--kind", default="recorded", help="what a new corpus says of itself (%(default)s)")

    added = command("import", _import, "Cuts reaches out of recordings; what is left out is listed with its reason. "
                    "Files that cannot be read are listed, too; only where none can the command fails.")
    added.add_argument("files", metavar="FILE", nargs="+", help=".bvh, .c3d, .trc, .amc or .csv, or folders of them")
    added.add_argument("--labels", metavar="TABLE", help="CSV table of phases; without it they are found")
    writes(added)
    _add_reading_options(added)
    added = command("list", _list, "One line per motion.")
    added.add_argument("--phase", choices=("reach", "transfer", "return", "retrieve"))
    added.add_argument("--source", type=int, metavar="ID", help="only motions of this file (see show)")
    added = command("show", _show, "The files of a corpus and what was left out of them; or all about one motion.")
    added.add_argument("id", nargs="?", type=int, metavar="MOTION")
    command("check", _check, "Reads everything and says what is wrong.")
    added = command("merge", _merge, "Adds what other corpora hold; what is there already stays as it is.")
    added.add_argument("others", metavar="OTHER", nargs="+")
    writes(added)
    added = command("export", _export, "Writes motions as files, on a body of published proportions.")
    added.add_argument("ids", metavar="MOTION", nargs="*", type=int, help="ids; all without any")
    added.add_argument("--out", type=Path, required=True, help="the folder to write to")
    added.add_argument("--format", choices=exporting.FORMATS, default="bvh", help="(%(default)s)")
    added.add_argument("--rate", type=float, default=60.0, help="frames per second (%(default)s)")
    added = command("forget", _forget, "Takes motions out of a corpus.")
    added.add_argument("ids", metavar="MOTION", nargs="*", type=int)
    added.add_argument("--source", type=int, action="append", metavar="ID", help="all motions of this file (see show)")
    command("stats", _stats, "Counts and ranges.")
    return parser


def _add_reading_options(parser: argparse.ArgumentParser) -> None:
    text = "what is not given is taken from the file or seen in the data"
    group = parser.add_argument_group("about the recordings", text)
    group.add_argument("--stature", type=float, metavar="METRES")
    group.add_argument("--sex", choices=("female", "male"))
    group.add_argument("--age", type=float, metavar="YEARS")
    group.add_argument("--mass", type=float, metavar="KG")
    group.add_argument("--map", help="joint map: a preset's name or a .json file")
    group.add_argument("--metres-per-unit", type=float, metavar="METRES", help="0.01 for centimetres")
    group.add_argument("--up", metavar="AXIS", help="the file's axis that points up, such as y or -z")
    group.add_argument("--rate", type=float, metavar="HZ")
    group.add_argument("--facing", metavar="AXIS", help="the file's axis that the person faces")
    group.add_argument("--skeleton", metavar="ASF", help="skeleton of .amc files; else looked for beside them")
    group.add_argument("--object", metavar="POINT", help="the recorded point that is the object carried")
    group.add_argument("--longest-gap", type=float, metavar="SECONDS", default=_OPTIONS.longest_gap,
                       help="shorter gaps are filled (%(default)s)")
    group.add_argument("--no-mirror", dest="mirror", action="store_false", help="add no mirror images")
    group.add_argument("--backwards", action="store_true", help="add each motion also played backwards")
