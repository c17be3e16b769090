"""A pose fitted to one instant of all cameras, from coarse to fine."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.markerless.body import Body
from kinesphere.markerless.evidence import Evidence
from kinesphere.markerless.kernels.lines import SAMPLES, offsets_kernel, open_line_kernel
from kinesphere.markerless.pose import Pose, Posed, posed
from kinesphere.markerless.rim import Canvas, Parts, Rim, derivatives, image_directions
from kinesphere.markerless.settings import TrackSettings
from kinesphere.markerless.solver import Normals, Prior, solve_step

_FLOOR = 0.05
"""Least variance of an edge, in samples²: no line is surer than a quarter of a sample."""
_FAR = 3.0
"""Samples from which on a line's say falls off: neighbours do not move it that far."""
_DAMPING = 1e-3


@dataclass(frozen=True, eq=False)
class Eye:
    """One camera: where it draws, and what its image says."""

    canvas: Canvas
    evidence: Evidence


def near_limbs(body: Body) -> NDArray[np.bool_]:
    """Return which limbs a line may run through as its own: itself, parent, child."""
    parents = body.chain.parents
    near = np.eye(len(parents), dtype=bool)
    for limb, parent in enumerate(parents):
        if parent >= 0:
            near[limb, parent] = near[parent, limb] = True
    return near


@dataclass(frozen=True, eq=False)
class Fitter:
    """Fits a body's pose to what its eyes see."""

    body: Body
    eyes: tuple[Eye, ...]
    settings: TrackSettings
    near: NDArray[np.bool_]

    @property
    def open_eyes(self) -> tuple[Eye, ...]:
        """The eyes that have an image at this instant."""
        return tuple(eye for eye in self.eyes if eye.evidence.seeing)

    def fit(
        self,
        pose: Pose,
        priors: tuple[Prior, ...],
        schedule: Sequence[tuple[int, int]] | None = None,
    ) -> Pose:
        """Return the pose that fits best near a given one.

        Parameters
        ----------
        schedule
            Scales in px and iterations at each; by default those of the settings. What hides what
            is drawn once a scale.
        """
        s = self.settings
        for scale, iterations in schedule or ((4, s.coarse), (2, s.middle), (1, s.fine)):
            seen: list[Parts] = []
            for i in range(iterations):
                at = posed(self.body.chain, pose)
                points = self.body.skinned(at)
                normals = self.body.normals(points)
                if i == 0:
                    seen = [eye.canvas.draw(points) for eye in self.open_eyes]
                equations = Normals.empty(self.body.chain.n_dofs)
                for eye, parts in zip(self.open_eyes, seen, strict=True):
                    rim = eye.canvas.rim(points, normals, parts)
                    if len(rim.shares) == 0:
                        continue
                    self.add_lines(eye, at, points, rim, parts, scale, equations)
                pose, step = solve_step(self.body.chain, pose, equations, priors, _DAMPING)
                if step < 1e-4:
                    break
        return pose

    def add_lines(
        self,
        eye: Eye,
        at: Posed,
        points: Array,
        rim: Rim,
        parts: Parts,
        scale: int,
        equations: Normals,
    ) -> None:
        """Add, for each point of a rim, how far across it the image has the edge."""
        offset, variance, agreement = self.edges(eye, rim, parts, scale)
        weight = np.isfinite(agreement) / (variance + _FLOOR)
        weight *= self.settings.data_weight / (1 + (offset / _FAR) ** 2)
        directions = image_directions(eye.canvas.view, points, rim.pairs, rim.shares, rim.normals)
        _, rows = derivatives(self.body, at, rim.pairs, rim.shares, directions[:, None])
        equations.add(rows[:, 0], offset * scale, weight / scale**2)

    def edges(self, eye: Eye, rim: Rim, parts: Parts, scale: int) -> tuple[Array, Array, Array]:
        """Return where the image has the edge: offsets and variances in samples, agreement."""
        n = len(rim.shares)
        use = np.empty((n, SAMPLES), dtype=np.int8)
        step = float(scale)
        open_line_kernel(rim.pixels, rim.normals, rim.parts, parts.limbs, self.near, step, use)
        probabilities = eye.evidence.samples(rim, use, scale)
        offset, variance, agreement = np.empty(n), np.empty(n), np.empty(n)
        s = self.settings
        offsets_kernel(
            probabilities,
            s.steepness if scale > 1 else s.fine_steepness,
            s.trust if scale > 1 else s.fine_trust,
            offset,
            variance,
            agreement,
        )
        return offset, variance, agreement

    def look_at(self, pose: Pose) -> list[tuple[Parts, Rim]]:
        """Return what every eye that is open would see of a pose."""
        points = self.body.skinned(posed(self.body.chain, pose))
        normals = self.body.normals(points)
        seen = []
        for eye in self.open_eyes:
            parts = eye.canvas.draw(points)
            seen.append((parts, eye.canvas.rim(points, normals, parts)))
        return seen

    def score(self, pose: Pose) -> tuple[Array, Array]:
        """Return how much a pose explains, by limb: nats summed over a grid of pixels, and pixels.

        The sum over limbs tells poses of one instant apart: what covers the person's pixels gains,
        what covers the background's loses, what leaves the person's bare forgoes the gain.
        """
        scores = np.zeros(len(self.body.chain.links))
        counts = np.zeros(len(scores))
        points = self.body.skinned(posed(self.body.chain, pose))
        for eye in self.open_eyes:
            eye.evidence.score(eye.canvas.draw(points), scores, counts)
        return scores, counts
