"""Bodies that hang together at joints, and the equations that fit them to their markers.

Bundle adjustment: shapes, joint centres and every frame's poses are unknowns together, so that a
body of two markers between two others takes its pose from the joints at both its ends.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kinesphere.geometry.rotations import hat, rotation_exp
from kinesphere.geometry.vectors import lengths

Array = NDArray[np.float64]

WIDEST = 0.3
"""rad, widest turn of a body in one step."""
FLOOR = 1e-5
"""m, least scale of the residuals."""
LOOSE = 1e-9
"""Share of a frame's information that keeps its pose solvable where a turn is open."""
ROUNDING = 1e-10
"""Share of the largest eigenvalue, unknowns made alike, below which nothing is told."""
_HALF_NORMAL = 1.538  # median length of a standard normal vector in space


class Linkage(NamedTuple):
    """Bodies in a tree, parents first; each but the first hangs from its parent at its origin."""

    parents: tuple[int, ...]
    """Index of each body's parent; −1 for the first."""
    shapes: tuple[Array, ...]
    """Of each body (n_markers, 3) m; from the joint towards the parent, but for the first."""
    centres: Array
    """(n_bodies, 3) m, where each hangs, in its parent; the first row says nothing."""
    rotations: Array
    """(n_frames, n_bodies, 3, 3) ``world_from_body``."""
    origin: Array
    """(n_frames, 3) m, of the first body."""

    @property
    def origins(self) -> Array:
        """(n_frames, n_bodies, 3) m, of every body: its joint towards the parent."""
        at = np.empty(self.rotations.shape[:3])
        at[:, 0] = self.origin
        for body, parent in enumerate(self.parents[1:], start=1):
            at[:, body] = at[:, parent] + self.rotations[:, parent] @ self.centres[body]
        return at


class Equations(NamedTuple):
    """Linear in the unknowns that all frames share, poses solved out."""

    told: Array
    score: Array
    follow: Array
    """(n_frames, n_pose, n_shared) and, below, how poses follow a step of what is shared."""
    own: Array
    """(n_frames, n_pose)."""


def misfit(linkage: Linkage, points: Array, seen: NDArray[np.bool_]) -> Array:
    """Return residuals (n_frames, n_markers, 3) m, 0 where unseen."""
    origins = linkage.origins
    placed = [
        origins[:, body, None] + shape @ np.swapaxes(linkage.rotations[:, body], 1, 2)
        for body, shape in enumerate(linkage.shapes)
    ]
    return np.where(seen[..., None], np.concatenate(placed, axis=1) - points, 0.0)


def scale_of(off: Array, seen: NDArray[np.bool_], n_bodies: int) -> float:
    """Return the robust standard deviation of residuals in each direction, in m."""
    free, taken = 3 * seen.sum() / len(off), 3 * n_bodies + 3
    usual = float(np.median(lengths(off)[seen])) / _HALF_NORMAL
    # the poses take up some of the coordinates: what is left looks smaller than the noise
    return max(usual * float(np.sqrt(free / max(free - taken, 1.0))), FLOOR)


def equations(linkage: Linkage, off: Array, weights: Array) -> Equations:
    """Return the normal equations of what all frames share, every frame's poses solved out."""
    n, n_markers = off.shape[:2]
    root = np.sqrt(weights)[..., None]
    residual = (off * root).reshape(n, -1, 1)
    shared = (_by_shared(linkage, n_markers) * root[..., None]).reshape(n, 3 * n_markers, -1)
    pose = (by_pose_of(linkage, n_markers) * root[..., None]).reshape(n, 3 * n_markers, -1)
    right = np.concatenate([shared, residual], axis=2)
    cross = np.swapaxes(pose, 1, 2) @ right
    follow = np.linalg.solve(square_of(pose), cross)
    flat = shared.reshape(-1, shared.shape[2])
    total = flat.T @ right.reshape(-1, right.shape[2])
    total -= np.tensordot(cross[..., :-1], follow, ((0, 1), (0, 1)))
    return Equations(total[:, :-1], total[:, -1], follow[..., :-1], follow[..., -1])


def by_pose_of(linkage: Linkage, n_markers: int) -> Array:
    """Return how markers follow a turn of each body and a shift of the first, (n, m, 3, k)."""
    n, n_bodies = linkage.rotations.shape[:2]
    origins, first = linkage.origins, 0
    by_pose = np.zeros((n, n_markers, 3, 3 * n_bodies + 3))
    by_pose[..., -3:] = np.eye(3)
    for body, shape in enumerate(linkage.shapes):
        rows = slice(first, first + len(shape))
        arm = shape @ np.swapaxes(linkage.rotations[:, body], 1, 2)
        by_pose[:, rows, :, 3 * body : 3 * body + 3] = -hat(arm)
        for parent, child in _way_up(linkage, body):
            arm = origins[:, child] - origins[:, parent]
            by_pose[:, rows, :, 3 * parent : 3 * parent + 3] = -hat(arm)[:, None]
        first += len(shape)
    return by_pose


