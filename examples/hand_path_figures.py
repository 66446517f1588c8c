# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of hand paths like those of Faraway, Reed and Wang (2007), as PNG; no display is needed."""

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from wall_reaches import np, rc  # noqa: E402

# Title, the coordinates across and up, and their names.
VIEWS = (
    ("from above", 0, 1, "right (m)", "forward (m)"),
    ("from behind", 0, 2, "right (m)", "up (m)"),
    ("from the right", 1, 2, "forward (m)", "up (m)"),
)
OBSERVED, MODELLED = "#3b6ea5", "#c8553d"
SAMPLES = np.linspace(0.0, 1.0, 101)
SIMULATED = 20
SECTORS = 24


def views(rows=1):
    """A row of three axes with equal scales, named."""
    figure, axes = plt.subplots(rows, 3, figsize=(12, 4.3 * rows), squeeze=False, constrained_layout=True)
    for row in axes:
        for axis, (title, _, _, across, up) in zip(row, VIEWS):
            axis.set(title=title, xlabel=across, ylabel=up)
            axis.set_aspect("equal")
            axis.grid(color="0.9")
            axis.set_axisbelow(True)
    return figure, axes


def draw(row, points, **style):
    """One path in each of the three views; the label goes to the first, for one legend."""
    label = style.pop("label", None)
    for axis, (_, across, up, _, _) in zip(row, VIEWS):
        axis.plot(points[:, across], points[:, up], label=label if axis is row[0] else None, **style)


def same_scale(axes):
    """All views are squares of the same size, and those of one column show the same part of space."""
    boxes = [[axis.dataLim.get_points() for axis in column] for column in axes.T]
    low = np.array([np.min([box[0] for box in column], axis=0) for column in boxes])
    high = np.array([np.max([box[1] for box in column], axis=0) for column in boxes])
    half = 0.54 * (high - low).max()
    for column, (x, y) in zip(axes.T, (low + high) / 2):
        for axis in column:
            axis.set(xlim=(x - half, x + half), ylim=(y - half, y + half))


def save_views(figure, axes, folder, name, title):
    same_scale(axes)
    return save(figure, folder, name, title)


def save(figure, folder, name, title):
    figure.suptitle(title)
    figure.savefig(folder / name, dpi=110)
    plt.close(figure)
    return folder / name


def from_start(reach):
    return reach.points - reach.start


def paths_of_one_person(folder, reaches):
    """Fig. 1."""
    mine = [reach for reach in reaches if reach.participant == reaches[0].participant]
    figure, axes = views()
    for reach in mine:
        draw(axes[0], from_start(reach), color=OBSERVED, lw=0.8)
    title = f"{len(mine)} reaches of {mine[0].participant}, moved to start at the same point"
    return save_views(figure, axes, folder, "paths_of_one_person.png", title)


def paths_to_one_target(folder, reaches, target):
    """Fig. 2."""
    figure, axes = views()
    colours = plt.get_cmap("tab10")
    for i, reach in enumerate(r for r in reaches if r.target == target):
        draw(axes[0], from_start(reach), color=colours(i % 10), lw=1.2, label=reach.participant)
    axes[0][0].legend(frameon=False)
    title = f"Reaches to target {target}, moved to start at the same point"
    return save_views(figure, axes, folder, "paths_to_one_target.png", title)


def cubic_fit(folder, reach):
    """Fig. 4."""
    control = rc.fit_bezier(reach.points) - reach.start
    figure, axes = views()
    draw(axes[0], from_start(reach), color=OBSERVED, ls="none", marker=".", ms=4, label="observed")
    draw(axes[0], rc.eval_bezier(control, SAMPLES), color=MODELLED, lw=1.5, label="cubic")
    draw(axes[0], control, color="0.3", ls=":", marker="o", ms=5, lw=1, label="control points")
    axes[0][0].legend(frameon=False)
    title = f"A cubic Bezier fit: {reach.participant}, target {reach.target}"
    return save_views(figure, axes, folder, "cubic_fit.png", title)


