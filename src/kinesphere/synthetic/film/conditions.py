"""Under what conditions a film is made: from a laboratory to a street."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Conditions:
    """What spoils the images, all of it known."""

    noise: float = 3.0
    """Grey values, standard deviation of the sensor's noise."""
    pattern: float = 0.0
    """0–1, contrast of the clothes' pattern."""
    clutter: float = 0.0
    """0–1, how colourful the room is."""
    moving: bool = False
    """Whether textured things move behind the person."""
    changing_light: bool = False
    """Whether lamps swell, fade and go out half way."""
    shadows: float = 0.35
    """0–1, how much of the light a shadow on the floor takes."""
    loose: float = 0.0
    """m, how far clothes stand off and wave."""
    posts: int = 0
    """How many cameras have a post before them, which hides some of the person."""
    finer: int = 2
    """Samples a pixel, each way."""


CONDITIONS = {
    "plain": Conditions(),
    "hidden": Conditions(posts=2),
    "textured": Conditions(pattern=1.0, clutter=0.35),
    "clutter": Conditions(
        noise=5.0,
        pattern=0.6,
        clutter=1.0,
        moving=True,
        changing_light=True,
        shadows=0.5,
        loose=0.025,
    ),
}
"""By name."""
