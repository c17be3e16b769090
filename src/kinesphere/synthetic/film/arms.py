"""Arms put where a movement wants them: by direction and elbow angle, or by the hand's place."""

from dataclasses import dataclass

import numpy as np

from kinesphere.data import Array
from kinesphere.data.surface import Surface
from kinesphere.geometry.rotations import rotation_between


@dataclass(frozen=True)
class Arm:
    """One arm of a surface at rest."""

    upper: Array
    """(3,) unit, from shoulder to elbow."""
    fore: Array
    """(3,) unit, from elbow to wrist."""
    hand: Array
    """(3,) unit, from wrist to finger tips."""
    palm: Array
    """(3,) unit, the way the palm looks."""
    lengths: tuple[float, float]
    """m, upper arm and forearm."""

    @property
    def flexion(self) -> float:
        """Elbow angle at rest, rad."""
        across = float(np.linalg.norm(np.cross(self.upper, self.fore)))
        return float(np.arctan2(across, self.upper @ self.fore))

    @property
    def hinge(self) -> Array:
        """(3,) unit axis that flexes the elbow further."""
        return _unit(np.cross(self.upper, self.fore))


def arm_of(surface: Surface, side: str) -> Arm:
    """Return an arm of a surface at rest."""
    at = {name: i for i, name in enumerate(surface.limbs)}
    start, end = surface.joint_centres, surface.ends
    upper, fore, hand = (at[f"{side}_{limb}"] for limb in ("upper_arm", "forearm", "hand"))
    one, two, three = start[fore] - start[upper], start[hand] - start[fore], end[hand] - start[hand]
    skin = surface.vertices[surface.weights[:, hand] > 0.5]
    flat = np.linalg.svd(skin - skin.mean(axis=0), full_matrices=False)[2][2]
    inward = np.array([0.0, 0.0, -np.sign(start[upper, 2])])
    palm = flat * (1.0 if flat @ inward > 0 else -1.0)
    palm = _unit(palm - (palm @ _unit(three)) * _unit(three))
    lengths = float(np.linalg.norm(one)), float(np.linalg.norm(two))
    return Arm(_unit(one), _unit(two), _unit(three), palm, lengths)


def aimed_arm(
    arm: Arm, trunk: Array, direction: Array, flexion: Array, twist: Array
) -> tuple[Array, Array]:
    """Return the turns of upper arm and forearm, (n, 3, 3) each.

    Parameters
    ----------
    trunk : (n, 3, 3)
    direction : (n, 3)
        Where the upper arm points, unit vectors in the trunk's rest frame.
    flexion : (n,) rad
        Elbow angle, 0 where straight.
    twist : (n,) rad
        Of the upper arm about itself, after the least turn from rest.
    """
    aimed = rotation_between(np.broadcast_to(arm.upper, direction.shape), direction)
    upper = trunk @ _about(direction, twist) @ aimed
    hinge = (upper @ arm.hinge[:, None])[..., 0]
    return upper, _about(hinge, flexion - arm.flexion) @ upper


def reaching_arm(arm: Arm, shoulder: Array, wrist: Array, pole: Array) -> tuple[Array, Array]:
    """Return the turns of upper arm and forearm that bring the wrist to a place, (n, 3, 3) each.

    Parameters
    ----------
    shoulder, wrist : (n, 3) m
    pole : (n, 3)
        The way the elbow points off the line from shoulder to wrist.
    """
    one, two = arm.lengths
    line = wrist - shoulder
    reach = np.linalg.norm(line, axis=-1, keepdims=True)
    reach = np.clip(reach, abs(one - two) + 1e-6, one + two - 1e-6)
    ahead = line / np.linalg.norm(line, axis=-1, keepdims=True)
    side = pole - (pole * ahead).sum(axis=-1, keepdims=True) * ahead
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    along = (one**2 - two**2 + reach**2) / (2 * reach)
    elbow = shoulder + along * ahead + np.sqrt(np.maximum(one**2 - along**2, 0)) * side
    upper = _unit(elbow - shoulder)
    fore = _unit(shoulder + reach * ahead - elbow)
    hinge = _unit(np.cross(ahead, side))  # from the line towards the elbow …
    hinge = -hinge  # … so flexing further turns the forearm the other way
    there = np.stack([upper, hinge, np.cross(upper, hinge)], axis=-1)
    here = np.stack([arm.upper, arm.hinge, np.cross(arm.upper, arm.hinge)], axis=-1)
    turned = there @ here.T
    cosine = np.clip((upper * fore).sum(axis=-1), -1, 1)
    return turned, _about(hinge, np.arccos(cosine) - arm.flexion) @ turned


def flat_hand(arm: Arm, fingers: Array, palm: Array) -> Array:
    """Return the turn, (3, 3), of a hand whose fingers and palm look along two unit vectors."""
    there = np.stack([fingers, palm, np.cross(fingers, palm)], axis=-1)
    here = np.stack([arm.hand, arm.palm, np.cross(arm.hand, arm.palm)], axis=-1)
    turned: Array = there @ here.T
    return turned


def _about(axes: Array, angles: Array) -> Array:
    """Return rotations about axes that differ, (n, 3) and (n,) → (n, 3, 3)."""
    x, y, z = np.moveaxis(axes, -1, 0)
    zero = np.zeros_like(x)
    k = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
    s, c = np.sin(angles)[..., None, None], np.cos(angles)[..., None, None]
    turned: Array = np.eye(3) + s * k + (1 - c) * (k @ k)
    return turned


def _unit(v: Array) -> Array:
    unit: Array = v / np.linalg.norm(v, axis=-1, keepdims=True)
    return unit
