"""The topological models that come with Kinesphere: one JSON file each, beside this one."""

import json
from functools import cache
from importlib.resources import files

from kinesphere.data import TopologicalModel
from kinesphere.data.model_dict import model_from_dict
from kinesphere.errors import BadModel

_FOLDER = files("kinesphere.labelling") / "models"


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
    return model_from_dict(content, where=f"built-in model {name}")
