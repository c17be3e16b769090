"""Poses from contours: votes for limbs, lines of sight, eq. (12) of Rosenhahn et al. 2006."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.geometry.rotations import hat
from kinesphere.geometry.twists import incidence
from kinesphere.geometry.vectors import lengths
from kinesphere.markerless.contours import Contour, contour_of, matches
from kinesphere.markerless.fit import Eye, Fitter
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.levelset import Silhouette, cropped, from_mask, segment
from kinesphere.markerless.pieces import around
from kinesphere.markerless.pose import Pose, Posed, posed
from kinesphere.markerless.rim import Rim, derivatives, image_directions
from kinesphere.markerless.solver import Normals, Prior, solve_step

_DAMPING = 1e-3
_DRAWN = 3
"""Steps for which one drawing of what hides what must do."""


@dataclass(frozen=True, eq=False)
class ContourFitter:
    """Fits a pose to the contours that level sets, or given masks, find."""

    fitter: Fitter
    masks: bool
    pictures: list[NDArray[np.uint8] | None] = field(default_factory=list)
    silhouettes: list[Silhouette | None] = field(default_factory=list)
    """As last found."""

    def look(self, pictures: list[NDArray[np.uint8] | None]) -> None:
        """Take in new images of the views."""
        self.pictures[:] = pictures

    def fit(self, pose: Pose, priors: tuple[Prior, ...]) -> Pose:
        """Return the pose that fits best near a given one.

        The coupled method goes to and fro between contour and pose (equation 3).
        """
        s = self.fitter.settings
        coupled = s.method == "coupled" and not self.masks
        by_limb = coupled and s.densities == "limbs"
        rounds = s.alternations if coupled else 1
        self.silhouettes[:] = [None] * len(self.pictures)
        for i in range(rounds):
            scale = 2 ** (rounds - 1 - i)
            contours = self._contours(pose, s.shape if coupled else 0.0, scale, by_limb)
            iterations = max(1, s.contour_iterations // rounds)
            for k in range(iterations):
                radius = s.radius / (1 + i * iterations + k) ** 0.5
                pose, step = self._step(
                    pose,
                    contours,
                    priors,
                    radius,
                    scale if by_limb else None,
                    k > 0 and k % _DRAWN == 0,
                )
                if step < 1e-4:
                    break
        return pose

    def _contours(
        self, pose: Pose, shape: float, scale: int, by_limb: bool
    ) -> list[Contour | None]:
        """Find the contours, and leave the pose drawn on every canvas."""
        contours: list[Contour | None] = []
        s = self.fitter.settings
        points = self.fitter.body.skinned(posed(self.fitter.body.chain, pose))
        for i, (eye, picture) in enumerate(zip(self.fitter.eyes, self.pictures, strict=True)):
            parts = eye.canvas.draw(points)
            model = parts.limbs != NOWHERE
            if picture is None:
                found = None
            elif self.masks:
                box = around(picture > 127, 4)
                found = None if box is None else cropped(from_mask(picture), box)
            else:
                known = eye.evidence.ratios(parts, s.margin) if by_limb else None
                found = segment(picture, model, s, self.silhouettes[i], shape, known, scale)
            self.silhouettes[i] = found
            contours.append(None if found is None else contour_of(found, eye.canvas.view, 3))
        return contours

    def _step(
        self,
        pose: Pose,
        contours: list[Contour | None],
        priors: tuple[Prior, ...],
        radius: float,
        inner: int | None,
        draw: bool,
    ) -> tuple[Pose, float]:
        body, s = self.fitter.body, self.fitter.settings
        at = posed(body.chain, pose)
        points = body.skinned(at)
        normals = body.normals(points)
        equations = Normals.empty(body.chain.n_dofs)
        for eye, contour in zip(self.fitter.eyes, contours, strict=True):
            if contour is None or len(contour.points) == 0:
                continue
            parts = eye.canvas.draw(points) if draw else eye.canvas.drawn
            whole = eye.canvas.rim(points, normals, parts)
            if inner is not None:
                before_another = _part(whole, np.flatnonzero(whole.parts[:, 1] != NOWHERE))
                if len(before_another.shares):
                    self.fitter.add_lines(eye, at, points, before_another, parts, inner, equations)
            which, targets, outward = matches(contour, whole, radius)
            if len(which) == 0:
                continue
            rim = _part(whole, which)
            add = _add_plucker if s.equations == "plucker" else _add_image
            add(self.fitter, eye, at, points, rim, targets, outward, equations)
        return solve_step(body.chain, pose, equations, priors, _DAMPING)


def _part(rim: Rim, which: NDArray[np.intp]) -> Rim:
    return Rim(*(array[which] for array in vars(rim).values()))


def _add_image(
    fitter: Fitter,
    eye: Eye,
    at: Posed,
    surface: Array,
    rim: Rim,
    targets: Array,
    outward: Array,
    equations: Normals,
) -> None:
    """Add how far rim points are from the contour across it, in px."""
    directions = image_directions(eye.canvas.view, surface, rim.pairs, rim.shares, outward)
    _, rows = derivatives(fitter.body, at, rim.pairs, rim.shares, directions[:, None])
    residual = ((targets - rim.pixels) * outward).sum(axis=1)
    weight = fitter.settings.data_weight / (1 + (residual / 6.0) ** 2)
    equations.add(rows[:, 0], residual, weight)


def _add_plucker(
    fitter: Fitter,
    eye: Eye,
    at: Posed,
    _: Array,
    rim: Rim,
    targets: Array,
    __: Array,
    equations: Normals,
) -> None:
    """Add X × n − m = 0, three equations of rank two a match (equation 12), in px at its depth."""
    view = eye.canvas.view
    fx, fy, cx, cy = view.lens
    plane = np.column_stack(
        [(targets[:, 0] - cx) / fx, (targets[:, 1] - cy) / fy, np.ones(len(targets))]
    )
    n = plane @ view.rotation
    n /= lengths(n)[:, None]
    # the derivative of X × n along e is e · (dX × n) = dX · (n × e), and n × e a row of -hat(n)
    points, rows = derivatives(fitter.body, at, rim.pairs, rim.shares, -hat(n))
    error = -incidence(points, n, n @ hat(view.centre).T)
    depth = points @ view.rotation[2] + view.shift[2]
    scale = fx / depth  # px a metre, so that cameras near and far count alike
    far = lengths(error) * scale
    weight = fitter.settings.data_weight * scale**2 / (1 + (far / 6.0) ** 2)
    n_dofs = rows.shape[2]
    equations.add(rows.reshape(-1, n_dofs), error.ravel(), np.repeat(weight, 3))
