"""A chain of springs and weights as bodies of the engine, one joint a body; places are those at no deflection."""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_BODY_MASS, _BODY_INERTIA = 1e-3, 0.1  # N s^2/mm, N mm s^2: only the way to rest depends on them


@dataclass
class Chain:
    """Bodies from the base on. Places and directions are those at no deflection, in mm; a spring of compliance 0 is
    left out. Weights sit on the last body added."""

    root: ElementTree.Element = field(default_factory=lambda: ElementTree.Element("mujoco"))
    joints: int = 0
    weights: list[tuple[str, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        ElementTree.SubElement(self.root, "compiler", angle="radian", autolimits="false")
        option = ElementTree.SubElement(self.root, "option", gravity="0 0 0", integrator="implicit")
        ElementTree.SubElement(option, "flag", contact="disable", constraint="disable")
        self._bodies = 0
        self._at = np.zeros(3)
        self._last = ElementTree.SubElement(self.root, "worldbody")

    def _body(self, place: Array, mass: float = _BODY_MASS) -> ElementTree.Element:
        body = ElementTree.SubElement(self._last, "body", name=f"b{self._bodies}", pos=_words(place - self._at))
        ElementTree.SubElement(body, "inertial", pos="0 0 0", mass=repr(mass), diaginertia=_words([_BODY_INERTIA] * 3))
        self._bodies += 1
        self._last, self._at = body, np.array(place, dtype=float)
        return body

    def _joint(self, name: str, kind: str, place: Array, axis: Array, compliance: float) -> None:
        if compliance > 0.0:
            name, stiffness = name or f"q{self.joints}", repr(1.0 / float(compliance))
            ElementTree.SubElement(
                self._body(place), "joint", name=name, type=kind, axis=_words(axis), stiffness=stiffness
            )
            self.joints += 1

    def hinge(self, place: Array, axis: Array, rad_per_n_mm: float, name: str = "") -> None:
        """A spring that turns all that follows about an axis through a place."""
        self._joint(name, "hinge", place, axis, rad_per_n_mm)

    def slide(self, direction: Array, mm_per_n: float, name: str = "") -> None:
        """A spring that moves all that follows along a direction, which earlier springs turn."""
        self._joint(name, "slide", self._at, direction, mm_per_n)

    def weight(self, place: Array, weight_n: float) -> None:
        """A weight at a place, carried by the springs so far."""
        if weight_n:
            self.weights.append((self.point(place), weight_n))

    def point(self, place: Array, name: str = "") -> str:
        """A body at a place that springs so far carry, for a force to act on; its name."""
        outer = self._last, self._at
        self._body(place)
        name = name or f"b{self._bodies - 1}"
        self._last.set("name", name)
        self._last, self._at = outer
        return name

    def compiled(self, tip: Array) -> mujoco.MjModel:
        """The engine's model; its last body, `tip`, has its mass at the tip."""
        self._body(tip)
        self._last.set("name", "tip")
        return mujoco.MjModel.from_xml_string(ElementTree.tostring(self.root, encoding="unicode"))


def _words(numbers: object) -> str:
    return " ".join(repr(float(number)) for number in np.asarray(numbers, dtype=float))
