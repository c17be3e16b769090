"""The topological model as a JSON file."""

from pathlib import Path

from kinesphere.data import TopologicalModel, model_from_dict, model_schema, model_to_dict
from kinesphere.io.json_files import read_json, write_json


def read_model(path: str | Path) -> TopologicalModel:
    """Read a topological model.

    Raises
    ------
    UnreadableFile
        If the file is no JSON.
    BadModel
        Naming the place that is wrong (``segments[2].markers``), or what contradicts what.
    """
    path = Path(path)
    return model_from_dict(read_json(path), str(path))


def write_model(model: TopologicalModel, path: str | Path) -> None:
    """Write a topological model; distances nobody saw become null."""
    write_json(model_to_dict(model), path)


def write_model_schema(path: str | Path) -> None:
    """Write the JSON Schema of a model file, for editors that check while one types."""
    write_json(model_schema(), path)
