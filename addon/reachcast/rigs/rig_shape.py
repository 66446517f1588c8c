# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bone is which segment, from the skeleton's shape alone: heights, sides, lengths and what hangs on what.

Two chains that reach the floor are the legs, the highest bone belongs to the head, and of what branches off between them
the longest chain on each side is an arm. On each limb the joints are the bones whose distances are closest to a
person's, so that twist bones between them are passed over. Lengths are parts of the height (Drillis and Contini 1964),
of which a rig shows 95 %: its highest bone ends below the crown.
"""
from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from .bone_map import BoneMap
from .rotations import Array
from .skeleton import Bones

NAME = "Recognised by its shape"
_THIGH, _SHIN, _UPPER_ARM, _FOREARM = 0.257, 0.258, 0.195, 0.153
_SHOULDER, _ANKLE = 0.115, 0.045    #: from the middle; above the floor
_NEAR_FLOOR, _PELVIS_LEAST, _ANKLE_MOST = 0.10, 0.35, 0.12
_MOST_OFF = 0.15     #: summed misfit of a limb's two links beyond which it is no person's limb
_STEP = 0.01         #: two bones closer than this start at one place


def shape_map(bones: Bones, rig: str) -> BoneMap:
    """The map of a rig that stands upright in the world; ValueError says what of a person is not found."""
    return _Shape(bones, rig).found()


class _Shape:
    def __init__(self, bones: Bones, rig: str) -> None:
        self.bones, self.rig = bones, rig
        count = len(bones.names)
        self.children: list[list[int]] = [[] for _ in range(count)]
        for bone, parent in enumerate(bones.parents):
            if parent >= 0:
                self.children[parent].append(bone)
        ends = np.concatenate([bones.heads, bones.tails])
        self.floor, self.height = float(ends[:, 2].min(initial=0.0)), float(np.ptp(ends[:, 2])) if count else 0.0
        if self.height <= 0.0:
            raise self.missing("height")
        self.lowest = bones.heads[:, 2].copy()   # of each bone's subtree
        self.highest = bones.tails[:, 2].copy()
        for bone in range(count - 1, -1, -1):
            for child in self.children[bone]:
                self.lowest[bone] = min(self.lowest[bone], self.lowest[child])
                self.highest[bone] = max(self.highest[bone], self.highest[child])

    def missing(self, what: str) -> ValueError:
        return ValueError(f"Rig '{self.rig}' is no rig whose bones have known names, and its shape shows no {what}; "
                          f"give it a bone map")

    def found(self) -> BoneMap:
        legs = self.leg_chains()
        line = self.line_up(legs[0][0])
        limbs = [self.limb(chain, (_THIGH, _SHIN), "leg", self.off_ankle) for chain in legs]
        limbs = [self.with_ankle(chain, limb) for chain, limb in zip(legs, limbs)]
        toes = [self.toe(chain, limb[2]) for chain, limb in zip(legs, limbs)]
        across = self.left(limbs, toes)
        arms = self.arm_chains(line, across)
        chest = self.bones.parents[arms[0][0]]
        if chest != self.bones.parents[arms[1][0]] or chest not in line:
            raise self.missing("chest that carries both arms")
        pelvis = self.pelvis(line, legs)
        trunk = line[line.index(pelvis) + 1:line.index(chest) + 1]
        above = line[line.index(chest) + 1:]
        if not trunk or len(above) < 2:
            raise self.missing("spine" if not trunk else "neck and head")
        segments = {"pelvis": pelvis, "spine": trunk[0], "chest": chest, "neck": above[0], "head": self.head(above)}
        middle = self.side(pelvis, across)
        order = (0, 1) if self.side(limbs[0][0], across) > self.side(limbs[1][0], across) else (1, 0)
        for side, number in zip("LR", order):
            segments.update(zip((f"{part}.{side}" for part in ("thigh", "shin", "foot")), limbs[number]))
            if toes[number] is not None:
                segments[f"toe.{side}"] = toes[number]
        for side, chain in zip("LR", arms):
            limb = self.limb(self.to_hand(chain), (_UPPER_ARM, _FOREARM), "arm",
                             lambda limb: abs(abs(self.side(limb[0], across) - middle) / self.height - _SHOULDER))
            segments.update(zip((f"{part}.{side}" for part in ("upper_arm", "forearm", "hand")), limb))
            if limb[0] != chain[0]:
                segments[f"clavicle.{side}"] = chain[0]
        return BoneMap(NAME, {segment: self.bones.names[bone] for segment, bone in segments.items()})

    def leg_chains(self) -> list[list[int]]:
        """From below the bone where they part down to the toes."""
        near = self.floor + _NEAR_FLOOR * self.height
        for fork in range(len(self.children) - 1, -1, -1):
            down = [child for child in self.children[fork] if self.lowest[child] <= near]
            if len(down) == 2 and self.bones.heads[fork, 2] > self.floor + _PELVIS_LEAST * self.height:
                return [self.follow(child, self.span) for child in down]
        raise self.missing("two legs")

    def follow(self, bone: int, worth: object) -> list[int]:
        chain = [bone]
        while self.children[chain[-1]]:
            chain.append(max(self.children[chain[-1]], key=worth))  # type: ignore[arg-type]
        return chain

    def line_up(self, leg: int) -> list[int]:
        """From the root to the highest bone."""
        root = [leg, *self.bones.ancestors(leg)][-1]
        return self.follow(root, lambda bone: self.highest[bone])

    def pelvis(self, line: list[int], legs: list[list[int]]) -> int:
        return next(bone for bone in self.bones.ancestors(legs[0][0]) if bone in line)

    def head(self, above: list[int]) -> int:
        """Where the neck's last bone ends: the bone below which a face fans out, or the last one."""
        top = next((number for number, bone in enumerate(above) if len(self.children[bone]) > 2), len(above) - 1)
        apart = np.linalg.norm(self.bones.heads[above[top]] - self.bones.heads[above[top - 1]])
        return above[top - 1] if top > 1 and apart < _STEP * self.height else above[top]

    def limb(self, chain: list[int], parts: tuple[float, float], what: str,
             extra: Callable[[list[int]], float]) -> list[int]:
        """The three bones at whose heads the joints of the limb are; `extra`: what else speaks against them."""
        def off(triple: tuple[int, ...]) -> float:
            places = self.bones.heads[list(triple)]
            spans = np.linalg.norm(np.diff(places, axis=0), axis=1) / self.height
            return float(np.abs(spans - parts).sum()) + extra(list(triple))

        best = min(itertools.combinations(chain, 3), key=off, default=None)
        if best is None or off(best) > _MOST_OFF:
            raise self.missing(what)
        return list(best)

    def off_ankle(self, limb: list[int]) -> float:
        return abs(float(self.bones.heads[limb[2], 2] - self.floor) / self.height - _ANKLE)

    def with_ankle(self, chain: list[int], limb: list[int]) -> list[int]:
        if self.bones.heads[limb[2], 2] > self.floor + _ANKLE_MOST * self.height:
            raise self.missing("ankle near the floor")
        return limb

    def toe(self, chain: list[int], foot: int) -> int | None:
        below = chain[chain.index(foot) + 1:]
        away = [np.linalg.norm((self.bones.heads[bone] - self.bones.heads[foot])[:2]) for bone in below]
        return next((bone for bone, far in zip(below, away) if far > _STEP * self.height), None)

    def left(self, limbs: list[list[int]], toes: list[int | None]) -> Array:
        """(3,) unit: to the left of where the feet point."""
        ends = [self.bones.tails[limb[2]] if toe is None else self.bones.heads[toe] for limb, toe in zip(limbs, toes)]
        ahead = sum((end - self.bones.heads[limb[2]] for end, limb in zip(ends, limbs)), np.zeros(3))
        hips = self.bones.heads[limbs[0][0]] - self.bones.heads[limbs[1][0]]
        across = np.array([-ahead[1], ahead[0], 0.0])
        hips[2] = 0.0
        if np.linalg.norm(hips) < _STEP * self.height or abs(hips @ across) < 1e-9:
            raise self.missing("left and right")
        return hips / np.linalg.norm(hips) * np.sign(hips @ across)

    def side(self, bone: int, across: Array) -> float:
        return float(self.bones.heads[bone] @ across)

    def arm_chains(self, line: list[int], across: Array) -> list[list[int]]:
        """Left and right: the longest chains that branch off the trunk above the legs."""
        middle = float(np.mean([self.side(bone, across) for bone in line]))
        best: dict[bool, tuple[float, list[int]]] = {}
        for fork in line:
            for child in self.children[fork]:
                if child in line or self.bones.heads[child, 2] < self.floor + 0.6 * self.height:
                    continue
                chain = self.follow(child, self.span)
                is_left = self.side(chain[-1], across) > middle
                if is_left not in best or self.reach(child) > best[is_left][0]:
                    best[is_left] = (self.reach(child), chain)
        if len(best) < 2:
            raise self.missing("two arms")
        return [best[True][1], best[False][1]]

    def to_hand(self, chain: list[int]) -> list[int]:
        """Up to where fingers fan out; with fewer fingers, the whole chain."""
        hand = next((number for number, bone in enumerate(chain) if number > 1 and len(self.children[bone]) > 2), None)
        return chain if hand is None else chain[:hand + 1]

    def span(self, bone: int) -> float:
        """Length of the longest chain from the bone's parent down, metres."""
        return float(np.linalg.norm(self.bones.heads[bone] - self.bones.heads[self.bones.parents[bone]])) + self.reach(bone)

    def reach(self, bone: int) -> float:
        """Length of the longest chain of bones below, metres."""
        own = self.bones.heads[bone]
        return max((float(np.linalg.norm(self.bones.heads[child] - own)) + self.reach(child)
                    for child in self.children[bone]), default=float(np.linalg.norm(self.bones.tails[bone] - own)))
