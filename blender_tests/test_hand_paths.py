# SPDX-License-Identifier: GPL-3.0-or-later
"""Hand paths (Faraway, Reed, Wang 2007) against numpy and scipy, and the evaluation on recorded reaches.

Plain pytest, no Blender: /usr/bin/python3 -m pytest blender_tests/test_hand_paths.py
Recordings are looked for in $REACHCAST_MOCAP, else in ../shared/mocap beside the project; without them tests skip.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

PROJECT = Path(__file__).resolve().parent.parent
sys.path.insert(0, os.environ.get("REACHCAST_MODULE_DIR", str(PROJECT / "addon" / "reachcast")))
rc = pytest.importorskip("reachcast_core", reason="reachcast_core is not built for this Python")
special = pytest.importorskip("scipy.special", reason="python3-scipy is missing")
stats = pytest.importorskip("scipy.stats", reason="python3-scipy is missing")

RECORDINGS = Path(os.environ.get("REACHCAST_MOCAP", PROJECT.parent / "shared" / "mocap")) / "roag_wall_reaching"
EVALUATE = PROJECT / "examples" / "evaluate_hand_paths.py"
NUMERIC = 1e-9  # two direct solutions of the same small system in double precision
SEARCH = 2e-4  # scipy's beta.fit is a simplex search
# p01-p05 by an independent program (../shared/mocap/README.md), and how near we must come, in centimetres.
INDEPENDENT = {"straight line": 9.9, "quadratic": 5.1, "cubic": 1.57, "quartic": 0.97}
AGREEMENT_CM = 0.1


def random_paths(seed, count):
    random = np.random.default_rng(seed)
    paths = []
    for _ in range(count):
        control = np.cumsum(np.vstack([random.normal(0, 0.1, 3), random.normal([0.1, 0.3, 0.2], 0.1, (3, 3))]), axis=0)
        paths.append(rc.eval_bezier(control, np.linspace(0, 1, 40)))
    return paths


def bernstein(s, degree):
    return np.array([special.comb(degree, i) * s**i * (1 - s) ** (degree - i) for i in range(degree + 1)]).T


def scaled_offsets(paths):
    rows = []
    for path in paths:
        control, distance = rc.fit_bezier(path), np.linalg.norm(path[-1] - path[0])
        rows.append([(control[i] - path[0] - i / 3 * (path[-1] - path[0])) / distance for i in (1, 2)])
    return np.array(rows).reshape(len(paths), 6)


@pytest.mark.parametrize("times", ["arc_length", "even", "given"])
@pytest.mark.parametrize("degree", [2, 3, 5])
def test_fits_are_numpys_least_squares(times, degree):
    random = np.random.default_rng(degree)
    points = np.cumsum(random.normal(size=(60, 3)), axis=0)
    lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    given = np.concatenate([[0], np.sort(random.uniform(size=58)), [1]])
    s = {"arc_length": lengths / lengths[-1], "even": np.linspace(0, 1, 60), "given": given}[times]
    basis = bernstein(s, degree)
    rest = points - np.outer(basis[:, 0], points[0]) - np.outer(basis[:, -1], points[-1])
    inner = np.linalg.lstsq(basis[1:-1, 1:-1], rest[1:-1], rcond=None)[0]
    control = rc.fit_bezier(points, degree, times=given if times == "given" else times)
    np.testing.assert_allclose(control[1:-1], inner, atol=1e-8)
    error = np.linalg.norm(points - basis @ control, axis=1).max()
    assert rc.bezier_error(points, control, times=s) == pytest.approx(error, abs=NUMERIC)


def test_pieces_follow_what_one_curve_cannot():
    t = np.linspace(0, 1, 300)
    spiral = np.stack([np.cos(12 * t), np.sin(12 * t), t], axis=1)
    curve = rc.fit_piecewise_bezier(spiral, 0.01)
    assert rc.bezier_error(spiral, rc.fit_bezier(spiral)) > 0.5
    assert curve.error <= 0.01 and len(curve) == len(curve.pieces) == len(curve.breaks) - 1
    np.testing.assert_allclose(curve.positions(curve.breaks)[1], curve.pieces[0][-1], atol=NUMERIC)


@pytest.mark.parametrize("alpha, beta", [(1.63, 1.75), (0.3, 4.0), (9.0, 2.0)])
def test_the_speed_profile_is_scipys_most_likely_beta(alpha, beta):
    sample = stats.beta.rvs(alpha + 1, beta + 1, size=300, random_state=5)
    a, b, _, _ = stats.beta.fit(sample, floc=0, fscale=1)
    fitted = rc.SpeedProfile.fit_sample(sample)
    assert (fitted.alpha, fitted.beta) == pytest.approx((a - 1, b - 1), abs=SEARCH * 10)
    s = np.linspace(0, 1, 21)
    np.testing.assert_allclose(fitted.progress(s), stats.beta.cdf(s, fitted.alpha + 1, fitted.beta + 1), atol=1e-13)


def test_weights_count_like_repetitions_for_scipy():
    sample, weights = np.array([0.15, 0.3, 0.45, 0.6, 0.8]), np.array([1, 4, 5, 3, 2])
    a, b, _, _ = stats.beta.fit(np.repeat(sample, weights), floc=0, fscale=1)
    fitted = rc.SpeedProfile.fit_sample(sample, weights)
    assert (fitted.alpha, fitted.beta) == pytest.approx((a - 1, b - 1), abs=SEARCH * 10)


def test_regression_is_numpys_and_its_p_values_are_scipys():
    random, paths = np.random.default_rng(1), random_paths(1, 50)
    stature, sex = random.normal(1.7, 0.1, 50), [("f", "m")[i] for i in random.integers(0, 2, 50)]
    given = {"stature": stature, "sex": sex}
    model = rc.HandPathModel.fit(paths, displacement=True, covariates=given)
    assert model.coefficient_names == [
        "intercept", "displacement_x", "displacement_y", "displacement_z", "stature", "sex=m"]
    x = np.column_stack([np.ones(50), [p[-1] - p[0] for p in paths], stature, [s == "m" for s in sex]])
    y = scaled_offsets(paths)
    b = np.linalg.solve(x.T @ x, x.T @ y)
    rest = y - x @ b
    covariance = rest.T @ rest / 44
    errors = np.sqrt(np.outer(np.diag(np.linalg.inv(x.T @ x)), np.diag(covariance)))
    np.testing.assert_allclose(model.coefficients, b, atol=1e-8)
    np.testing.assert_allclose(model.covariance, covariance, atol=NUMERIC)
    np.testing.assert_allclose(model.standard_errors, errors, rtol=1e-7)
    np.testing.assert_allclose(model.p_values, 2 * stats.t.sf(np.abs(b / errors), 44), rtol=1e-6, atol=1e-12)
    kept = x[:, [0, 4, 5]]
    without = y - kept @ np.linalg.lstsq(kept, y, rcond=None)[0]
    test = next(row for row in model.tests() if row["term"] == "displacement")
    f = (np.sum(without**2, axis=0) - np.sum(rest**2, axis=0)) / 3 / (np.sum(rest**2, axis=0) / 44)
    np.testing.assert_allclose(test["f"], f, rtol=1e-6)
    np.testing.assert_allclose(test["p_value"], stats.f.sf(f, 3, 44), rtol=1e-6)
    wilks = np.linalg.det(rest.T @ rest) / np.linalg.det(without.T @ without)
    assert test["wilks"] == pytest.approx(wilks, rel=1e-7)


def test_bands_are_the_textbooks():
    paths, end = random_paths(2, 40), np.array([0.3, 0.8, 0.5])
    model = rc.HandPathModel.fit(paths, displacement=True)
    x = np.column_stack([np.ones(40), [p[-1] - p[0] for p in paths]])
    at = np.concatenate([[1], end])
    leverage = at @ np.linalg.solve(x.T @ x, at)
    s = np.array([0.25, 0.6])
    centre, half = model.band([0, 0, 0], end, s, level=0.9)
    _, wider = model.band([0, 0, 0], end, s, level=0.9, of_one_reach=True)
    weights = np.kron(bernstein(s, 3)[:, 1:3], np.eye(3))  # rows: x, y, z of each s
    deviations = np.sqrt(np.einsum("ij,jk,ik->i", weights, model.covariance, weights)).reshape(2, 3)
    size = stats.t.ppf(0.95, 36) * np.linalg.norm(end)
    np.testing.assert_allclose(half, size * np.sqrt(leverage) * deviations, rtol=1e-7)
    np.testing.assert_allclose(wider, size * np.sqrt(1 + leverage) * deviations, rtol=1e-7)
    np.testing.assert_allclose(centre, rc.eval_bezier(model.predict([0, 0, 0], end).control, s), atol=NUMERIC)


def test_the_smooth_trend_is_numpys_kernel_ridge():
    paths, end = random_paths(3, 30), np.array([0.2, 0.6, 0.1])
    model = rc.HandPathModel.fit(paths, trend="smooth", displacement=True, lengths={"displacement": 0.5}, ridge=0.2)
    x, y = np.array([p[-1] - p[0] for p in paths]) / 0.5, scaled_offsets(paths)
    kernel = np.exp(-0.5 * ((x[:, None] - x[None]) ** 2).sum(axis=2))
    near = np.exp(-0.5 * ((end / 0.5 - x) ** 2).sum(axis=1))
    mean = y.mean(axis=0) + near @ np.linalg.solve(kernel + 0.2 * np.eye(30), y - y.mean(axis=0))
    control = model.predict([0, 0, 0], end).control
    expected = np.outer([1 / 3, 2 / 3], end) + np.linalg.norm(end) * mean.reshape(2, 3)
    np.testing.assert_allclose(control[1:3], expected, atol=NUMERIC)


def test_simulated_paths_have_the_models_covariance():
    model = rc.HandPathModel.fit(random_paths(4, 60))
    end = np.array([0.0, 1.0, 0.0])  # distance 1: deviations are offsets
    mean = model.predict([0, 0, 0], end).control
    drawn = np.array([model.sample([0, 0, 0], end, seed).control - mean for seed in range(20000)])
    found = np.cov(drawn[:, 1:3].reshape(-1, 6).T)
    np.testing.assert_allclose(found, model.covariance, atol=0.05 * np.diag(model.covariance).max())


def test_principal_components_are_numpys():
    covariance = rc.HandPathModel.fit(random_paths(5, 40)).covariance
    variances, directions = rc.principal_components(covariance)
    np.testing.assert_allclose(variances, np.linalg.eigvalsh(covariance)[::-1], atol=1e-12)
    np.testing.assert_allclose(covariance @ directions, directions * variances, atol=1e-12)


@pytest.mark.parametrize(
    "words, call",
    [
        (("times", "'slow'"), lambda p: rc.fit_bezier(p[0], times="slow")),
        (("tolerance", "-1"), lambda p: rc.fit_piecewise_bezier(p[0], -1)),
        (("points", "at least 3"), lambda p: rc.SpeedProfile.fit(p[0][:2])),
        (("points move in 0",), lambda p: rc.SpeedProfile.fit(np.ones((9, 3)))),
        (("trend", "'cubic'"), lambda p: rc.HandPathModel.fit(p, trend="cubic")),
        (("parameterisation", "'end'"), lambda p: rc.HandPathModel.fit(p, parameterisation="end")),
        (("covariates['age']", "expected 6"), lambda p: rc.HandPathModel.fit(p, covariates={"age": [1.0, 2.0]})),
        (("covariates['age'][1]", "nan"), lambda p: rc.HandPathModel.fit(p, covariates={"age": [1.0, np.nan]})),
        (("covariates['age']", "numbers"), lambda p: rc.HandPathModel.fit(p, covariates={"age": ["a", 1.0]})),
        (("smooth", "no coefficients"), lambda p: rc.HandPathModel.fit(p, trend="smooth", distance=True).coefficients),
        (("depend on covariates",), lambda p: rc.HandPathModel.fit(p, displacement=True).offsets),
        (("alignment", "'middle'"), lambda p: rc.variation_within(p, ["a"] * 6, alignment="middle")),
        (("covariance", "(2, 3)"), lambda p: rc.principal_components(np.ones((2, 3)))),
    ],
)
def test_wrong_arguments_are_named(words, call):
    with pytest.raises(ValueError) as caught:
        call(random_paths(6, 6))
    for word in words:
        assert word in str(caught.value)


def evaluate(folder, out):
    command = [sys.executable, str(EVALUATE), "--mocap", str(folder), "--out", str(out)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def cells(text, title):
    """First cell to the others, of the table with this title."""
    part = text.split(title)[1].split("\n\n")[1]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in part.splitlines()]
    return {row[0]: row[1:] for row in rows[2:]}


def need_recordings():
    if not RECORDINGS.is_dir():
        pytest.skip(f"recordings are missing: {RECORDINGS}")


def test_the_evaluation_runs_on_some_participants(tmp_path):
    need_recordings()
    files = sorted(RECORDINGS.glob("*.csv"))
    if len(files) < 3:
        pytest.skip(f"recordings are missing: fewer than 3 participants in {RECORDINGS}")
    some = tmp_path / "some"
    some.mkdir()
    for file in files[:3]:
        (some / file.name).symlink_to(file)
    done = evaluate(some, tmp_path / "out")
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "out" / "tables.md").read_text(encoding="utf-8")
    assert "3 participants" in text
    fits = [float(row[0]) for row in cells(text, "Table 1.").values()]
    assert fits == sorted(fits, reverse=True)
    assert len(list((tmp_path / "out").glob("*.png"))) == 7
    assert all(picture.stat().st_size > 10_000 for picture in (tmp_path / "out").glob("*.png"))


def test_the_figures_agree_with_the_independent_program(tmp_path):
    need_recordings()
    files = sorted(RECORDINGS.glob("*.csv"))
    if [file.name[:3] for file in files] != ["p01", "p02", "p03", "p04", "p05"]:
        pytest.skip(f"the independent figures are for p01-p05, but {RECORDINGS} holds others")
    done = evaluate(RECORDINGS, tmp_path)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "tables.md").read_text(encoding="utf-8")
    for degree, figure in INDEPENDENT.items():
        assert float(cells(text, "Table 1.")[degree][0]) == pytest.approx(figure, abs=AGREEMENT_CM)
    ours = cells(text, "Table 3.")["smooth, and in the posture"]
    ratios = [float(re.search(r"\((.*)\)", cell).group(1)) for cell in ours[:6]]
    assert ratios[0] <= 1.0, "leaving out the participant"
    assert max(ratios) <= 1.1, "leaving out targets as well"


def test_the_evaluation_says_what_it_lacks(tmp_path):
    done = evaluate(tmp_path, tmp_path / "out")
    assert done.returncode != 0
    assert str(tmp_path) in done.stderr and "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()
