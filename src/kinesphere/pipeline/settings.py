"""Every stage's settings in one place, and how a person changes one of them by name."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import Field, dataclass, field, fields, is_dataclass, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any, get_type_hints

from kinesphere.editing import RetargetSettings, SurfaceSettings
from kinesphere.errors import BadSetting, UnreadableFile
from kinesphere.io.bvh_settings import BvhSettings
from kinesphere.labelling import LabellingSettings
from kinesphere.markerless.settings import TrackSettings
from kinesphere.normalization import NormalizationSettings
from kinesphere.parameterization import ParameterizationSettings
from kinesphere.pipeline.values import value_from
from kinesphere.quality import OrientationSettings
from kinesphere.skeleton import DiscoverySettings, SkeletonSettings


@dataclass(frozen=True)
class Settings:
    """The settings of every stage of the line."""

    discovery: DiscoverySettings = field(default_factory=DiscoverySettings)
    labelling: LabellingSettings = field(default_factory=LabellingSettings)
    orientation: OrientationSettings = field(default_factory=OrientationSettings)
    skeleton: SkeletonSettings = field(default_factory=SkeletonSettings)
    tracking: TrackSettings = field(default_factory=TrackSettings)
    normalization: NormalizationSettings = field(default_factory=NormalizationSettings)
    parameterization: ParameterizationSettings = field(default_factory=ParameterizationSettings)
    surface: SurfaceSettings = field(default_factory=SurfaceSettings)
    retargeting: RetargetSettings = field(default_factory=RetargetSettings)
    bvh: BvhSettings = field(default_factory=BvhSettings)


def stage_settings(settings: Any) -> dict[str, Any]:
    """Return stage name → its settings dataclass, those inside others included, in line order."""
    found: dict[str, Any] = {}
    for name, path in _stage_paths(settings).items():
        part = settings
        for step in path:
            part = getattr(part, step)
        found[name] = part
    return found


def settings_fields(stage: Any) -> Iterator[tuple[Field[Any], Any, Any]]:
    """Yield (field, type, value) of each setting of one stage, leaving out nested stages."""
    hints = get_type_hints(type(stage))
    for f in fields(stage):
        value = getattr(stage, f.name)
        if not is_dataclass(value):
            yield f, hints[f.name], value


def settings_from(
    changes: Mapping[str, Mapping[str, Any]], base: Settings | None = None
) -> Settings:
    """Return ``base`` with some settings changed.

    Parameters
    ----------
    changes
        Stage → key → value; text is read as the type of the setting.
    base
        The defaults, if None.

    Raises
    ------
    BadSetting
        For a stage or key that is not there, naming the nearest and all known, and for a value of
        the wrong type, outside its range or not among its choices.
    """
    settings: Any = Settings() if base is None else base
    paths = _stage_paths(settings)
    for stage, keys in changes.items():
        if stage not in paths:
            raise BadSetting(f"no stage is called {stage!r}{_hint(stage, list(paths))}")
        if not isinstance(keys, Mapping):
            raise BadSetting(f"{stage} is a stage; write {stage}.KEY = VALUE or a table [{stage}]")
        part = stage_settings(settings)[stage]
        types = {f.name: annotation for f, annotation, _ in settings_fields(part)}
        values = {}
        for key, written in keys.items():
            if key not in types:
                raise BadSetting(f"stage {stage} has no setting {key!r}{_hint(key, list(types))}")
            values[key] = value_from(written, types[key], f"{stage}.{key}")
        try:
            part = replace(part, **values)
        except BadSetting as error:
            raise BadSetting(f"{stage}.{error}") from error
        settings = _put(settings, paths[stage], part)
    return settings  # type: ignore[no-any-return]


def changes_from_text(assignments: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Return stage → key → text of ``STAGE.KEY=VALUE`` words; the last one of a key counts.

    Raises
    ------
    BadSetting
        For a word that does not look like that.
    """
    changes: dict[str, dict[str, Any]] = {}
    for word in assignments:
        name, equals, value = word.partition("=")
        stage, dot, key = name.strip().partition(".")
        if not (equals and dot and stage and key):
            raise BadSetting(
                f"{word!r} sets nothing; write STAGE.KEY=VALUE, as in axes.method=direction-joining"
            )
        changes.setdefault(stage, {})[key.strip()] = value.strip()
    return changes


def read_settings(path: str | Path) -> dict[str, dict[str, Any]]:
    """Return stage → key → value of a TOML file with a table for each stage.

    Raises
    ------
    UnreadableFile
        If it is missing or no TOML.
    """
    try:
        found = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise UnreadableFile(f"{path}: cannot read the settings: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"{path}: not a TOML file of settings: {error}") from error
    return found


def merged(
    first: Mapping[str, Mapping[str, Any]], then: Mapping[str, Mapping[str, Any]]
) -> dict[str, Any]:
    """Return the changes of both; ``then`` wins."""
    together: dict[str, Any] = dict(first)
    for stage, keys in then.items():
        before = together.get(stage, {})
        together[stage] = {**before, **keys} if isinstance(before, Mapping) else keys
    return together


def _stage_paths(settings: Any, above: tuple[str, ...] = ()) -> dict[str, tuple[str, ...]]:
    paths: dict[str, tuple[str, ...]] = {}
    for f in fields(settings):
        part = getattr(settings, f.name)
        if is_dataclass(part):
            path = (*above, f.name)
            if any(True for _ in settings_fields(part)):
                paths[f.name] = path
            paths |= _stage_paths(part, path)
    return paths


def _put(whole: Any, path: tuple[str, ...], part: Any) -> Any:
    if not path:
        return part
    inner = _put(getattr(whole, path[0]), path[1:], part)
    return replace(whole, **{path[0]: inner})


def _hint(wrong: str, known: list[str]) -> str:
    near = get_close_matches(wrong, known, n=1)
    meant = f" (did you mean {near[0]}?)" if near else ""
    return f"{meant}; known are {', '.join(known)}"
