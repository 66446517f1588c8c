# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of Faraway, Reed and Wang (2007) for recorded reaches, each a list of rows of text, the titles first.

An error is the largest distance between the observed and the modelled path at equal relative arc length; tables give
the median over reaches, in centimetres. Whatever is predicted is learned without the participant it is compared with.
"""

from wall_reaches import np, rc

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
    rows.append(("null: Flash-Hogan, straight, over time", straight, 12.6))
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
    """Each reach from the person's other ones: the one row that knows the participant, so the reach is left out."""
    errors = []
    for reach in reaches:
        others = [r for r in reaches if r is not reach and r.participant == reach.participant]
        errors.append(path_error(reach, predict(fit_model(others, {}), reach)))
    return errors


def table_2(reaches, lifts):
    points, targets = [r.points for r in reaches], [str(r.target) for r in reaches]
    replicates = rc.variation_within(points, [f"{r.participant} {r.target}" for r in reaches])
    repeated = rc.variation_within(*lifts)
    between, moved = (rc.variation_about_median(points, targets, alignment=what) for what in ("ends", "start"))
    published = left_out_errors(reaches, lambda _, asked: [predict(rc.HandPathModel.published(), r) for r in asked])
    rows = [("model", "here", "2007 paper")]
    entries = [
        ("natural variation: within subject", replicates, 6.7),
        ("natural variation: within subject, repeated box lifts", repeated, None),
        ("natural variation: between subjects, given both ends", between, 7.6),
        ("natural variation: between subjects, given the start", moved, None),
        *speed_rows(reaches),
        *model_rows(reaches),
        ("target and object mean, axis", [], 7.6),
        ("the published null model, as it is", published, 8.0),
    ]
    name, options, posture = CHOSEN
    entries.append((f"{name} (Table 3)", left_out_errors(reaches, by_model(options, posture)), None))
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


def table_5(reaches):
    """How often a stranger's coordinates lie in the 95 % band of one reach, and how far reaches vary about it."""
    s = np.linspace(0.0, 1.0, 101)
    rows = [("model", "in the band: right, forward, up (%)", "observed from mean (cm)", "simulated from mean (cm)")]
    for name, options, posture in (CANDIDATES[0], CANDIDATES[1], CHOSEN):
        inside, observed, simulated = [], [], []
        for participant in sorted({reach.participant for reach in reaches}):
            others = [reach for reach in reaches if reach.participant != participant]
            model = fit_model(others, {**options, "people": [reach.participant for reach in others]}, posture)
            for seed, reach in enumerate(r for r in reaches if r.participant == participant):
                asked = {"covariates": {"posture": reach.posture} if posture else {}}
                centre, half = model.band(reach.start, reach.end, s, of_one_reach=True, **asked)
                miss = rc.resample_path(reach.points, len(s)) - centre
                drawn = rc.eval_bezier(model.sample(reach.start, reach.end, seed, **asked).control, s) - centre
                inside.append((np.abs(miss) <= half)[1:-1].mean(axis=0))
                observed.append(np.linalg.norm(miss, axis=1).max())
                simulated.append(np.linalg.norm(drawn, axis=1).max())
        covered = ", ".join(f"{100 * share:.0f}" for share in np.mean(inside, axis=0))
        rows.append((name, covered, f"{median_cm(observed):.1f}", f"{median_cm(simulated):.1f}"))
    return rows


def markdown(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return "\n".join(lines) + "\n"


def tables(reaches, lifts):
    """Reaches to the wall, and (paths, people) of repeated lifts, which may be none."""
    by_target = {"target": lambda reach: f"{reach.target:02}"}
    same_target = median_cm(left_out_errors(reaches, by_model({"scaling": "none"}, **by_target)))
    yield "Table 1. Approximation error by degree (cm)", table_1(reaches)
    speed = rc.SpeedProfile.median([rc.SpeedProfile.fit(reach.points) for reach in reaches])
    exponents = f"median alpha {speed.alpha:.2f}, beta {speed.beta:.2f}, in the paper 1.63 and 1.75"
    yield f"Table 2. Maximum median error (cm); speed profile: {exponents}", table_2(reaches, lifts)
    title = "Table 3. Covariates, leaving out the participant and a part of the wall (cm; ratio to the same-target mean"
    yield f"{title}, {same_target:.2f})", table_3(reaches, same_target)
    yield "Table 4. Tests of covariates, each beyond the others", term_tests(reaches)
    yield "Table 5. Bands and simulated reaches for a person left out", table_5(reaches)
