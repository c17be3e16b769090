"""What was found, frame by frame, gathered into a tracked motion."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from kinesphere.data import Array, Frame, History, Mask, Scene, Surface
from kinesphere.data.joint_names import joint_above
from kinesphere.data.spans import frame_spans
from kinesphere.markerless.fit import Fitter
from kinesphere.markerless.kernels.contour import NOWHERE
from kinesphere.markerless.pose import posed
from kinesphere.markerless.tracked import TrackedMotion
from kinesphere.markerless.tracking import Found

_OFTEN = 0.02
"""A limb lost in more of the frames is spoken of."""


@dataclass(eq=False)
class Account:
    """Arrays of a scene's length that are filled as frames are tracked."""

    scene: Scene
    fitter: Fitter
    """What found the last pose."""
    seconds: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        body, n = self.fitter.body, self.scene.n_frames
        limbs, cameras = len(body.house_limbs), len(self.scene.cameras)
        self._parameters = np.full((n, body.chain.n_dofs), np.nan)
        self._rotations = np.full((n, limbs, 3, 3), np.nan)
        self._origins = np.full((n, limbs, 3), np.nan)
        self._overlap = np.full((n, cameras), np.nan)
        self._by_mask = np.zeros((n, cameras), dtype=bool)
        self._support = np.full((n, limbs), np.nan)
        self._lost = np.zeros((n, limbs), dtype=bool)
        self._entered = np.zeros(n, dtype=bool)
        self._absent = np.zeros(n, dtype=bool)
        self._unmasked = np.zeros(n, dtype=bool)
        names = body.chain.limb_names
        self._own = [names.index(name) for name in body.house_limbs]

    @property
    def n_entered(self) -> int:
        """How many frames there are so far."""
        return int(self._entered.sum())

    def enter(self, frame: Frame, found: Found, seconds: float, *, unmasked: bool = False) -> None:
        """Take down one frame; one in which no camera saw anything, or nobody, stays empty.

        ``unmasked`` if it was followed by colours in a scene that is followed by masks.
        """
        self._entered[frame.index] = True
        self._unmasked[frame.index] = unmasked
        self.seconds["tracking"] = self.seconds.get("tracking", 0.0) + seconds
        if not self.fitter.open_eyes:
            return
        if found.absent:
            self._absent[frame.index] = True
            self._lost[frame.index] = True
            return
        body, i = self.fitter.body, frame.index
        at = posed(body.chain, found.pose)
        self._parameters[i] = body.parameters(found.pose)
        self._rotations[i] = at.rotations[self._own]
        self._origins[i] = at.centres[self._own]
        self._support[i] = found.support[self._own]
        self._lost[i] = found.lost[self._own]
        self._overlap[i] = self._overlaps(frame, body.skinned(at))

    def _overlaps(self, frame: Frame, points: Array) -> Array:
        """Return intersection over union with given masks, else with what colours say."""
        out = np.full(len(self.fitter.eyes), np.nan)
        for i, eye in enumerate(self.fitter.eyes):
            given = frame.references[i] if frame.references[i] is not None else frame.masks[i]
            if not eye.evidence.seeing:
                continue
            model = eye.canvas.draw(points).limbs != NOWHERE
            person: NDArray[np.bool_]
            if given is not None:
                person = eye.canvas.view.image(given) > 127
                self._by_mask[frame.index, i] = True
            else:
                model, person = eye.evidence.person(model)
            union = float((model | person).sum())
            out[i] = (model & person).sum() / union if union else np.nan
        return out

    def warnings(self) -> tuple[str, ...]:
        """Return what a person should know, a sentence each."""
        said = []
        if self.n_entered < self.scene.n_frames:
            said.append(
                f"tracking was interrupted after {self.n_entered} of {self.scene.n_frames} frames; "
                "the others have no pose"
            )
        solved = np.isfinite(self._parameters).all(axis=1)
        blind = self._entered & ~solved & ~self._absent
        if blind.any():
            said.append(f"no camera has an image in {self._called(blind)}: no pose there")
        if self._absent.any():
            said.append(f"nobody is seen in {self._called(self._absent)}: no pose there")
        if self._unmasked.any():
            said.append(
                f"no camera has a mask in {self._called(self._unmasked)}: followed by colours there"
            )
        shares = self._lost[solved].mean(axis=0)
        lost = [
            f"{name} {share:.0%}"
            for name, share in zip(self.fitter.body.house_limbs, shares, strict=True)
            if share > _OFTEN
        ]
        if lost:
            said.append(f"limbs held lost, and in how many of the frames: {', '.join(lost)}")
        return tuple(said)

    def _called(self, frames: Mask) -> str:
        return frame_spans(np.flatnonzero(frames).tolist(), self.scene.first_frame + 1)

    def tracked(self, history: History, surface: Surface | None = None) -> TrackedMotion:
        """Return all of it, with the surface that the body was made of."""
        body = self.fitter.body
        house = {name: i for i, name in enumerate(body.house_limbs)}
        parents = []
        for limb in self._own:
            above = int(body.chain.parents[limb])
            while above >= 0 and body.chain.limb_names[above] not in house:
                above = int(body.chain.parents[above])
            parents.append(house[body.chain.limb_names[above]] if above >= 0 else -1)
        lost: Mask = self._lost
        return TrackedMotion(
            body=body,
            parameter_names=body.parameter_names,
            parameters=self._parameters,
            limb_names=body.house_limbs,
            limb_parents=tuple(parents),
            joint_names=tuple(joint_above(name) for name in body.house_limbs[1:]),
            rotations=self._rotations,
            origins=self._origins,
            ends=(body.ends - body.chain.centres)[self._own],
            overlap=self._overlap,
            support=self._support,
            lost=lost,
            rate=self.scene.rate,
            seconds=dict(self.seconds),
            history=history,
            surface=surface,
            by_mask=self._by_mask,
            n_reached=self.n_entered if self.n_entered < self.scene.n_frames else None,
        )
