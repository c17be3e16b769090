"""What of a solution is what of a performance: worlds, limbs, joints, axes."""

from dataclasses import dataclass
from functools import cached_property
from itertools import permutations

import numpy as np

from kinesphere.data import Array, Joint, Solution
from kinesphere.errors import BadRecording
from kinesphere.geometry.rigid import fit_rigid
from kinesphere.geometry.rotations import mean_rotation
from kinesphere.synthetic.performance import Performance

_N_FRAMES = 400  # from which constant turns between frames are averaged
_N_FITS = 4  # of the world, each leaving out what the last found far off
_FAR = 5.0  # times the median distance


@dataclass(frozen=True, eq=False)
class JointPair:
    """A joint of the truth and the same joint of the solution."""

    name: str
    truth: Joint
    estimate: Joint
    truth_index: int
    estimate_index: int
    parent_world: Array
    """(n_frames, 3, 3) the true parent's ``world_from_limb``."""
    true_relative: Array
    """(n_frames, 3, 3) true ``parent_from_child``."""
    parent_turn: Array
    """(3, 3) ``estimated_from_true`` parent frame."""
    child_turn: Array
    """(3, 3) ``estimated_from_true`` child frame."""
    true_angles: Array
    """(n_frames, 3) rad."""
    true_twists: Array
    """(n_frames,) rad."""
    raw_angles: Array
    """(n_frames, 3) rad, as the solution has them."""
    raw_twists: Array
    """(n_frames,) rad, as the solution has them."""
    long_axis: Array
    """(3,) of the solution's child limb, in its frame."""
    true_long_axis: Array
    """(3,) of the actor's child limb, in its frame."""

    @cached_property
    def _match(self) -> tuple[tuple[int, ...], Array]:
        """Which true axis each estimated axis is, and its sign."""
        assert self.truth.axes is not None
        assert self.estimate.axes is not None
        cosines = (self.estimate.axes @ self.parent_turn) @ self.truth.axes.T
        order = max(
            permutations(range(self.truth.n_axes)),
            key=lambda o: min(abs(cosines[k, o[k]]) for k in range(len(o))),
        )
        return order, np.sign([cosines[k, o] for k, o in enumerate(order)])

    @property
    def order(self) -> tuple[int, ...]:
        """Index of the true axis that each estimated axis is."""
        return self._match[0]

    @property
    def _inverse(self) -> list[int]:
        return [int(i) for i in np.argsort(self.order)]

    @property
    def estimated_axes(self) -> Array:
        """(n_axes, 3) in the true parent frame, in the order and with the signs of the truth."""
        assert self.estimate.axes is not None
        signed = self._match[1][:, None] * (self.estimate.axes @ self.parent_turn)
        return np.asarray(signed[self._inverse])

    @property
    def estimated_angles(self) -> Array:
        """(n_frames, n_axes) rad, in the order and with the signs of the truth."""
        signed = self._match[1] * self.raw_angles[:, : len(self.order)]
        return np.asarray(signed[:, self._inverse])

    @property
    def _twist_sign(self) -> float:
        return float(np.sign(self.long_axis @ self.child_turn @ self.true_long_axis))

    @property
    def estimated_twists(self) -> Array:
        """(n_frames,) rad, with the sign of the truth."""
        return self._twist_sign * self.raw_twists

    @property
    def told_relative(self) -> Array:
        """(n_frames, 3, 3) true ``parent_from_child`` between the frames of the solution."""
        return np.asarray(self.parent_turn @ self.true_relative @ self.child_turn.T)

    @property
    def told_joint(self) -> tuple[Array, Array, Array]:
        """True axes in the solution's order, its rest orientation and its long axis."""
        assert self.truth.axes is not None
        assert self.estimate.rest is not None
        axes = self._match[1][:, None] * self.truth.axes[list(self.order)] @ self.parent_turn.T
        return axes, self.estimate.rest, self.long_axis

    @property
    def told_start_angles(self) -> Array:
        """(n_frames, n_axes) rad, the truth in the solution's order and signs."""
        return np.asarray(self._match[1] * self.true_angles[:, list(self.order)])

    @property
    def told_start_twists(self) -> Array:
        """(n_frames,) rad, the truth with the solution's sign."""
        return self._twist_sign * self.true_twists


