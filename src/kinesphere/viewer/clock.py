"""Which frame is due: playing is a matter of what time it is, never of how fast pages draw."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Clock:
    """Plays frames 0 … n_frames − 1 round and round."""

    n_frames: int
    rate: float
    """Hz of the recording."""
    frame: float = 0.0
    """The frame at ``since``, with its fraction."""
    since: float | None = None
    """s, when it was started; None while it stands."""
    speed: float = 1.0

    @property
    def playing(self) -> bool:
        """Whether time passes."""
        return self.since is not None

    def at(self, now: float) -> int:
        """Return the frame that is due."""
        return int(self._exact(now))

    def started(self, now: float) -> "Clock":
        """Return the clock going on from where it stands."""
        return replace(self, frame=self._exact(now), since=now)

    def stopped(self, now: float) -> "Clock":
        """Return the clock standing at the frame that is due."""
        return replace(self, frame=float(self.at(now)), since=None)

    def sought(self, frame: int, now: float) -> "Clock":
        """Return the clock at another frame; it goes on if it was going."""
        inside = min(max(frame, 0), self.n_frames - 1)
        return replace(self, frame=float(inside), since=now if self.playing else None)

    def at_speed(self, speed: float, now: float) -> "Clock":
        """Return the clock at another speed; no frame is left out by the change."""
        return replace(
            self, frame=self._exact(now), since=now if self.playing else None, speed=speed
        )

    def _exact(self, now: float) -> float:
        if self.since is None:
            return self.frame
        passed = max(0.0, now - self.since) * self.speed * self.rate
        return (self.frame + passed) % self.n_frames
