"""The wall between arm and trunk is not the person's."""

import numpy as np

from kinesphere.markerless.walls import grown, without_room


def scene(rng):
    """Return a picture, a silhouette that holds some wall, and that wall."""
    picture = np.full((90, 120, 3), (150, 150, 140)) + rng.normal(scale=3, size=(90, 120, 3))
    person = np.zeros((90, 120), dtype=bool)
    person[20:80, 40:60] = True
    picture[person] = (150, 70, 50)
    wall = np.zeros_like(person)
    wall[30:50, 60:72] = True
    return np.clip(picture, 0, 255).astype(np.uint8), person, wall


def test_the_wall_goes_and_the_person_stays(rng):
    picture, person, wall = scene(rng)
    none = np.zeros_like(person)
    left = without_room(picture, person | wall, none)
    assert (left & wall).sum() < 0.1 * wall.sum()
    assert left[person].all()
    assert (without_room(picture, person, none) == person).all()


def test_what_has_moved_stays_whatever_its_colours(rng):
    picture, person, wall = scene(rng)
    assert (without_room(picture, person | wall, wall) == (person | wall)).all()


def test_nothing_and_everything_come_back(rng):
    picture, person, _ = scene(rng)
    for mask in (np.zeros_like(person), np.ones_like(person)):
        assert (without_room(picture, mask, np.zeros_like(person)) == mask).all()


def test_grown_reaches_as_far_as_it_says():
    mask = np.zeros((20, 20), dtype=bool)
    mask[10, 10] = True
    assert grown(mask, 3).sum() == 49
