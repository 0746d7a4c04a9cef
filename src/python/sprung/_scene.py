"""Loads scenes, and tells what Sprung warns of."""
import os
import warnings
from typing import Any, Iterable, Mapping, Optional, Union

from . import _core
from ._errors import SprungWarning


def plain(value: Any) -> Any:
    """NumPy's numbers and arrays, paths and other sequences as JSON has them."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a {type(value).__name__}")


def load(scene: Union[str, "os.PathLike[str]", Mapping[str, Any]], *, overrides: Optional[Mapping[str, Any]] = None,
         mesh_paths: Union[str, "os.PathLike[str]", Iterable[Union[str, "os.PathLike[str]"]]] = ()) -> "_core.Scene":
    """Load a scene: a path of a JSON file, or a dict with the same keys. Returns a Scene.

    scene.schema.json describes every key; installed, it is in share/sprung. The folder examples has scenes.

    overrides: values of keys, ``{"bodies.cloth.mass": 0.3, "step": 0.001}`` (the option ``--set`` of the program).
    mesh_paths: folders in which meshes are looked for, after that of the scene; of a dict, the working directory.

    Raises InputError with all problems of the scene, and FileError if it cannot be read. What is a probable mistake comes as a
    SprungWarning.
    """
    if overrides is not None and not isinstance(overrides, Mapping):
        raise TypeError(f"overrides must be a dict of keys and values, not a {type(overrides).__name__}")
    folders = [mesh_paths] if isinstance(mesh_paths, (str, os.PathLike)) else list(mesh_paths)
    loaded = _core.load(dict(scene) if isinstance(scene, Mapping) else scene,
                        overrides=None if overrides is None else dict(overrides), mesh_paths=folders)
    for text in loaded.warnings:
        warnings.warn(text, SprungWarning, stacklevel=2)
    return loaded
