"""The numbers of a message, by the path to each: wrench.force.x, position.femur."""

from __future__ import annotations

import contextlib
from array import array
from collections.abc import Iterator, Mapping, Sequence

LIST_MOST = 32  # a longer list, without names for its entries, is a picture, a scan, a map
DEPTH_MOST = 8
_NOT_READ = frozenset(("header", "stamp", "covariance", "twist_covariance", "orientation_covariance"))


def numbers(
    value: object, path: str = "", depth: int = 0, *, too_long: set[str] | None = None
) -> Iterator[tuple[str, float]]:
    """Each with its path. The lists of a message that has a list of names beside them (a JointState) go by name.
    too_long: gets the paths of the lists that are left out."""
    if isinstance(value, bool) or value is None or isinstance(value, (str, bytes)) or depth > DEPTH_MOST:
        return
    if isinstance(value, (int, float)):
        with contextlib.suppress(OverflowError):  # an identifier of 400 digits is no reading
            yield path, float(value)
        return
    if (items := _items(value)) is not None:
        if len(items) <= LIST_MOST:
            yield from _of_list(items, [str(n) for n in range(len(items))], path, depth, too_long)
        elif too_long is not None and any(isinstance(item, (int, float)) for item in items):
            too_long.add(path)
        return
    members = _members(value)
    names = members.get("name")
    labels = [str(name) for name in names] if isinstance(names, list) and names else []
    for key, member in members.items():
        if key in _NOT_READ or (labels and key == "name"):
            continue
        below = f"{path}.{key}" if path else key
        items = _items(member)
        if labels and items is not None and len(items) == len(labels):
            yield from _of_list(items, labels, below, depth, too_long)
        else:
            yield from numbers(member, below, depth + 1, too_long=too_long)


def _items(value: object) -> list[object] | None:
    """Of a list, a tuple or an array."""
    if isinstance(value, (str, bytes)):
        return None
    return list(value) if isinstance(value, (Sequence, array)) else None


def _of_list(
    items: list[object], labels: list[str], path: str, depth: int, too_long: set[str] | None
) -> Iterator[tuple[str, float]]:
    for label, item in zip(labels, items):
        yield from numbers(item, f"{path}.{label}" if path else label, depth + 1, too_long=too_long)


def _members(value: object) -> Mapping[str, object]:
    if isinstance(value, Mapping):
        return {str(key): member for key, member in value.items()}
    return {key: getattr(value, key) for key in getattr(value, "__slots__", ()) if not key.startswith("_")}
