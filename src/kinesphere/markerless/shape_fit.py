"""Proportions and poses fitted together over several instants."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array
from kinesphere.data.surface import Surface
from kinesphere.markerless.body import Body
from kinesphere.markerless.eyes import with_body
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.pose import Pose, posed
from kinesphere.markerless.prediction import expectation, rest
from kinesphere.markerless.rim import Rim, derivatives, image_directions
from kinesphere.markerless.shape import FACTORS, shaped
from kinesphere.markerless.solver import Normals, solve_step

_STEP = 1e-3
"""For the derivatives by the factors' logarithms, which are nearly linear."""
_LONGEST = 0.05
"""Of a factor's logarithm, in one iteration."""


@dataclass(frozen=True, eq=False)
class Instant:
    """Images of one instant, at the views' sizes, and the pose found there."""

    pictures: tuple[NDArray[np.uint8] | None, ...]
    pose: Pose


def fit_shape(
    fitter: Fitter,
    surface: Surface,
    model: Callable[[Surface], Body],
    logs: Array,
    instants: Sequence[Instant],
    *,
    schedule: Sequence[tuple[int, int]] = ((4, 2), (2, 3), (1, 3)),
    tight: float = 1.0,
) -> tuple[Array, tuple[Pose, ...]]:
    """Return the factors' logarithms, (n_factors,), and the poses that fit several instants.

    Gauss–Newton on all unknowns at once; each instant's pose is eliminated before the factors,
    which are the same in all, are solved for.

    Parameters
    ----------
    surface, model
        What is given proportions, and how it becomes a body.
    logs
        Where to start.
    schedule
        Scales in px, and iterations at each.
    tight
        Multiplies how strongly the factors are held to 1.
    """
    prior = tight / np.array(list(FACTORS.values())) ** 2
    poses = [instant.pose for instant in instants]
    logs = np.array(logs, dtype=np.float64)
    for scale, iterations in schedule:
        for _ in range(iterations):
            body = model(shaped(surface, logs))
            now = with_body(fitter, body)
            varied = [
                model(shaped(surface, logs + _STEP * np.eye(len(logs))[k]))
                for k in range(len(logs))
            ]
            s_h, s_g = np.diag(prior), -prior * logs
            blocks = []
            for instant, pose in zip(instants, poses, strict=True):
                equations = _equations(now, varied, pose, instant.pictures, scale)
                n = body.chain.n_dofs
                h, g = equations.h, equations.g
                for held in (
                    expectation(body.chain, instant.pose, fitter.settings, widen=2.0),
                    rest(body.chain, fitter.settings, pose),
                ):
                    h[np.arange(n), np.arange(n)] += 1 / held.spread**2
                h[np.arange(n), np.arange(n)] *= 1.001
                inverse = np.linalg.inv(h[:n, :n] + 1e-9 * np.eye(n))
                cross = h[:n, n:]
                s_h = s_h + h[n:, n:] - cross.T @ inverse @ cross
                s_g = s_g + g[n:] - cross.T @ inverse @ g[:n]
                blocks.append((inverse, cross, g[:n]))
            step = np.linalg.solve(s_h, s_g)
            step = step * min(1.0, _LONGEST / max(float(np.abs(step).max()), 1e-9))
            logs = logs + step
            for i, (inverse, cross, g) in enumerate(blocks):
                wanted = Normals(np.eye(len(g)), inverse @ (g - cross @ step))
                poses[i] = solve_step(body.chain, poses[i], wanted, (), 0.0)[0]
    return logs, tuple(poses)


def _equations(
    fitter: Fitter,
    varied: Sequence[Body],
    pose: Pose,
    pictures: Sequence[NDArray[np.uint8] | None],
    scale: int,
) -> Normals:
    """Return the normal equations of one instant: its pose first, then the factors."""
    body = fitter.body
    at = posed(body.chain, pose)
    points = body.skinned(at)
    normals = body.normals(points)
    slopes = [(b.skinned(posed(b.chain, pose)) - points) / _STEP for b in varied]
    n = body.chain.n_dofs
    equations = Normals.empty(n + len(varied))
    s = fitter.settings
    for eye, picture in zip(fitter.eyes, pictures, strict=True):
        eye.evidence.look(picture)
        if picture is None:
            continue
        parts = eye.canvas.draw(points)
        rim = eye.canvas.rim(points, normals, parts)
        if len(rim.shares) == 0:
            continue
        offset, variance, agreement = fitter.edges(eye, rim, parts, scale)
        weight = np.isfinite(agreement) / (variance + 0.05)
        weight *= s.data_weight / (1 + (offset / 3.0) ** 2)
        directions = image_directions(eye.canvas.view, points, rim.pairs, rim.shares, rim.normals)
        _, rows = derivatives(body, at, rim.pairs, rim.shares, directions[:, None])
        by_shape = [(directions * _between(slope, rim)).sum(axis=1) for slope in slopes]
        full = np.concatenate([rows[:, 0], np.column_stack(by_shape)], axis=1)
        equations.add(full, offset * scale, weight / scale**2)
    return equations


def _between(points: Array, rim: Rim) -> Array:
    share = rim.shares[:, None]
    return np.asarray((1 - share) * points[rim.pairs[:, 0]] + share * points[rim.pairs[:, 1]])
