"""A case, a study or a recording.yaml as a dictionary: load, change, save. Numbers and words are read as millscope reads them."""

from __future__ import annotations

import math
import os
import re
from pathlib import Path, PurePath
from typing import Any, Mapping

import numpy
import yaml

from .errors import Error
from .files import PathLike, existing, written


# Where cases, studies and recording.yaml name files; `file` is a key of meshes and of beads, also in what --set would take.
PATHS = re.compile(r"include|start\.run|(?:.*\.)?file|base|conditions\.[^.]+\.recording|observe\.camera|files|condition\.geometry")
WORDS = ("recording", "exact")  # of observe.camera: no files


class Case(dict):
    """The top-level map of a file. `folder`: where its relative paths (`include`, `file`, `start.run`) count from, or None."""

    def __init__(self, content: Mapping[str, Any] = (), folder: PathLike | None = None):
        super().__init__(content)
        self.folder = Path(folder).absolute() if folder is not None else None


class _Loader(yaml.SafeLoader):
    yaml_implicit_resolvers: dict = {}  # none of YAML 1.1: `off` is a word and 1e-5 is a number


class _Dumper(yaml.SafeDumper):
    yaml_implicit_resolvers: dict = {}

    def ignore_aliases(self, data: Any) -> bool:
        return True  # millscope refuses anchors


def _float(dumper: yaml.SafeDumper, value: float) -> yaml.Node:
    if not math.isfinite(value):
        raise Error(f"a case holds {value}, which no case may hold; give a finite number")
    return dumper.represent_scalar("tag:yaml.org,2002:float", repr(float(value)))


for _class in (_Loader, _Dumper):
    for _tag, _pattern, _first in (("null", r"~|", "~"), ("bool", r"true|false", "tf"), ("int", r"[-+]?(?:0|[1-9][0-9]*)", "-+0123456789"),
                                   ("float", r"[-+]?(?:(?:\.[0-9]+|[0-9]+\.[0-9]*)(?:[eE][-+]?[0-9]+)?|[0-9]+[eE][-+]?[0-9]+)", "-+.0123456789")):
        _class.add_implicit_resolver("tag:yaml.org,2002:" + _tag, re.compile(f"^(?:{_pattern})$"), list(_first) + ([""] if _tag == "null" else []))
_Dumper.add_representer(float, _float)
_Dumper.add_representer(type(None), lambda dumper, _: dumper.represent_scalar("tag:yaml.org,2002:null", "~"))
_Dumper.add_representer(Case, lambda dumper, case: dumper.represent_dict(case.items()))
_Dumper.add_multi_representer(numpy.generic, lambda dumper, value: dumper.represent_data(value.item()))
_Dumper.add_multi_representer(numpy.floating, lambda dumper, value: dumper.represent_data(float(str(value))))  # 0.002, also of 32 bits
_Dumper.add_multi_representer(numpy.ndarray, lambda dumper, value: dumper.represent_data(value.tolist()))
_Dumper.add_multi_representer(PurePath, lambda dumper, value: dumper.represent_data(str(value)))


def _map(loader: yaml.SafeLoader, node: yaml.MappingNode) -> dict[str, Any]:
    """Refuses what would be lost without a word: a key that stands twice."""
    result = {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        if key in result:
            raise Error(f"{key_node.start_mark.name}:{key_node.start_mark.line + 1}: '{key}' is given twice; remove one of the two")
        result[key] = loader.construct_object(value_node, deep=True)
    return result


_Loader.add_constructor("tag:yaml.org,2002:map", _map)


def load_case(path: PathLike) -> Case:
    """Reads one YAML file as it stands; files that it includes are not merged (`Run.case` is a case with everything in it).

    Values with a unit stay texts ('60 %critical'), bare numbers are SI. Raises Error with file and line where it is no YAML map.
    """
    path = existing(path, "millscope new FOLDER, or an editor")
    try:
        with open(path, encoding="utf-8") as file:
            content = yaml.load(file, _Loader)
    except yaml.MarkedYAMLError as reason:
        mark = reason.problem_mark or reason.context_mark
        raise Error(f"{path}:{mark.line + 1 if mark else 1}: is no YAML: {reason.problem or reason.context}; mend this line or the one above") from reason
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as reason:
        raise Error(f"{path}: cannot be read as YAML ({reason}); take a text file in UTF-8") from reason
    if not isinstance(content, dict):
        raise Error(f"{path}: holds no map of keys; a case begins with 'schema_version: 1'")
    return Case(content, path.parent)


def save_case(case: Mapping[str, Any], path: PathLike, force: bool = False) -> Path:
    """Writes a case as a file that millscope reads, and returns its path. `force` replaces a file that is there.

    Relative paths of a loaded case go on to mean the same files when it is saved in another folder; those of a plain dictionary
    count from the new file. Comments of the file that was loaded are not kept. Raises Error for values that no YAML can hold.
    """
    return write_case(case, Path(path), force)


def write_case(case: Mapping[str, Any], path: Path, force: bool, head: str = "") -> Path:
    """`save_case` below lines of comment."""
    text = head + text_of(moved(case, path.absolute().parent))
    with written(path, force) as beside:
        beside.write_text(text, encoding="utf-8")
    return path


def text_of(value: Any, inline: bool = False) -> str:
    """A value as YAML: a file's text, or `inline`, in one line, as --set takes it."""
    try:
        text = yaml.dump(value, Dumper=_Dumper, sort_keys=False, default_flow_style=True if inline else None, allow_unicode=True, width=math.inf)
    except yaml.representer.RepresenterError as reason:
        raise Error(f"a case cannot hold {reason.args[-1]!r}; give numbers, texts, lists and maps") from reason
    return text.removesuffix("...\n").strip() if inline else text


def moved(case: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """The case with its relative paths seen from another folder."""
    origin = getattr(case, "folder", None)
    if origin is None or origin.resolve() == folder.resolve():
        return dict(case)

    def walk(value: Any, place: str) -> Any:
        if isinstance(value, Mapping):
            return {key: walk(item, f"{place}.{key}" if place else str(key)) for key, item in value.items()}
        if isinstance(value, list):
            return [walk(item, place) for item in value]
        if isinstance(value, str) and PATHS.fullmatch(place) and value not in WORDS and not os.path.isabs(value):
            return os.path.relpath(origin / value, folder)
        return value

    return walk(case, "")
