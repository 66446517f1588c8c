#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How well hand paths are fitted and predicted: the tables of Faraway, Reed and Wang (2007) on recorded reaches.

    /usr/bin/python3 examples/evaluate_hand_paths.py --mocap ../shared/mocap --out out/hand_paths

Reads every participant of roag_wall_reaching/ in the folder (or of the folder itself), prints the tables and writes them
to tables.md in the output folder, with the figures as PNG. An error is the largest distance between the observed and
the modelled path at equal relative arc length; tables give the median over reaches, in centimetres. Whatever is
predicted is learned without the participant it is compared with.
"""

import argparse
import sys
from pathlib import Path

from wall_reaches import np, rc, read_reaches

PAPER_TABLE_1 = {1: 10.5, 2: 3.6, 3: 1.7, 4: 1.0}
DEGREE_NAMES = {1: "straight line", 2: "quadratic", 3: "cubic", 4: "quartic"}
THIRDS = (0, 0, 0, 1, 1, 2, 2)  # of the wall's seven rows or columns
FAR_M = (1.0, 3.0, 10.0)  # distances of targets that nobody reached for
SMOOTH = {"trend": "smooth", "displacement": True}

# Candidates of the covariate model: name, keyword arguments of the fit, and whether the posture is a covariate.
CANDIDATES = (
    ("mean, scaled by distance", {}, False),
    ("linear in the displacement", {"trend": "linear", "displacement": True}, False),
    ("linear, and in the posture", {"trend": "linear", "displacement": True}, True),
    ("quadratic in the displacement", {"trend": "quadratic", "displacement": True}, False),
    ("quadratic, and in the posture", {"trend": "quadratic", "displacement": True}, True),
    ("smooth in the displacement", SMOOTH, False),
    ("smooth, and in the posture", SMOOTH, True),
)
CHOSEN = CANDIDATES[-1]

# What is left out besides the participant.
LEFT_OUT = {
    "-": lambda reach: None,
    "target": lambda reach: reach.target,
    "row": lambda reach: reach.row,
    "column": lambda reach: reach.column,
    "block": lambda reach: (THIRDS[reach.row], THIRDS[reach.column]),
    "quarter": lambda reach: (reach.row > 3, reach.column > 3),
}


def median_cm(errors):
    return 100 * float(np.median(errors))


def path_error(reach, control):
    return rc.bezier_error(reach.points, control)


def relative_times(reach):
    return np.linspace(0.0, 1.0, len(reach.points))


def fit_model(reaches, options, posture=False, **covariates):
    """The model of some reaches; covariates are named functions of a reach."""
    options = dict(options)
    if options.get("scaling") == "distance_time":
        options["durations"] = [reach.duration for reach in reaches]
    values = {name: [of(reach) for reach in reaches] for name, of in covariates.items()}
    if posture:
        values["posture"] = np.array([reach.posture for reach in reaches])
    return rc.HandPathModel.fit([reach.points for reach in reaches], covariates=values, **options)


def predict(model, reach, posture=False, **covariates):
    values = {name: of(reach) for name, of in covariates.items()}
    if posture:
        values["posture"] = reach.posture
    return model.predict(reach.start, reach.end, duration=reach.duration, covariates=values).control


def left_out_errors(reaches, fit_and_predict, group=LEFT_OUT["-"]):
    """The error of every reach, predicted without its participant, and without the reaches of its group."""
    parts = {}
    for index, reach in enumerate(reaches):
        parts.setdefault((reach.participant, group(reach)), []).append(index)
    errors = np.empty(len(reaches))
    for (participant, key), indices in parts.items():
        others = [r for r in reaches if r.participant != participant and (key is None or group(r) != key)]
        for index, control in zip(indices, fit_and_predict(others, [reaches[i] for i in indices])):
            errors[index] = path_error(reaches[index], control)
    return errors


def by_model(options, posture=False, **covariates):
    def fit_and_predict(others, asked):
        model = fit_model(others, options, posture, **covariates)
        return [predict(model, reach, posture, **covariates) for reach in asked]

    return fit_and_predict


# ---------------------------------------------------------------- Table 1: how well curves of each degree fit


def table_1(reaches):
    rows = [("degree", "here", "2007 paper")]
    for degree, published in PAPER_TABLE_1.items():
        errors = [path_error(reach, rc.fit_bezier(reach.points, degree)) for reach in reaches]
        rows.append((DEGREE_NAMES[degree], f"{median_cm(errors):.2f}", f"{published}"))
    return rows


# ---------------------------------------------------------------- Table 2: natural variation, timing, models


def profile_errors(reach, profile):
    """(placed, refitted): of the cubic by arc length when the profile says where on it the hand is at each time, and of
    one that is fitted with these relative times to begin with."""
    progress = profile.progress(relative_times(reach))
    refitted = rc.fit_bezier(reach.points, times=progress)
    return [rc.bezier_error(reach.points, c, times=progress) for c in (rc.fit_bezier(reach.points), refitted)]


def speed_rows(reaches):
    own = [rc.SpeedProfile.fit(reach.points) for reach in reaches]

    def median_of_others(reach):
        return rc.SpeedProfile.median([p for p, r in zip(own, reaches) if r.participant != reach.participant])

    typical = {reach.participant: median_of_others(reach) for reach in reaches}
    line = rc.HandPathModel.flash_hogan()
    profiles = {
        "observed (alpha, beta)": (own, 3.2),
        "median (alpha, beta)": ([typical[reach.participant] for reach in reaches], 6.9),
        "Flash-Hogan": ([line.speed] * len(reaches), 11.4),
    }
    rows = []
    for name, (timing, published) in profiles.items():
        placed, refitted = zip(*(profile_errors(reach, profile) for reach, profile in zip(reaches, timing)))
        rows.append((f"speed: {name}", placed, published))
        rows.append((f"speed: {name}, cubic refitted with it", refitted, None))
    straight = [
        np.linalg.norm(line.predict(r.start, r.end).positions(relative_times(r)) - r.points, axis=1).max()
        for r in reaches
    ]
    whole = rc.SpeedProfile.median(own)
    rows.append(("null: Flash-Hogan, straight, over time", straight, 12.6))
    print(f"speed profile, medians over all reaches: alpha {whole.alpha:.2f}, beta {whole.beta:.2f} (paper 1.63, 1.75)")
    return rows


def model_rows(reaches):
    by_target = {"target": lambda reach: f"{reach.target:02}"}

    def error(options, **covariates):
        return left_out_errors(reaches, by_model(options, **covariates))

    return [
        ("null: end points", error({"parameterisation": "ends", "scaling": "none"}), 11.2),
        ("null: end point, then axis", error({"parameterisation": "start_axis", "scaling": "none"}), 12.3),
        ("null: axis, then end point", error({"parameterisation": "axis_end", "scaling": "none"}), 11.9),
        ("null: axis", error({"scaling": "none"}), 8.2),
        ("null: axis, distance", error({"scaling": "distance"}), 8.0),
        ("null: axis, distance and time", error({"scaling": "distance_time"}), 7.6),
        ("target mean, end points", error({"parameterisation": "ends", "scaling": "none"}, **by_target), 8.2),
        ("target mean, axis", error({"scaling": "none"}, **by_target), 8.3),
        ("subject mean, axis, distance", subject_mean_errors(reaches), 8.1),
    ]


def subject_mean_errors(reaches):
    """Each reach from the others of the same person: the one row that knows the participant, so the reach is left out."""
    errors = []
    for reach in reaches:
        others = [r for r in reaches if r is not reach and r.participant == reach.participant]
        errors.append(path_error(reach, predict(fit_model(others, {}), reach)))
    return errors


def table_2(reaches):
    points, targets = [r.points for r in reaches], [str(r.target) for r in reaches]
    replicates = rc.variation_within(points, [f"{r.participant} {r.target}" for r in reaches])
    between, moved = (rc.variation_about_median(points, targets, alignment=what) for what in ("ends", "start"))
    published = left_out_errors(reaches, lambda _, asked: [predict(rc.HandPathModel.published(), r) for r in asked])
    rows = [("model", "here", "2007 paper")]
    entries = [
        ("natural variation: within subject", replicates, 6.7),
        ("natural variation: between subjects, given both ends", between, None),
        ("natural variation: between subjects, given the start", moved, 7.6),
        *speed_rows(reaches),
        *model_rows(reaches),
        ("target and object mean, axis", [], 7.6),
        ("the published null model, as it is", published, 8.0),
    ]
    name, options, posture = CHOSEN
    entries.append((name + " (ours)", left_out_errors(reaches, by_model(options, posture)), None))
    for label, errors, paper in entries:
        here = f"{median_cm(errors):.1f}" if len(errors) else "-"
        rows.append((label, here, "-" if paper is None else f"{paper}"))
    return rows


# ---------------------------------------------------------------- Table 3: covariates, with targets left out as well


def farthest_share(reaches, options, posture):
    """Largest deviation from the straight line as a share of the distance, over targets far off in all directions."""
    model = fit_model(reaches, options, posture)
    random = np.random.default_rng(1)
    directions = random.normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    s = np.linspace(0.0, 1.0, 51)
    share = 0.0
    for distance in FAR_M:
        for direction in directions:
            values = {"posture": reaches[0].posture} if posture else {}
            path = model.predict([0, 0, 0], distance * direction, covariates=values).control
            line = s[:, None] * distance * direction
            share = max(share, np.linalg.norm(rc.eval_bezier(path, s) - line, axis=1).max() / distance)
    return share, model.deviation_bound(1.0)


def table_3(reaches, same_target):
    rows = [("model", *LEFT_OUT, "far off", "bound")]
    for name, options, posture in CANDIDATES:
        fit_and_predict = by_model(options, posture)
        errors = [median_cm(left_out_errors(reaches, fit_and_predict, group)) for group in LEFT_OUT.values()]
        far, bound = farthest_share(reaches, options, posture)
        cells = [f"{error:.2f} ({error / same_target:.2f})" for error in errors]
        rows.append((name, *cells, f"{far:.2f} d", "none" if bound is None else f"{bound:.2f} d"))
    return rows


def term_tests(reaches):
    """Which covariates explain anything beyond the others, in one linear model."""
    options = {"trend": "linear", "displacement": True, "distance": True}
    model = fit_model(reaches, options, True, duration=lambda r: r.duration, participant=lambda r: r.participant)
    rows = [("covariate", "columns", "Wilks' lambda", "p")]
    for test in model.tests():
        rows.append((test["term"], f"{test['freedom'][0]:.0f}", f"{test['wilks']:.3f}", f"{test['wilks_p_value']:.1e}"))
    return rows


def markdown(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return "\n".join(lines) + "\n"


def tables(reaches):
    by_target = {"target": lambda reach: f"{reach.target:02}"}
    same_target = median_cm(left_out_errors(reaches, by_model({"scaling": "none"}, **by_target)))
    yield "Table 1. Approximation error by degree (cm)", table_1(reaches)
    yield "Table 2. Maximum median error (cm)", table_2(reaches)
    title = "Table 3. Covariates, leaving out the participant and a part of the wall (cm; ratio to the same-target mean"
    yield f"{title}, {same_target:.2f})", table_3(reaches, same_target)
    yield "Table 4. Tests of covariates, each beyond the others", term_tests(reaches)


# ---------------------------------------------------------------- figures


def median_reach(reaches, target):
    """Of the reaches to a target the one of median cubic error: neither the best nor the worst fit."""
    asked = sorted((r for r in reaches if r.target == target), key=lambda r: path_error(r, rc.fit_bezier(r.points)))
    return asked[len(asked) // 2]


def draw_figures(folder, reaches):
    # The library of figures is asked for here only: without it the tables can still be printed.
    import hand_path_figures as figures

    _, options, posture = CHOSEN
    target = reaches[len(reaches) // 2].target
    others = [reach for reach in reaches if reach.participant != reaches[0].participant]
    model, all_model = fit_model(others, options, posture), fit_model(reaches, options, posture)
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
    if len(people) < 2:
        sys.exit(f"{arguments.mocap} holds reaches of {len(people)} participants, expected at least 2")
    text = f"{len(reaches)} reaches of {len(people)} participants: {', '.join(people)}\n"
    print(text)
    for title, rows in tables(reaches):
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
