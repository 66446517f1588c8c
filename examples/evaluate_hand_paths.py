#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How well hand paths are fitted and predicted: the tables of Faraway, Reed and Wang (2007) on recorded reaches.

    /usr/bin/python3 examples/evaluate_hand_paths.py --mocap ../shared/mocap --out out/hand_paths

Reads every participant of roag_wall_reaching/ in the folder (or of the folder itself), prints the tables and writes
them to tables.md in the output folder, with the figures as PNG. An error is the largest distance between the observed
and the modelled path at equal relative arc length; tables give the median over reaches, in centimetres. Whatever is
predicted is learned without the participant it is compared with.
"""

import argparse
import sys
from pathlib import Path

from hand_path_tables import CHOSEN, fit_model, markdown, path_error, predict, tables
from replicated_lifts import wrist_paths
from wall_reaches import np, rc, read_reaches

# ---------------------------------------------------------------- figures


def median_reach(reaches, target):
    """Of the reaches to a target the one of median cubic error: neither the best nor the worst fit."""
    asked = sorted((r for r in reaches if r.target == target), key=lambda r: path_error(r, rc.fit_bezier(r.points)))
    return asked[len(asked) // 2]


def draw_figures(folder, reaches):
    # The library of figures is asked for here only: without it the tables are still there.
    try:
        import hand_path_figures as figures
    except ImportError as missing:
        sys.exit(f"{missing}: the tables are written, but the figures need Debian's python3-matplotlib")

    _, options, posture = CHOSEN
    target = max(reaches, key=lambda reach: np.linalg.norm(reach.end - reach.start)).target
    others = [reach for reach in reaches if reach.participant != reaches[0].participant]
    model, all_model = (
        fit_model(some, {**options, "people": [reach.participant for reach in some]}, posture)
        for some in (others, reaches)
    )
    shown = median_reach([r for r in reaches if r.participant == reaches[0].participant], target)

    def sample(reach, seed):
        return all_model.sample(reach.start, reach.end, seed, covariates={"posture": reach.posture}).control

    def band(of_one_reach):
        given = {"covariates": {"posture": shown.posture}, "of_one_reach": of_one_reach}
        return model.band(shown.start, shown.end, figures.SAMPLES, **given)

    yield figures.paths_of_one_person(folder, reaches)
    yield figures.paths_to_one_target(folder, reaches, target)
    yield figures.cubic_fit(folder, median_reach(reaches, target))
    yield figures.rose_diagrams(folder, reaches)
    yield figures.predicted_and_observed(folder, reaches, model, lambda m, reach: predict(m, reach, posture))
    yield figures.simulated_and_observed(folder, reaches, target, sample)
    bands = [(0.2, "one reach", band(True)), (0.35, "mean path", band(False))]
    yield figures.confidence_band(folder, shown, bands)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--mocap", type=Path, required=True, metavar="DIR", help="folder of the recordings")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="folder for tables.md and the figures")
    arguments = parser.parse_args()
    try:
        reaches = read_reaches(arguments.mocap)
    except (FileNotFoundError, ValueError) as error:
        sys.exit(str(error))
    people = sorted({reach.participant for reach in reaches})
    if len(people) < 3:
        sys.exit(f"{arguments.mocap} holds reaches of {len(people)} participants, expected at least 3")
    text = f"{len(reaches)} reaches of {len(people)} participants: {', '.join(people)}\n"
    print(text)
    for title, rows in tables(reaches, wrist_paths(arguments.mocap)):
        part = f"\n{title}\n\n{markdown(rows)}"
        print(part, flush=True)
        text += part
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "tables.md").write_text(text, encoding="utf-8")
    for path in draw_figures(arguments.out, reaches):
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