def _by_shared(linkage: Linkage, n_markers: int) -> Array:
    """Return how markers follow shapes, body by body but for the first, and centres."""
    n, n_bodies = linkage.rotations.shape[:2]
    fixed, first = len(linkage.shapes[0]), 0
    n_shapes = 3 * (n_markers - fixed)
    by_shared = np.zeros((n, n_markers, 3, n_shapes + 3 * (n_bodies - 1)))
    for body, shape in enumerate(linkage.shapes):
        rows = slice(first, first + len(shape))
        for m in range(first, first + len(shape)) if body else ():
            at = 3 * (m - fixed)
            by_shared[:, m, :, at : at + 3] = linkage.rotations[:, body]
        for parent, child in _way_up(linkage, body):
            at = n_shapes + 3 * (child - 1)
            by_shared[:, rows, :, at : at + 3] = linkage.rotations[:, parent, None]
        first += len(shape)
    return by_shared


def _way_up(linkage: Linkage, body: int) -> Iterator[tuple[int, int]]:
    """Yield every body above one, with the one that the way goes through."""
    child = body
    while (parent := linkage.parents[child]) >= 0:
        yield parent, child
        child = parent


def square_of(pose: Array) -> Array:
    """Return every frame's normal matrix, solvable where a turn is open."""
    square = np.swapaxes(pose, 1, 2) @ pose
    least = LOOSE * np.trace(square, axis1=1, axis2=2)
    square += least[:, None, None] * np.eye(square.shape[1])
    return square


def still(linkage: Linkage) -> Array:
    """Return what keeps bodies from turning in their own frames, which no marker tells."""
    n_shapes = 3 * sum(len(s) for s in linkage.shapes[1:])
    n_shared = n_shapes + 3 * (len(linkage.parents) - 1)
    total, first = np.zeros((n_shared, n_shared)), 0
    for shape in linkage.shapes[1:]:
        turn = np.zeros((3, n_shared))
        size = float(np.sum(shape**2))
        turn[:, first : first + 3 * len(shape)] = np.concatenate(list(hat(shape)), axis=1)
        total += turn.T @ turn / max(size, 1e-12) * 1e8  # beside it a marker known to 0.1 mm
        first += 3 * len(shape)
    return total


def idle(linkage: Linkage) -> Array:
    """Return (n_shared, n) steps, orthonormal, that turn bodies in their own frames and fit alike.

    They move shapes and what hangs from them: whoever expects a centre somewhere in its parent
    could otherwise go there for ever without anything in the world moving.
    """
    n_shapes = 3 * sum(len(s) for s in linkage.shapes[1:])
    turns, first = [], 0
    for body, shape in enumerate(linkage.shapes[1:], start=1):
        turn = np.zeros((n_shapes + 3 * (len(linkage.parents) - 1), 3))
        turn[first : first + shape.size] = hat(shape).reshape(-1, 3)
        for child in np.flatnonzero(np.equal(linkage.parents, body)):
            at = n_shapes + 3 * (child - 1)
            turn[at : at + 3] = hat(linkage.centres[child])
        turns.append(turn)
        first += shape.size
    steps, sizes, _ = np.linalg.svd(np.concatenate(turns, axis=1), full_matrices=False)
    kept: Array = steps[:, sizes > FLOOR]
    return kept


def inverse_of(matrix: Array) -> Array:
    """Return the inverse of a symmetric matrix whose unknowns may differ in size by far."""
    sizes = 1 / np.sqrt(np.maximum(np.diag(matrix), 1e-300))
    inner = np.linalg.pinv(sizes[:, None] * matrix * sizes, rcond=ROUNDING, hermitian=True)
    inverse: Array = sizes[:, None] * inner * sizes
    return inverse


def moved_by(linkage: Linkage, step: Array, poses: Array) -> Linkage:
    """Return the linkage with what is shared, unless that is empty, and every pose moved."""
    shapes, centres = list(linkage.shapes), linkage.centres.copy()
    if len(step):
        first = 0
        for body, shape in enumerate(linkage.shapes[1:], start=1):
            shapes[body] = shape + step[first : first + shape.size].reshape(-1, 3)
            first += shape.size
        centres[1:] += step[first:].reshape(-1, 3)
    turns = poses[:, :-3].reshape(len(poses), -1, 3)
    turns *= np.minimum(1.0, WIDEST / np.maximum(lengths(turns), 1e-12))[..., None]
    rotations = rotation_exp(turns.reshape(-1, 3)).reshape(linkage.rotations.shape)
    return linkage._replace(
        shapes=tuple(shapes),
        centres=centres,
        rotations=rotations @ linkage.rotations,
        origin=linkage.origin + poses[:, -3:],
    )
