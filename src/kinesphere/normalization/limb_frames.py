"""Frames of single limbs in the default position, from the body frame and the limb's direction."""

import numpy as np

from kinesphere.data import Array
from kinesphere.geometry.rotations import rotation_between
from kinesphere.normalization.anatomy import CANONICAL, without_side

_FOOT_LIKE = 0.7  # share of forward in the direction from which an unnamed chain's end is a foot


def canonical_direction(name: str, in_body: Array, *, at_end: bool) -> Array:
    """Return where a limb points in the ideal default position, (3,) in the body frame.

    From the conventions where the name is known; else up or down, whichever is nearer, and
    forward for the end of a chain that mostly points forward.

    Parameters
    ----------
    name
        Of the limb.
    in_body : (3,)
        Where it points in this body's default position, in the body frame.
    at_end
        True for the last limb of a chain.
    """
    known = CANONICAL.get(without_side(name))
    if known is not None:
        return np.array(known)
    if at_end and in_body[0] > _FOOT_LIKE:
        return np.array([1.0, 0.0, 0.0])
    return np.array([0.0, 1.0 if in_body[1] > 0 else -1.0, 0.0])


def minimal_frame(points: Array, ideal: Array) -> Array:
    """Return a limb's frame: the body frame turned by the least rotation onto the limb.

    Continuous in the direction, unlike the paper's rule; singular only where the limb points
    opposite to its ideal.

    Parameters
    ----------
    points : (3,)
        Unit vector along the limb, in the body frame.
    ideal : (3,)
        The same in the ideal default position.

    Returns
    -------
    (3, 3)
        ``body_from_limb``, in which the limb points along ``ideal``.
    """
    return rotation_between(ideal, points)


def paper_frame(points: Array) -> tuple[Array, Array]:
    """Return a limb's frame by the paper's rule, and where the limb points in it.

    The two body normals at the smallest angle to the plane across the limb are projected into that
    plane; with the limb's direction they make its frame (section 3). Two projections enclose no
    right angle in general (109.7° for a limb along (.5, .5, −.7)), so both are moved alike until
    they do (Löwdin 1950, doi:10.1063/1.1747632). Which two are taken changes where a limb passes
    45°, and the frame jumps there.

    Parameters
    ----------
    points : (3,)
        Unit vector along the limb, in the body frame.

    Returns
    -------
    frame : (3, 3)
        ``body_from_limb``; the axis nearest to the limb lies along it.
    along : (3,)
        Plus or minus that axis, in limb coordinates: from proximal to distal.
    """
    main = int(np.abs(points).argmax())
    sign = 1.0 if points[main] > 0 else -1.0
    others = [k for k in range(3) if k != main]
    u, _, vt = np.linalg.svd(projected_normals(points, others), full_matrices=False)
    frame = np.empty((3, 3))
    frame[:, others] = u @ vt
    frame[:, main] = sign * points
    along = np.zeros(3)
    along[main] = sign
    return frame, along


def projected_normals(points: Array, normals: list[int]) -> Array:
    """Project body axes into the plane across a limb, (3,) and axis indices → (3, n_normals)."""
    return np.eye(3)[:, normals] - np.outer(points, points[normals])