def bearing(vector):
    """Degrees from above, zero forward, positive to the right."""
    return np.degrees(np.arctan2(vector[0], vector[1]))


def rose_diagrams(folder, reaches):
    """Fig. 6."""
    first = np.array([bearing(rc.fit_bezier(reach.points)[1] - reach.start) for reach in reaches])
    target = np.array([bearing(reach.end - reach.start) for reach in reaches])
    parts = (
        ("first control point from the start", first),
        ("end from the start", target),
        ("first less second", (first - target + 180.0) % 360.0 - 180.0),
    )
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.8), subplot_kw={"projection": "polar"}, constrained_layout=True)
    edges = np.linspace(-180.0, 180.0, SECTORS + 1) - 180.0 / SECTORS
    for axis, (title, angles) in zip(axes, parts):
        counts, _ = np.histogram((angles - edges[0]) % 360.0 + edges[0], edges)
        middles = np.radians(edges[:-1] + 180.0 / SECTORS)
        # Areas, not radii, are proportional to the counts.
        axis.bar(middles, np.sqrt(counts), width=np.radians(360.0 / SECTORS), color=OBSERVED, edgecolor="white")
        axis.set_theta_zero_location("N")
        axis.set_theta_direction(-1)
        axis.set_yticks([])
        axis.set_axisbelow(True)
        axis.set_title(title, pad=14)
    title = f"Directions from above, 0 is forward, 90 to the right; {len(reaches)} reaches"
    return save(figure, folder, "rose_diagrams.png", title)


def predicted_and_observed(folder, reaches, model, predict):
    """Figs 1 and 7: above as observed, below as predicted from the others."""
    mine = [reach for reach in reaches if reach.participant == reaches[0].participant]
    figure, axes = views(2)
    for reach in mine:
        draw(axes[0], from_start(reach), color=OBSERVED, lw=0.8)
        control = predict(model, reach) - reach.start
        draw(axes[1], rc.eval_bezier(control, SAMPLES), color=MODELLED, lw=0.8)
    title = f"{mine[0].participant}: observed (above) and predicted from the other participants (below)"
    return save_views(figure, axes, folder, "predicted_and_observed.png", title)


def simulated_and_observed(folder, reaches, target, sample):
    """Figs 2 and 8: simulated with the start, end and posture of the first of the reaches to a target."""
    asked = [reach for reach in reaches if reach.target == target]
    figure, axes = views(2)
    for reach in asked:
        draw(axes[0], from_start(reach), color=OBSERVED, lw=1)
    for seed in range(SIMULATED):
        control = sample(asked[0], seed) - asked[0].start
        draw(axes[1], rc.eval_bezier(control, SAMPLES), color=MODELLED, lw=0.8)
    title = f"Target {target}: {len(asked)} observed (above), {SIMULATED} simulated with one start and end (below)"
    return save_views(figure, axes, folder, "simulated_and_observed.png", title)


def confidence_band(folder, reach, bands):
    """A predicted path, its 95 % bands, and what that person did, by relative arc length."""
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), constrained_layout=True)
    observed = rc.resample_path(reach.points, len(SAMPLES)) - reach.start
    for i, (axis, name) in enumerate(zip(axes, ("right (m)", "forward (m)", "up (m)"))):
        for alpha, label, (centre, half) in bands:
            middle = centre[:, i] - reach.start[i]
            low, high = middle - half[:, i], middle + half[:, i]
            axis.fill_between(SAMPLES, low, high, color=MODELLED, alpha=alpha, lw=0, label=label)
        axis.plot(SAMPLES, middle, color=MODELLED, lw=1.2, label="predicted")
        axis.plot(SAMPLES, observed[:, i], color=OBSERVED, lw=1.5, label="observed")
        axis.set(xlabel="relative arc length", ylabel=name)
        axis.grid(color="0.9")
        axis.set_axisbelow(True)
    axes[0].legend(frameon=False)
    title = f"{reach.participant}, target {reach.target}: predicted from the other participants, with 95 % bands"
    return save(figure, folder, "confidence_band.png", title)
