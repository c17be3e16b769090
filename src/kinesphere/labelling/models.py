"""The topological models that come with Kinesphere: one JSON file each, beside this one.

Where the numbers of their landmarks come from; all are along the axes of the standing body.

Hips
    Harrington et al. 2007 in the plane of ASIS and PSIS, with PW the distance of the ASIS and PD
    that of their middle from the PSIS': 0.24 PD + 9.9 mm back, 0.30 PW + 10.9 mm down, 0.33 PW +
    7.3 mm to the side. `plugin-gait` has it so. Its spread of 9 mm in each direction is what people
    deviate (as others quote it 5.2 mm back, 3.6 down, 3.2 aside where one was left out; Hara et al.
    2016, doi:10.1038/srep37707, alike: 5.2, 4.4, 3.8) with skin and how markers are put on:
    12.3 ± 5.9 mm in all on CT scans (Mantovani et al. 2016, Gait & Posture 44, 48-54), 8 mm in each
    direction.
    In `cmu41` markers are at the waist: the constants are spread over a pelvis of PW 238 mm and PD
    155 mm: 0.304 PD, 0.346 PW, 0.361 PW; back and side are weights of the markers, down is turned
    by the 12° by which the plane dips to the front in standing. Without PSIS: Bell et al. 1989,
    14 % of PW inward, 30 % down, 22 % back.
Lumbar, neck
    Reed et al. 1999, the men's numbers as quoted by Dumas et al. 2007
    (doi:10.1016/j.jbiomech.2006.02.013): L5/S1 26 to 29 % of PW behind and 13 to 17 % above the
    middle of the ASIS; C7/T1 55 % of the way from C7 to the breastbone, raised by 8°.
Shoulders
    Rab et al. 2002: 17 % of the distance of the acromia below the acromion.
Knees, ankles, elbows
    Half the width with marker and skin, in shares of the shank (LKNE to LANK) or the upper arm
    (LSHO to LELB). Recordings with medial markers or measured widths have 52 to 78 mm on shanks of
    380 to 440 mm (0.12 to 0.20; 0.14 taken), 35 to 50 mm (0.09 to 0.13; 0.10 taken), 48 to 55 mm on
    upper arms of 290 to 320 mm (0.15 to 0.18; 0.14 taken, for smaller markers). Legs turn outward
    in standing: the points come out some 20 mm behind the middle of the epicondyles, hence the
    spread.
"""

import json
from functools import cache
from importlib.resources import files

from kinesphere.data import TopologicalModel
from kinesphere.data.model_dict import model_from_dict
from kinesphere.errors import BadModel

_FOLDER = files("kinesphere.labelling") / "models"
_STATISTICS = files("kinesphere.labelling") / "statistics"
"""What labelling recognises a layout by: ``python -m benchmarks.built_in_statistics`` writes it."""


def built_in_models() -> tuple[str, ...]:
    """Return the names of the built-in models, sorted."""
    names = (entry.name for entry in _FOLDER.iterdir())
    return tuple(sorted(name.removesuffix(".json") for name in names if name.endswith(".json")))


@cache
def built_in_model(name: str) -> TopologicalModel:
    """Return the built-in model of that name.

    Raises
    ------
    BadModel
        Naming the built-in models, if this is none of them.
    """
    if name not in built_in_models():
        raise BadModel(
            f"no built-in model is called {name!r}; there are {', '.join(built_in_models())}"
        )
    content = json.loads((_FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    statistics = _STATISTICS / f"{name}.json"
    if statistics.is_file():
        content["statistics"] = json.loads(statistics.read_text(encoding="utf-8"))
    return model_from_dict(content, where=f"built-in model {name}")
