# SPDX-License-Identifier: GPL-3.0-or-later
"""A stand-in for reachcast_core with the same names: a statue whose arms alone carry a box along an arc.

Lets the add-on's reading and writing be tested without a corpus. Not a predictor. Rigs are posed by the real module.
"""
from __future__ import annotations

import sys
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any
from unittest import mock

import numpy as np
from reachcast import native
from reachcast.rigs.joints import INDEX, JOINTS

SECONDS = 2.0
_SIDE = {  # x outwards, y forward, z up, of a person of stature 1
    "ball": (0.06, 0.075, 0.012), "ankle": (0.06, 0.0, 0.045), "knee": (0.056, 0.01, 0.285),
    "hip": (0.052, 0.0, 0.53), "shoulder": (0.115, -0.005, 0.815), "elbow": (0.135, -0.015, 0.63),
    "wrist": (0.15, 0.02, 0.485), "hand_front": (0.15, 0.055, 0.445), "hand_back": (0.15, 0.005, 0.43),
    "grip": (0.15, 0.03, 0.4375), "clavicle": (0.012, 0.035, 0.81),
}
_MIDDLE = {"l5s1": (0.0, -0.02, 0.6), "c7t1": (0.0, -0.035, 0.86), "suprasternale": (0.0, 0.035, 0.81),
           "tragion": (0.0, 0.0, 0.93), "nasion": (0.0, 0.055, 0.945)}


@dataclass(frozen=True)
class Body:
    posture: np.ndarray
    stature: float

    @staticmethod
    def from_posture(posture: Any, stature: float) -> Body:
        return Body(np.array(posture, dtype=float), stature)

    def bending_at(self, points: Any) -> Body:
        return self

    @staticmethod
    def from_stature(stature: float, sex: str | None = None) -> Body:
        posture = np.empty((len(JOINTS), 3))
        for name, place in _MIDDLE.items():
            posture[INDEX[name]] = place
        for name, (x, y, z) in _SIDE.items():
            posture[INDEX[f"left_{name}"]], posture[INDEX[f"right_{name}"]] = (-x, y, z), (x, y, z)
        return Body(stature * posture, stature)


@dataclass(frozen=True)
class Subject:
    stature: float
    sex: str | None = None
    age: float | None = None
    mass: float | None = None


@dataclass(frozen=True)
class Box:
    width: float
    depth: float
    height: float
    handle_height: float
    mass: float
    grip_distance: float


@dataclass(frozen=True)
class Task:
    home: np.ndarray
    target: np.ndarray
    object: Box
    home_yaw: float = 0.0
    target_yaw: float = 0.0
    hands: str = "both"


class Corpus:
    meta = {"kind": "recorded"}
    path = "statue"

    @staticmethod
    def open(path: str) -> Corpus:
        with open(path, "rb"):
            return Corpus()


@dataclass(frozen=True)
class Neighbour:
    id: int = 7
    origin: str = "statue"
    mirrored: bool = False
    weight: float = 1.0
    distances: Any = field(default_factory=lambda: {"target": 0.1, "home": 0.0, "stature": 0.02})
    phase: str = "transfer"


@dataclass
class Motion:
    positions: np.ndarray
    times: np.ndarray
    box_positions: np.ndarray
    box_quaternions: np.ndarray
    events: dict[str, int]
    phases: list[tuple[str, int, int]]
    joints: tuple[str, ...] = JOINTS
    neighbours: list[Neighbour] = field(default_factory=lambda: [Neighbour()])
    outside_data: bool = False
    outside_reasons: list[str] = field(default_factory=list)
    corrections: list[str] = field(default_factory=list)
    ways: list[str] = field(default_factory=lambda: ["deviation"])

    @property
    def bends(self) -> np.ndarray:
        return np.zeros(len(self.times))


def predict(corpus: Corpus, subject: Subject, task: Task, body: Body | None = None, *, frame_rate: float = 24.0,
            **_options: Any) -> Motion:
    body = body or Body.from_stature(subject.stature)
    count = round(SECONDS * frame_rate)
    progress = np.clip((np.arange(count) - 2.0) / (count - 6.0), 0.0, 1.0)
    progress = progress * progress * (3.0 - 2.0 * progress)
    box = task.home + progress[:, None] * (task.target - task.home)
    yaw = task.home_yaw + progress * (task.target_yaw - task.home_yaw)
    turned = np.stack([np.cos(yaw / 2), 0 * yaw, 0 * yaw, np.sin(yaw / 2)], axis=1)
    positions = np.repeat(body.posture[None], count, axis=0)
    handle = 0.5 * task.object.grip_distance * np.stack([np.cos(yaw), np.sin(yaw), 0 * yaw], axis=1)
    middle = box + [0.0, 0.0, task.object.handle_height]
    _place_arm(positions, "left", middle - handle)
    _place_arm(positions, "right", middle + handle)
    return Motion(positions, np.arange(count) / frame_rate, box, turned,
                  {"grasp": 0, "lift_off": 2, "placed": count - 4, "release": count - 3, "end": count - 1},
                  [("transfer", 2, count - 4)])


def _place_arm(positions: np.ndarray, word: str, grips: np.ndarray) -> None:
    rest = {name: positions[0, INDEX[f"{word}_{name}"]].copy() for name in
            ("shoulder", "elbow", "wrist", "grip", "hand_front", "hand_back")}
    upper, lower, hand = (np.linalg.norm(rest[a] - rest[b]) for a, b in
                          (("elbow", "shoulder"), ("wrist", "elbow"), ("grip", "wrist")))
    ahead = grips - rest["shoulder"]
    ahead[:, 2] *= 0.3
    wrists = grips - hand * ahead / np.linalg.norm(ahead, axis=1, keepdims=True)
    axis = wrists - rest["shoulder"]
    reach = np.linalg.norm(axis, axis=1)
    if reach.max() > 0.999 * (upper + lower):
        raise ValueError(f"target is {100 * (reach.max() - upper - lower) + 0.1:.1f} cm beyond the reach of the "
                         f"{word} grip from the {word} shoulder")
    axis /= reach[:, None]
    along = (upper ** 2 - lower ** 2 + reach ** 2) / (2.0 * reach)
    across = np.array([0.5 if word == "right" else -0.5, 0.0, -1.0])
    across = across - axis * (axis @ across)[:, None]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    height = np.sqrt(np.maximum(upper ** 2 - along ** 2, 0.0))
    positions[:, INDEX[f"{word}_elbow"]] = rest["shoulder"] + along[:, None] * axis + height[:, None] * across
    positions[:, INDEX[f"{word}_wrist"]] = wrists
    positions[:, INDEX[f"{word}_grip"]] = grips
    for name in ("hand_front", "hand_back"):  # not rigid, but nothing reads them
        positions[:, INDEX[f"{word}_{name}"]] = grips + (rest[name] - rest["grip"])


def installed() -> Any:
    """A context in which the add-on's native module is this one."""
    module = ModuleType("reachcast_core")
    for name in ("Body", "Subject", "Box", "Task", "Corpus", "Motion", "predict", "JOINTS"):
        setattr(module, name, globals()[name])
    for name in ("RestRig", "rotation_values"):
        setattr(module, name, getattr(native.core(), name))
    return mock.patch.dict(sys.modules, {"reachcast_core": module})