@dataclass(frozen=True, eq=False)
class Correspondence:
    """What corresponds to what."""

    world_turn: Array
    """(3, 3) ``truth_from_estimate`` of the world."""
    world_shift: Array
    """(3,) m, added after the turn."""
    limbs: dict[str, int]
    """True limb → index of the solution's limb that owns most of its markers."""
    estimate_from_truth: dict[str, Array]
    """Solution's limb → (3, 3), its frame from the true limb's."""
    joints: tuple[JointPair, ...]

    @property
    def tilt_deg(self) -> float:
        """Angle in deg between true up and the solution's up."""
        up = self.world_turn[:, 1]
        return float(np.rad2deg(np.arctan2(np.hypot(up[0], up[2]), up[1])))

    def into_truth(self, points: Array) -> Array:
        """Return points of the solution's world in the true world, (..., 3) m."""
        return np.asarray(points @ self.world_turn.T + self.world_shift)


def correspondence(performance: Performance, solution: Solution) -> Correspondence:
    """Find what of a solution is what of the performance, by the labels of markers alone.

    Raises
    ------
    BadRecording
        If the two have different numbers of frames or no marker in common.
    """
    turn, shift = _worlds(performance, solution)
    owners = {label: limb.name for limb in performance.skeleton.limbs for label in limb.markers}
    truth_of: dict[str, str] = {}
    best: dict[str, tuple[int, int]] = {}
    for i, limb in enumerate(solution.skeleton.limbs):
        owned = [owners[label] for label in limb.markers if label in owners]
        if not owned:
            continue
        name = max(owned, key=owned.count)
        truth_of[limb.name] = name
        if name not in best or owned.count(name) > best[name][0]:
            best[name] = owned.count(name), i
    true_at = {name: i for i, name in enumerate(performance.skeleton.limb_names)}
    found_at = {name: i for i, name in enumerate(solution.skeleton.limb_names)}
    some = np.unique(np.linspace(0, performance.motion.n_frames - 1, _N_FRAMES).astype(int))
    turns = {}
    for name, true_name in truth_of.items():
        true = performance.motion.rotations[some, true_at[true_name]]
        found = turn @ solution.motion.rotations[some, found_at[name]]
        if np.isfinite(found).all(axis=(1, 2)).any():
            turns[name] = mean_rotation(np.swapaxes(found, 1, 2) @ true)
    pairs = []
    true_relative = performance.motion.relative_rotations()
    for i, joint in enumerate(solution.skeleton.joints):
        ends = truth_of.get(joint.parent), truth_of.get(joint.child)
        for t, true_joint in enumerate(performance.skeleton.joints):
            if (true_joint.parent, true_joint.child) != ends or not {
                joint.parent,
                joint.child,
            } <= set(turns):
                continue
            pairs.append(
                JointPair(
                    name=true_joint.name,
                    truth=true_joint,
                    estimate=joint,
                    truth_index=t,
                    estimate_index=i,
                    parent_world=performance.motion.rotations[:, true_at[true_joint.parent]],
                    true_relative=true_relative[:, t],
                    parent_turn=turns[joint.parent],
                    child_turn=turns[joint.child],
                    true_angles=performance.parameters.angles[:, t],
                    true_twists=performance.parameters.twists[:, t],
                    raw_angles=solution.parameters.angles[:, i],
                    raw_twists=solution.parameters.twists[:, i],
                    long_axis=solution.skeleton.limb(joint.child).long_axis,
                    true_long_axis=performance.skeleton.limb(true_joint.child).long_axis,
                )
            )
    return Correspondence(
        world_turn=turn,
        world_shift=shift,
        limbs={name: i for name, (_, i) in best.items()},
        estimate_from_truth=turns,
        joints=tuple(pairs),
    )


def _worlds(performance: Performance, solution: Solution) -> tuple[Array, Array]:
    """Fit the solution's world onto the truth's by their markers, leaving out what is far off."""
    true, found = performance.recording, solution.recording
    if true.n_frames != found.n_frames:
        raise BadRecording(
            f"the solution has {found.n_frames} frames, the performance {true.n_frames}; "
            "only a solution of all its frames can be compared"
        )
    labels = tuple(label for label in true.labels if label in found.labels)
    if not labels:
        raise BadRecording("the solution has no marker of the performance to compare by")
    some = np.unique(np.linspace(0, true.n_frames - 1, _N_FRAMES).astype(int))
    target = true.markers[some][:, true.columns(labels)].reshape(1, -1, 3)
    source = found.markers[some][:, found.columns(labels)].reshape(-1, 3)
    weights = np.ones(len(source))
    for _ in range(_N_FITS):
        fit = fit_rigid(source, target, weights)
        turn, shift = fit.rotations[0], fit.shifts[0]
        off = np.linalg.norm(source @ turn.T + shift - target[0], axis=1)
        weights = np.where(off <= _FAR * np.nanmedian(off), 1.0, 0.0)
    return turn, shift
